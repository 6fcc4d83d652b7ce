# SPDX-License-Identifier: MIT
"""download: downloads files with known checksums, and keeps them for the next build.

Downloads are kept in ${XDG_CACHE_HOME:-~/.cache}/icesoc. ICESOC_NPM is a mirror of
registry.npmjs.org, ICESOC_RAW a mirror of raw.githubusercontent.com."""
import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import tarfile
import tempfile

from icesoc.util.errors import reason_of
from icesoc.util.lock import lock

CACHE = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache") / "icesoc"
GITHUB = os.environ.get("ICESOC_RAW") or "https://raw.githubusercontent.com"
NPM = os.environ.get("ICESOC_NPM") or "https://registry.npmjs.org"
KEYRING = "/usr/share/keyrings/debian-archive-keyring.gpg"


class Unreachable(Exception):
    """The file cannot be downloaded: no network, or the mirror does not have it."""


def output(*words):
    """Returns the output of a program; "" if the program does not exist."""
    if not shutil.which(words[0]):
        return ""
    return subprocess.run(words, text=True, capture_output=True).stdout


def mirror():
    """Returns the Debian mirror that this machine uses."""
    found = output("apt-get", "indextargets", "--format", "$(REPO_URI)", "Created-By: Packages")
    debian = [uri.rstrip("/") for uri in found.split() if uri.rstrip("/").endswith("/debian")]
    return debian[0] if debian else "http://deb.debian.org/debian"


def stored(checksum):
    """Returns the path at which the cache stores a download."""
    return CACHE / "foreign" / checksum


def kept(url, checksum, part=None):
    """Returns the path of a download in the cache, after downloading it if necessary. `part` is a
    regular expression: if it is given, only the text that its group matches is checked and
    stored."""
    file = stored(checksum)
    if not file.exists():
        # imported only when needed, because the import takes a fifth of the time in which a command
        # starts
        import urllib.request
        print(f"Fetching {url.rsplit('/', 1)[1]} ...", flush=True)
        try:
            with urllib.request.urlopen(url, timeout=60) as answer:
                data = answer.read()
        except OSError as error:
            reason = getattr(error, "reason", error)
            raise Unreachable(f"{url}: " + (str(error) if hasattr(error, "code") else
                                            reason_of(reason)))
        if part:
            found = re.search(part.encode(), data, re.S)
            data = found[1] if found else b""
        if hashlib.sha256(data).hexdigest() != checksum:
            raise Unreachable(f"{url} has another SHA-256 than the file that was tested")
        file.parent.mkdir(parents=True, exist_ok=True)
        partial = file.with_suffix(".part")
        partial.write_bytes(data)
        partial.rename(file)
    return file


def released(path, checksum):
    """Returns the path of a released source, downloaded from Debian's archive."""
    # apt-get needs nearly a second, so it looks for the mirror only before a download.
    file = stored(checksum)
    return file if file.exists() else kept(f"{mirror()}/pool/main/{path}", checksum)


def unpack(archive, folder, target, suffix=""):
    """Extracts from an archive the files that are below a folder and have names that end with
    `suffix`."""
    with tarfile.open(archive) as tar:
        for member in tar:
            if member.isfile() and member.name.startswith(folder) and member.name.endswith(suffix):
                file = target / member.name[len(folder):]
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_bytes(tar.extractfile(member).read())


def packages(name, wanted, release="trixie"):
    """Returns the folder with these packages of a Debian release, unpacked in the cache."""
    folder = CACHE / name
    if not (folder / "done").exists():
        print(f"Fetching {name} from Debian's {release}, stored apart from the installed packages "
              "...",
              flush=True)
        with tempfile.TemporaryDirectory(dir=CACHE) as work:
            os.makedirs(f"{work}/lists/partial")
            os.makedirs(f"{work}/archives/partial")
            pathlib.Path(work, "private.sources").write_text(
                f"Types: deb\nURIs: {mirror()}\nSuites: {release}\nComponents: main\n"
                f"Signed-By: {KEYRING}\n")
            own = [f"Dir::Etc::sourcelist={work}/private.sources",
                   "Dir::Etc::sourceparts=/dev/null", f"Dir::State::lists={work}/lists",
                   f"Dir::Cache::archives={work}/archives",
                   "Dir::Cache::pkgcache=", "Dir::Cache::srcpkgcache=", "APT::Sandbox::User=root",
                   "APT::Get::List-Cleanup=0"]
            options = [word for option in own for word in ("-o", option)]
            for words in (["update"], ["download", *wanted]):
                if subprocess.call(["apt-get", "-qq", *options, *words], cwd=work):
                    raise Unreachable(f"apt-get {words[0]}: {name} from {mirror()}")
            (folder / "root").mkdir(parents=True, exist_ok=True)
            for package in pathlib.Path(work).glob("*.deb"):
                subprocess.check_call(["dpkg", "-x", package, folder / "root"])
        (folder / "done").touch()
    return folder / "root"


def locked():
    """Locks the cache, because two builds may need the same download."""
    return lock(CACHE / "lock")
