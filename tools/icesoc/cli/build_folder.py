# SPDX-License-Identifier: MIT
"""build_folder: configures and builds a build folder with CMake and ninja. If two commands build in
one folder, the second waits for the first."""
import contextlib
import os
import re
import shutil
import time
from pathlib import Path

from icesoc.cli import keys
from icesoc.util import cmake
from icesoc.util.console import warn
from icesoc.util.errors import Stop
from icesoc.util.lock import lock
from icesoc.util.ninja import run_ninja
from icesoc.util.process import run, tool
from icesoc.util.rooms import rooms
from icesoc.util.spelling import option

DEFAULT_BOARD, DEFAULT_BRIDGE = "nucleo-qmtech", "async"
ROOMS_OF_PROGRAMS = ";".join(rooms("program"))


def writable(folder, otherwise):
    """Creates a folder. Fails if the folder is not writable; the message then ends with the advice
    `otherwise`."""
    try:
        Path(folder).mkdir(parents=True, exist_ok=True)
    except OSError:
        pass
    if not os.access(folder, os.W_OK):
        raise Stop(f"{folder} is not writable; {otherwise}")


def check_spaces(folder):
    """Fails if the path of a folder contains a space. Packages are installed only after this check,
    because that takes minutes."""
    if " " in os.path.abspath(folder):
        raise Stop(f"'{os.path.abspath(folder)}': expected a folder without spaces in its path, "
                   "because Verilator's makefiles do not support them; move or rename the folder",
                   2)


def read_list(path):
    """Returns the text of a cores.list. Its lines end with a newline only, so str.splitlines, which
    also splits at form feeds, must not be used."""
    try:
        return Path(path).read_text("utf-8-sig")
    except ValueError as error:
        raise Stop(f"{path}: expected text in UTF-8") from error


def packages_now(words):
    """Returns a text that changes if the command `words`, its script or Debian's list of installed
    packages changes. Without such a list, it changes each time."""
    status = Path(os.environ.get("DPKG_ADMINDIR", "/var/lib/dpkg"), "status")
    times = [path.stat().st_mtime_ns if path.exists() else time.time_ns()
             for path in (status, Path(words[0]))]
    return f"{words} {status} {times}"


def cores_in(folder):
    """Returns the folders of the cores in a folder. A folder with a cores.list is a repository, and
    has several cores. Any other folder is itself the only core."""
    return sorted(path.parent for path in folder.glob("*/core.toml")) \
        if (folder / "cores.list").is_file() else [folder]


class BuildFolder:
    """The build folder that the options of a command name."""
    def __init__(self, folder, values):
        self.folder, self.jobs, self.built = Path(folder), values.jobs, values.built
        self.ucos2 = getattr(values, "ucos2", "")
        self.core_folders = getattr(values, "core_folders", None) or ""

    def __truediv__(self, name):
        return self.folder / name

    def prepare(self, *arguments, tests=False, packages=False, core_tests=False):
        """Installs missing packages; with `tests`, also those for tests, and with `packages`, also
        those that make Debian packages. Then runs CMake, unless the folder is configured. With
        `core_tests`, a new folder is configured for the tests of cores only, which takes a third of
        the time; the next command of another kind configures the rest."""
        if not self.built:
            check_spaces(".")
            check_spaces(self.folder)
            words = ["cmake/setup.sh", *["--tests"] * tests, *["--packages"] * packages]
            checked, state = self / "packages.checked", packages_now(words)
            is_checked = checked.exists() and checked.read_text() == state
            if not is_checked:
                run(words)
            self.configure(*arguments, *["-DCORE_TESTS_ONLY=ON"] * core_tests)
            if not core_tests and self.cached("CORE_TESTS_ONLY") == "ON":
                self.set(CORE_TESTS_ONLY="OFF")
            if not is_checked:
                checked.write_text(packages_now(words))
            if self.ucos2:
                self.set(UCOS2=os.path.abspath(self.ucos2))
            self.forget_deleted_cores()
            if self.core_folders:
                self.set(CORE_FOLDERS=";".join(map(str, self.other_cores())),
                         **({"CORES": str(self.chip_list())} if self.chip_list() else {}))
        return self

    def configure(self, *arguments):
        """Runs CMake, unless the folder is configured. A folder that was configured under another
        path is removed first, because CMake would refuse it."""
        writable(self.folder, "the build is written there: use a clone of your own, or give "
                 "--build (BUILD=) a folder that you can write")
        cache = os.environ.get("XDG_CACHE_HOME") or os.path.join(os.environ["HOME"], ".cache")
        writable(cache, "downloads and compiler results are stored there: set XDG_CACHE_HOME to a "
                 "folder that you can write")
        home = self.cached("CMAKE_HOME_DIRECTORY")
        if home and not (os.path.isdir(home) and os.path.samefile(home, ".")):
            warn(f"{self.folder} was configured for the tree in {home}: creating it again")
            keys.rescue(self.folder)
            shutil.rmtree(self.folder)
            self.folder.mkdir()
        with self.alone():
            if not (self / "build.ninja").exists():
                run(["cmake", "-S", ".", "-B", self.folder, "-G", "Ninja", *arguments])
        commands = Path("compile_commands.json")
        # Editors look for compile_commands.json in the tree. No link is made to a build folder
        # outside the tree.
        if not commands.exists() and self.folder.absolute().is_relative_to(Path.cwd()):
            with contextlib.suppress(OSError):
                commands.unlink(missing_ok=True)
                commands.symlink_to(os.path.relpath(self / commands))

    def cached(self, name):
        """Returns the value of a variable in CMake's cache; empty if it is not set."""
        return cmake.cached(self.folder, name)

    def known_cores(self):
        """Returns the names of all cores of the last configuration."""
        return cmake.cached_list(self.folder, "KNOWN_CORES")

    def set(self, **variables):
        """Sets variables of CMake; if CMake refuses a value, prints the reason and restores the old
        values."""
        if all(self.cached(name) == value for name, value in variables.items()):
            return
        words = ["cmake", *(f"-D{name}={value}" for name, value in variables.items()),
                 str(self.folder)]
        with self.alone(), open(self / "set.log", "w") as log:
            cache = (self / "CMakeCache.txt").read_bytes()
            status = run(words, check=False, stdout=log, stderr=log)
            if status:
                (self / "CMakeCache.txt").write_bytes(cache)
        if status:
            reasons = re.findall(r"^CMake Error.*?(?=^$|\Z)", (self / "set.log").read_text(),
                                 re.M | re.S)
            raise Stop("CMake refuses " + " ".join(words[1:-1]) + "\n" + "\n".join(reasons))

    def other_cores(self):
        """Returns the folders of cores outside ip/ that the command names or, if it names none,
        the folders in the earlier configuration."""
        if self.core_folders == "none":
            return []
        folders = self.core_folders or self.cached("CORE_FOLDERS")
        return [core for folder in folders.split(";") if folder
                for core in cores_in(Path(folder).absolute())]

    def forget_deleted_cores(self):
        """Removes folders of cores that no longer exist from the configuration, unless the command
        names the folders. CMake would refuse the missing folders, and every command would fail."""
        folders = [folder for folder in self.cached("CORE_FOLDERS").split(";") if folder]
        kept = [folder for folder in folders if os.path.isdir(folder)]
        if self.core_folders or kept == folders:
            return
        gone = [folder for folder in folders if folder not in kept]
        warn(f"{' '.join(gone)} no longer exist{'s' * (len(gone) == 1)}; the build continues "
             f"without {'it' if len(gone) == 1 else 'them'}: {option('core-folders', 'FOLDER')} "
             "adds a core again")
        chip = self.cached("CORES")  # may be the cores.list of a deleted repository
        self.set(CORE_FOLDERS=";".join(kept), **(
            {"CORES": os.path.abspath("ip/cores.list")} if not os.path.isfile(chip) else {}))

    def chip_list(self):
        """Returns the path of the list of the chip's cores, or None if the command does not change
        it. If the command names folders, the result is the cores.list of the first folder that has
        one. If it names `none`, which selects only the cores of the tree, the result is
        ip/cores.list."""
        if self.core_folders == "none":
            return Path("ip/cores.list").absolute() if self.cached("CORES") else None
        lists = (Path(folder).absolute() / "cores.list" for folder in self.core_folders.split(";"))
        return next(filter(Path.is_file, lists), None) if self.core_folders else None

    def core(self, name):
        """Returns the folder of a core."""
        return next((folder for folder in self.other_cores() if folder.name == name),
                    Path("ip", name))

    def follow(self, other, **variables):
        """Configures this folder with the chip of another build folder."""
        if other.cached("CMAKE_HOME_DIRECTORY"):
            variables["CORE_FOLDERS"] = other.cached("CORE_FOLDERS")
        if other.cached("CORES"):
            variables["CORES"] = other.cached("CORES")
        self.set(**variables)

    def for_vehicle(self, board="", bridge=""):
        """Returns the build folder with the simulator and the firmware of a board (the name of a
        folder of boards/, or a file board.toml) and of a bridge (async or sync). An empty text
        stands for the board or the bridge of this folder. It is this folder if it was configured
        for both; otherwise it is another folder with the same cores."""
        own = self.cached("BOARD") or DEFAULT_BOARD
        if board in ("", own) and bridge in ("", self.cached("BRIDGE") or DEFAULT_BRIDGE):
            return self
        board, bridge = board or own, bridge or DEFAULT_BRIDGE
        path, words, variables = Path(board), [], {"BRIDGE": bridge}
        if board != DEFAULT_BOARD or bridge == DEFAULT_BRIDGE:
            is_file = path.suffix == ".toml"
            words.append(f"board_{path.absolute().parent.name if is_file else board}")
            variables["BOARD"] = str(path.absolute()) if is_file else board
        name = "_".join([*words, *[bridge] * (bridge != DEFAULT_BRIDGE)])
        other = BuildFolder(f"build/{name}", self)
        other.built = False
        other.configure(*(f"-D{name}={value}" for name, value in variables.items()),
                        f"-DROOMS={ROOMS_OF_PROGRAMS}")
        # the folder may be configured for a file board.toml in another folder with this name
        other.follow(self, CLK_HZ=self.cached("CLK_HZ") or "100000000", **variables)
        return other

    def alone(self):
        """Locks the folder, because two commands that configure or build it would disturb each
        other."""
        return lock(self.folder, busy=f"waiting for another build in {self.folder} ...")

    def ninja(self, *words, check=True, env=None, jobs=None):
        """Builds targets."""
        if self.built:
            return 0
        with self.alone():
            return run_ninja(["ninja", "-C", self.folder, "-j", jobs or self.jobs, *words],
                             self.folder / "build.log", check, env)

    def ctest(self, *words, tests, check=True, junit="junit.xml", **env):
        """Runs tests with CTest, and writes their results into the build folder."""
        return run([*tool("regress.ctest"), "--test-dir", self.folder, "-j", tests,
                    "--output-on-failure", "--no-tests=error", "--output-junit",
                    (self / junit).absolute(), *words], env=env, check=check)


def configured(values, *targets, tests=False):
    """Builds targets in the build folder of a command, and returns this folder."""
    build = BuildFolder(values.build, values).prepare(tests=tests)
    if targets:
        build.ninja(*targets)
    return build


def netlists(values, *words, **how):
    """Returns the build folder of netlists for the FPGA family in --family."""
    families = {"xc6s": "build/netlist", "ecp5": "build/netlist_ecp5"}
    return BuildFolder(families[values.family], values).prepare(
        "-DNETLIST=ON", f"-DNETLIST_FAMILY={values.family}", *words, **how)


def fetch(what, folder, check=True):
    return run([*tool("util.fetch"), what, folder], check=check)
