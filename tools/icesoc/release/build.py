# SPDX-License-Identifier: MIT
"""build: makes the files of a release from a commit. The same commit gives the same bytes."""
import dataclasses
import hashlib
import io
import shutil
import subprocess
import tarfile
import tempfile
import time
from pathlib import Path

from icesoc.release import archive, packs, sbom, version
from icesoc.util.errors import Stop
from icesoc.util.process import output, run

PARTS = {  # parts of a release, in the order in which they are made
    "source": "icesoc-VERSION.tar.gz: all files of the commit",
    "icec": "icec-VERSION.tar.gz (single files, PlatformIO, Zephyr) and the CMSIS-Pack",
    "changes": "CHANGES-VERSION.md: the section of the changelog",
    "site": "icesoc-VERSION-site.tar.gz: the documentation",
    "packages": "Debian packages for the release of this machine, or from given folders",
    "sbom": "icesoc-VERSION.spdx.json: bill of materials (SPDX 2.3)"}


@dataclasses.dataclass
class Release:
    """Version, commit and files of a release."""
    version: str
    commit: str
    seconds: int  # time of the commit
    files: dict  # name -> bytes, for each file of the commit
    programs: set  # names of the executable files
    tree: Path  # folder with the same files, unpacked
    origin: Path  # folder of the working tree
    out: Path
    folders: list  # folders with Debian packages; if the list is empty, the packages are built

    def path(self, name):
        return self.out / name.replace("VERSION", self.version)

    @property
    def changes(self):
        """Returns the text in the changelog about unreleased changes or, without such text, about
        the newest version."""
        text = self.files["CHANGELOG.md"].decode()
        return version.unreleased(text) or dict(version.sections(text))[version.newest(text)]


def read_commit(tree):
    """Returns (commit, seconds, files, programs), as in Release."""
    git = ["git", "-C", str(tree)]
    commit = output([*git, "rev-parse", "HEAD"], check=False, stderr=subprocess.DEVNULL).strip()
    if not commit:
        raise Stop(f"release: expected a git repository, got {tree}; a release is made of a commit")
    seconds = int(output([*git, "show", "-s", "--format=%ct", "HEAD"]))
    data = subprocess.run([*git, "archive", "--format=tar", "HEAD"], check=True,
                          stdout=subprocess.PIPE).stdout
    with tarfile.open(fileobj=io.BytesIO(data)) as tar:
        members = [member for member in tar if member.isfile()]
        files = {member.name: tar.extractfile(member).read() for member in members}
    return commit, seconds, files, {member.name for member in members if member.mode & 0o100}


def number(tree, commit, seconds, files):
    """Returns the version of a commit. Fails if the version's tag is at another commit."""
    text = files["CHANGELOG.md"].decode()
    newest = version.newest(text)
    if version.unreleased(text):
        return version.of_text(text, commit, seconds)
    tagged = output(["git", "-C", str(tree), "rev-parse", "-q", "--verify",
                     f"v{newest}^{{commit}}"], check=False).strip()
    if tagged and tagged != commit:
        raise Stop(f"release: version {newest} is already released as commit {tagged[:12]}; "
                   "give CHANGELOG.md a new version")
    return newest


def source(release):
    archive.tar(release.path("icesoc-VERSION.tar.gz"), f"icesoc-{release.version}", release.files,
                release.seconds, release.programs)


def icec(release):
    made = packs.library(release.version, release.tree)
    archive.tar(release.path("icec-VERSION.tar.gz"), f"icec-{release.version}",
                {name: text.encode() for name, text in made.items()}, release.seconds)
    date = time.strftime("%Y-%m-%d", time.gmtime(release.seconds))
    made = packs.cmsis(release.version, date, release.changes, release.tree)
    archive.zip_(release.path(f"{packs.VENDOR}.{packs.PACK}.VERSION.pack"),
                 {name: text.encode() for name, text in made.items()}, release.seconds)


def changes(release):
    release.path("CHANGES-VERSION.md").write_text(
        f"# IceSoC {release.version}\n\n{release.changes}\n")


def site(release):
    with tempfile.TemporaryDirectory() as work:
        run([release.tree / "icesoc", "docs", "--out", work], cwd=release.tree,
            env={"SOURCE_DATE_EPOCH": release.seconds})
        archive.tar_of_folder(release.path("icesoc-VERSION-site.tar.gz"),
                              f"icesoc-{release.version}-site", f"{work}/html", release.seconds)


def packages(release):
    """Copies the Debian packages in the given folders. `./icesoc package` must have built them from
    the same commit, on each release of Debian. Without folders, builds the packages from the
    working tree, which must equal the commit."""
    for folder in release.folders:
        copy_packages(release, Path(folder))
    if release.folders:
        return
    if output(["git", "-C", str(release.origin), "status", "--porcelain"]):
        raise Stop("release: Debian packages are made of the working tree, which has changes; "
                   "commit them, or choose other parts with --only")
    with tempfile.TemporaryDirectory() as work:
        run([release.origin / "icesoc", "package", "--output", work],
            env={"SOURCE_DATE_EPOCH": release.seconds})
        copy_packages(release, Path(work))


def copy_packages(release, folder):
    """Copies the Debian packages of a folder. The time of the files in a package is the time of the
    commit from which it was built; a package from another commit is an error."""
    found = sorted(folder.glob("*.deb"))
    if not found:
        raise Stop(f"packages: expected Debian packages in {folder}, got none; "
                   "./icesoc package builds them")
    for file in found:
        seconds = archive.time_of_package(file)
        if seconds != release.seconds:
            raise Stop(f"packages: {file}: expected files of {date(release.seconds)}, the time of "
                       f"commit {release.commit[:12]}, got {date(seconds)}; build the "
                       "package from that commit")
        if (release.out / file.name).exists():
            raise Stop(f"packages: {file}: another folder also has this package; give one "
                       "folder for each release of Debian")
        shutil.copyfile(file, release.out / file.name)


def date(seconds):
    return time.strftime("%Y-%m-%d %H:%M:%S UTC", time.gmtime(seconds))


def bill(release):
    made = {file.name: hashlib.sha256(file.read_bytes()).hexdigest()
            for file in release.out.iterdir()}
    release.path("icesoc-VERSION.spdx.json").write_text(
        sbom.document(release.version, release.commit, release.seconds, release.files, made))


MAKERS = dict(zip(PARTS, (source, icec, changes, site, packages, bill), strict=True))


def build(tree, out, parts, key, folders=()):
    """Makes the given parts in an empty folder, with SHA256SUMS and, if there is a key, a
    signature. `folders`: folders with Debian packages that are already built. Returns the version
    and the paths of the files; the signature is the last one."""
    commit, seconds, files, programs = read_commit(tree)
    with tempfile.TemporaryDirectory() as work:
        for name, data in files.items():
            file = Path(work, name)
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(data)
            file.chmod(0o755 if name in programs else 0o644)
        release = Release(number(tree, commit, seconds, files), commit, seconds, files, programs,
                          Path(work), Path(tree), Path(out), list(folders))
        shutil.rmtree(out, ignore_errors=True)
        release.out.mkdir(parents=True)
        for part, make in MAKERS.items():
            if part in parts:
                make(release)
    listed = archive.sums(out)
    made = sorted(path.name for path in Path(out).iterdir())
    return release.version, made + ([archive.sign(listed, key).name] if key else [])
