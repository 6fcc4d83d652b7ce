# SPDX-License-Identifier: MIT
"""archive: makes tar and zip files, checksums and signatures. Equal input gives equal bytes."""
import gzip
import hashlib
import io
import shutil
import subprocess
import tarfile
import time
import zipfile
from pathlib import Path

from icesoc.util.errors import Stop

# suffix of the key file -> (program that signs, suffix of the signature)
SIGNATURES = {".sec": ("minisign", ".minisig"), "": ("gpg", ".asc")}


def tar(path, folder, files, seconds, programs=()):
    """Writes a .tar.gz with the files {name: bytes} below `folder`. `seconds` is the time of all
    entries; `programs` are the names of executable files."""
    content = io.BytesIO()
    with tarfile.open(fileobj=content, mode="w", format=tarfile.PAX_FORMAT) as made:
        for name in sorted(files):
            entry = tarfile.TarInfo(f"{folder}/{name}")
            entry.size, entry.mtime = len(files[name]), seconds
            entry.mode = 0o755 if name in programs else 0o644
            made.addfile(entry, io.BytesIO(files[name]))
    Path(path).write_bytes(gzip.compress(content.getvalue(), 9, mtime=seconds))


def tar_of_folder(path, folder, source, seconds):
    """Writes a .tar.gz with all files of a folder."""
    tar(path, folder, {file.relative_to(source).as_posix(): file.read_bytes()
                       for file in sorted(Path(source).rglob("*")) if file.is_file()}, seconds)


def zip_(path, files, seconds):
    """Writes a zip file with the files {name: bytes}."""
    when = time.gmtime(max(seconds, 315532800))[:6]  # zip files cannot store times before 1980
    with zipfile.ZipFile(path, "w") as made:
        for name in sorted(files):
            entry = zipfile.ZipInfo(name, when)
            entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
            entry.create_system = 3
            made.writestr(entry, files[name], compresslevel=9)


def time_of_package(path):
    """Returns the time of the files in a Debian package, which is an archive of ar."""
    with open(path, "rb") as file:
        head = file.read(36)
    if not head.startswith(b"!<arch>\ndebian-binary"):
        raise Stop(f"{path}: expected a Debian package, got another kind of file")
    return int(head[24:36])


def sums(folder):
    """Writes SHA256SUMS for all files of a folder, as sha256sum does. Returns its path."""
    lines = [f"{hashlib.sha256(file.read_bytes()).hexdigest()}  {file.name}\n"
             for file in sorted(Path(folder).iterdir())
             if file.is_file() and not file.name.startswith("SHA256SUMS")]
    path = Path(folder, "SHA256SUMS")
    path.write_text("".join(lines))
    return path


def sign(path, key):
    """Signs a file with a key: a key file of minisign (with the suffix .sec), or the name of a key
    of gpg. Returns the signature's path."""
    program, ending = SIGNATURES[".sec" if key.endswith(".sec") else ""]
    signature = Path(f"{path}{ending}")
    if not shutil.which(program):
        raise Stop(f"release: {program} is missing: apt-get install "
                   + ("gnupg" if program == "gpg" else program), 2)
    signature.unlink(missing_ok=True)
    # The default comment of minisign contains the time. Without this comment, the signature depends
    # only on the file.
    words = (["gpg", "--batch", "--yes", "--armor", "--local-user", key, "--output", signature,
              "--detach-sign", path] if program == "gpg" else
             ["minisign", "-S", "-s", key, "-t", path.name, "-x", signature, "-m", path])
    done = subprocess.run([str(word) for word in words], text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, check=False)
    if done.returncode or not signature.exists():
        raise Stop(f"release: {program} could not sign with '{key}': {done.stdout.strip()}")
    return signature
