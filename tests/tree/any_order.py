#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""any_order: on a machine without the packages that tests need, `make run` followed by `make test`,
which installs these packages, must find the same tests as a machine that had all packages from the
start. If CMake does not find something that it needs, its message must name the package.

The test simulates a machine without these packages by a folder of links to all other programs.
CMake looks for programs only in this folder.
Usage: any_order.py source-folder work-folder
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys

FOLDERS = ("/usr/local/sbin", "/usr/local/bin", "/usr/sbin", "/usr/bin", "/sbin", "/bin")


def fail(text):
    sys.exit(f"any_order: {text}")


def run(words, **options):
    return subprocess.run(words, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          **options)


def packages(source, work, *options):
    """Returns the packages that set-up would install on an empty machine."""
    nothing = work / "nothing"
    nothing.mkdir(exist_ok=True)
    (nothing / "dpkg-query").write_text("#!/bin/sh\n")
    (nothing / "dpkg-query").chmod(0o755)
    said = run([source / "cmake/setup.sh", *options, "--check"],
               env={**os.environ, "PATH": f"{nothing}:{os.environ['PATH']}"}).stdout
    return {line.split(":")[0].strip() for line in said.splitlines() if line.startswith("    ")}


def programs_of(names):
    files = run(["dpkg", "-L", *names]).stdout.splitlines()
    return {os.path.basename(file) for file in files if os.path.dirname(file) in FOLDERS}


def links(folder, hidden):
    folder.mkdir()
    for place in FOLDERS[::-1]:
        for program in os.scandir(place) if os.path.isdir(place) else ():
            link = folder / program.name
            if program.name not in hidden:
                link.unlink(missing_ok=True)
                link.symlink_to(program.path)
    return folder


def configure(source, build, work, path):
    """Configures a build as on a machine that has only the programs in `path`. Once the file
    `arrived` exists, the machine has all programs."""
    hide = work / "hide.cmake"
    hide.write_text(f'if(NOT EXISTS "{work}/arrived")\n'
                    f'  set(CMAKE_IGNORE_PATH "{";".join(FOLDERS)}")\nendif()\n')
    return run(["cmake", "-S", source, "-B", build, "-G", "Ninja",
                f"-DCMAKE_PROJECT_INCLUDE_BEFORE={hide}"], env=environment(work, path))


def environment(work, path):
    return {**os.environ, "PATH": str(path), "DPKG_ADMINDIR": str(work / "dpkg")}


def tests(build):
    shown = run(["ctest", "--test-dir", build, "--show-only=json-v1"])
    return [test["name"] for test in json.loads(shown.stdout)["tests"]]


def main():
    source, work = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    shutil.rmtree(work, ignore_errors=True)
    (work / "dpkg").mkdir(parents=True)
    (work / "dpkg/status").touch()
    of_tests = packages(source, work, "--tests") - packages(source, work)
    hidden = programs_of(of_tests)
    for program in ("gdb-multiarch", "xmllint", "strace", "clang-format-19", "chromium", "tshark",
                    "gtkwave"):
        if program not in hidden:
            fail(f"{program} is in no package of ./icesoc setup --tests: {sorted(of_tests)}")

    poor = links(work / "poor", {"yosys", "ccache"})
    said = configure(source, work / "without", work, poor)
    word = "yosys is missing (Debian: yosys): run './icesoc setup'"
    if not said.returncode or word not in said.stdout:
        fail(f"no word of a missing yosys:\n{said.stdout}")
    if "ccache is missing" not in said.stdout:
        fail(f"no word of a missing ccache:\n{said.stdout}")

    said = configure(source, work / "grown", work, links(work / "bin", hidden))
    if said.returncode:
        fail(f"make run needs the packages of tests:\n{said.stdout}")
    # A new configuration must remove the generated files of cores that are no longer in the list,
    # and no other files.
    generated = work / "grown/gen"
    names = {path.name.split(".")[0] for room in ("hdl", "ip")
             for path in source.glob(f"{room}/*/*.regs.json")}
    needed = {generated / f"{name}_regs.v" for name in names}
    stale = generated / "left_the_list.v"
    for file in (*needed, stale):
        file.touch()
    (work / "arrived").touch()
    (work / "dpkg/status").touch()
    said = run(["ninja", "-C", work / "grown", "build.ninja"],
               env=environment(work, os.environ["PATH"]))
    if said.returncode:
        fail(f"configured a second time:\n{said.stdout}")
    if removed := sorted(file.name for file in needed if not file.exists()):
        fail(f"a second configuration removes {', '.join(removed)}")
    if stale.exists():
        fail(f"a second configuration keeps {stale.name}, which no rule makes")
    said = configure(source, work / "rich", work, os.environ["PATH"])
    if said.returncode:
        fail(f"configured with all packages:\n{said.stdout}")
    grown, rich = tests(work / "grown"), tests(work / "rich")
    if len(rich) < 200:
        fail(f"only {len(rich)} tests are configured")
    if grown != rich:
        fail(f"tests of the one order only: {sorted(set(grown) ^ set(rich))}")
    print(f"{len(rich)} tests and programs of tests in either order, {len(hidden)} programs hidden")
    for build in ("without", "grown", "rich"):
        shutil.rmtree(work / build, ignore_errors=True)


if __name__ == "__main__":
    main()
