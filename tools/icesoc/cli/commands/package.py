# SPDX-License-Identifier: MIT
"""package: Debian packages of the project, one for each role of a user (docs/install.md)."""
import os
import shutil
from pathlib import Path
from subprocess import DEVNULL

from icesoc.cli.build_folder import BuildFolder
from icesoc.cli.command import command
from icesoc.cli.options import FOLDER, JOBS, SWITCH, Option
from icesoc.release import version
from icesoc.util.console import say
from icesoc.util.process import logged, output as read, run
from icesoc.util.rooms import rooms

BUILD = "build/package"
ROOMS = ";".join(rooms("core"))


@command("package", [
    Option("build", FOLDER, "build folder. In the default folder, programs are compiled for any "
                            "CPU of this architecture. In any other folder, such as build/main, "
                            "they are compiled only for this machine's CPU",
           BUILD),
    Option("output", FOLDER, "folder for the packages", "build/packages"),
    Option("check", SWITCH, "check the packages with lintian"), JOBS], make="package",
         brief="package --build build/main --output build/brief/packages", examples=[
             "package", "package --check", "package --output ~/packages"])
def package(values):
    """build the Debian packages for this release of Debian

    The packages contain programs, libraries and hardware sources that work without this tree.
    docs/install.md describes them.
    """
    own = ["-DPORTABLE=ON", f"-DROOMS={ROOMS}"] if values.build == BUILD else []
    number = version.of_commit()
    build = BuildFolder(values.build, values).prepare(*own, f"-DDEB_VERSION={number}",
                                                      packages=True)
    build.set(DEB_VERSION=number)
    build.ninja("installable")
    output = Path(values.output).absolute()
    output.mkdir(parents=True, exist_ok=True)
    for path in output.glob("*.deb"):
        path.unlink()
    pack(build.folder, output)
    found = sorted(output.glob("*.deb"))
    for path in found:
        say(f"{path.stat().st_size:>9} bytes  {path}")
    if not values.check:
        return 0
    return run(["lintian", "--fail-on", "error", "--tag-display-limit", "0", *found], check=False)


def pack(build, output):
    """Writes the packages of a build folder to the folder `output`, with the same bytes for the
    same commit: files have the time of the commit, and the modes of folders do not depend on the
    user's umask. With a umask of 077, only root could use the installed packages."""
    commit = read(["git", "log", "-1", "--format=%ct"], check=False, stderr=DEVNULL).strip()
    os.umask(0o022)
    logged(["cpack", "-G", "DEB", "-B", output, "--config", Path(build, "CPackConfig.cmake")],
           Path(build, "package.log"), "CPack failed",
           env={"SOURCE_DATE_EPOCH": commit} if commit and "SOURCE_DATE_EPOCH" not in os.environ
           else None)
    shutil.rmtree(Path(output, "_CPack_Packages"))
