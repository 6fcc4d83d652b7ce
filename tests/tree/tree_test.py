#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""tree_test: tests set-up, skipped tests, a copy of the tree that is not a clone, and files for
editors.

Usage: tree_test.py CASE WORK-FOLDER BUILD-FOLDER
"""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from icesoc.site import figures
from icesoc.util.tree import tree_state
from script import TREE, Script, append, fresh, main, write

WORK, BUILD = map(Path, sys.argv[2:4])
TINY = r"""cmake_minimum_required(VERSION 3.25)
project(tiny NONE)
enable_testing()
add_test(NAME passes COMMAND true)
add_test(NAME by_script COMMAND sh -c "echo 'no right to mount'; exit 77")
add_test(NAME by_gtest COMMAND printf
         "[ RUN      ] A.B\\nfile.cpp:1: Skipped\\nno IPv6\\n\\n[  SKIPPED ] A.B\\n")
set_tests_properties(by_script by_gtest PROPERTIES SKIP_RETURN_CODE 77
                     SKIP_REGULAR_EXPRESSION "\\[  SKIPPED \\]")
"""


# files without an entry in compile_commands.json -> reason
RELEASED = "includes a single file of IceC, which is part of a release"
UCOS2 = "needs the sources of uC/OS-II; a build folder with UCOS2 lists it"
CORE = "includes the model of a core that the chip does not contain; a build folder with this " \
    "core in CORE_FOLDERS lists it"
NOT_LISTED = {
    "examples/foreign/polar/polar_test.cpp": CORE,
    "examples/porting/FreeRTOSConfig.h": "is included by FreeRTOS, which a test downloads",
    "examples/porting/bare_metal.c": RELEASED,
    "examples/porting/freertos.c": RELEASED,
    "examples/porting/host.c": RELEASED,
    "examples/porting/meter.c": RELEASED,
    "examples/porting/mps2.c": RELEASED,
    "sw/board/ucos2/app_cfg.h": UCOS2,
    "sw/board/ucos2/ucos2_hooks.c": UCOS2,
    "sw/board/ucos2/ucos2_kernel.c": UCOS2,
    "tests/bus/cores/data/adder_servant.h": "is part of a program that a test generates",
    "tests/e2e/cores/crc32/crc32_test.cpp": CORE,
    "tests/e2e/cores/servo/servo_test.cpp": CORE,
    "tests/package/project/server/server.c": "includes code that its own project generates",
    "tests/slice/linked/program.c": "includes code that its test generates",
}


class Cases(Script):
    def test_setup(self):
        """On a terminal, set-up lists the packages that it will install, and asks before it calls
        sudo; otherwise it continues without asking. In this test, the machine has one package and
        can install another one, and the user is not root."""
        work, setup = fresh(WORK), TREE / "cmake/setup.sh"
        for name, does in (("dpkg-query", "echo ';installed cmake;;not-installed verilator;'"),
                           ("id", "echo 1000"),
                           ("sudo", f'echo "$*" >>{work}/sudo')):
            write(work / "bin" / name, f"#!/bin/sh\n{does}\n")
        path = {"env": {**os.environ, "PATH": f"{work}/bin:{os.environ['PATH']}"}}
        asked = f"script -qec {setup} said >/dev/null || true"
        self.ask("sh", "-c", f"echo n | {asked}", **path)
        self.has("    verilator: turns", r"sudo apt-get\? \[Y/n\]", file="said")
        self.assertNotIn("    cmake:", Path("said").read_text())
        self.assertFalse(Path("sudo").exists(), "sudo was called after a no")
        for command in f"echo y | {asked}", setup:
            self.ask("sh", "-c", command, **path)
            self.has("apt-get install .* verilator", file="sudo")
            Path("sudo").unlink()

    def test_no_python(self):
        """On an empty Debian, which has no Python yet, ./icesoc first sets the machine up, also
        when make calls it. In this test, set-up installs a Python that prints its arguments."""
        work = fresh(WORK)
        for file in "icesoc", "Makefile", "tools/python":
            write(work / file, (TREE / file).read_text().replace("/usr/bin/", f"{work}/bin/"))
        write(work / "cmake/setup.sh", f"""#!/bin/sh
            mkdir bin && printf '#!/bin/sh\necho "runs $*"' >bin/python3 && chmod +x bin/python3""")
        for script in "icesoc", "tools/python", "cmake/setup.sh":
            (work / script).chmod(0o755)
        for words in ("./icesoc", "run"), ("make", "run"):
            self.ask(*words)
            self.has("^runs -m icesoc")
            shutil.rmtree("bin")
        # A set-up that failed ends the command.
        write("cmake/setup.sh", "#!/bin/sh\necho no sudo >&2\nexit 1\n")
        self.ask("./icesoc", "run", status=1)
        self.assertEqual(self.said, "no sudo\n")

    def test_skipped(self):
        """Skipped and failed tests are listed at the end with their reasons, the failed ones last
        (icesoc.regress.ctest)."""
        fresh(WORK)
        write("CMakeLists.txt", TINY)
        self.ask("cmake", "-B", "build", "-G", "Ninja")
        self.ask(TREE / "tools/python", "-m", "icesoc.regress.ctest", "--test-dir", "build")
        self.assertTrue(self.said.endswith("Skipped, 2:\n    by_script: no right to mount\n"
                                           "    by_gtest: no IPv6\n"), self.said)
        append("CMakeLists.txt", 'add_test(NAME fails COMMAND sh -c "echo error: no wind; false")\n'
               "add_test(NAME is_silent COMMAND false)\n")
        self.ask("cmake", "build")
        self.ask(TREE / "tools/python", "-m", "icesoc.regress.ctest", "--test-dir", "build",
                 status=None)
        self.assertTrue(self.said.endswith(
            "Skipped, 2:\n    by_script: no right to mount\n    by_gtest: no IPv6\n\n"
            "Failed, 2:\n    fails: error: no wind\n    is_silent: no output\n"), self.said)

    def test_tarball(self):
        """The tools can also list the files of a copy of the tree that is not a clone."""
        states = set()
        with tempfile.TemporaryDirectory() as copy:
            self.ask("sh", "-c", "git grep --no-index --exclude-standard --no-color -lz '' |"
                     f" xargs -0 cp --parents -t {copy}", cwd=TREE)
            for program in "arrows", "pages":
                self.ask(f"{copy}/tests/tree/{program}.py", copy)
            for tree in TREE, copy:
                states.add(tree_state(tree, "bus hdl"))
        self.assertEqual(len(states), 1, "the copy has another state")

    def test_figures_differ(self):
        """If a figure differs from its source, both values are reported, and `correct` writes the
        correct one. A picture without its text is also reported."""
        with tempfile.TemporaryDirectory() as copy:
            for name in [*figures.PLACES, "docs/figures.md", "synth/baseline.json"]:
                Path(copy, name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(TREE / name, Path(copy, name))
            page = Path(copy, "README.md")
            right = page.read_text()
            minimal, ff = (re.search(row, right, re.M)[1] for row in (
                r"^[|] all [|] 6840 [|] (\d+) [|]", r"^[|] flip-flops [|] 1537 [|] (\d+) [|]"))
            page.write_text(right.replace(f"| {minimal} |", "| 1 |").replace(f"| {ff} |", "| 2 |"))
            wrong = list(figures.differences(copy))
            self.assertIn(f"README.md: minimal is 1, but {minimal} in its source", wrong)
            self.assertIn(f"README.md: table1.ff is 2, but {ff} in its source", wrong)
            self.assertEqual(list(figures.correct(copy)), ["README.md"])
            self.assertEqual(page.read_text(), right)
            page.write_text(right.replace("the result equals", "the result equalled"))
            self.assertIn("README.md: expected the output of make run that "
                          "docs/pictures/mission.png contains, found another",
                          figures.differences(copy))
            self.assertEqual(list(figures.correct(copy)), ["README.md"])
            self.assertEqual(page.read_text(), right)
            picture = figures.PICTURE.format("utilisation")
            text = figures.text_of(Path(copy, picture))
            figures.put_text(Path(copy, picture), "")
            wrong = list(figures.differences(copy))
            self.assertTrue(wrong)
            for line in wrong:
                self.assertRegex(line, "expected '.*', found no such text|in docs/utilisation.md")
            figures.put_text(Path(copy, picture), text)
            self.assertEqual(list(figures.differences(copy)), [])

    def test_files(self):
        """The list of a model's Verilog files is enough to elaborate its top module."""
        lists = list(BUILD.glob("files/*.f"))
        self.assertTrue(lists, "no model is built")
        for files in lists:
            self.has("^// top: ", file=files)
            top = files.read_text().partition("// top: ")[2].split()[0]
            self.ask("verilator", "--lint-only", "--no-timing", "-Wno-lint", "-Wno-style",
                     "-Wno-fatal", "-f", files, "--top-module", top)

    def test_editors(self):
        """Editors find the compiler options of every C and C++ file of the tree in
        compile_commands.json, except for the files in NOT_LISTED. Clang accepts the options of the
        files that are listed for editors only."""
        entries = {entry["file"]: entry
                   for entry in json.loads((BUILD / "compile_commands.json").read_text())}
        files = [TREE / file for file in subprocess.check_output(
            "git grep --no-index --exclude-standard -Il '' -- '*.c' '*.cpp' '*.h'", text=True,
            shell=True, cwd=TREE).splitlines()]
        included = {name for file in files for name in re.findall(
            r'(?m)^#\s*include "(?:.*/)?([^"/]+)"', file.read_text())}
        listed = {file for file in files if str(file) in entries
                  or (file.suffix == ".h" and file.name in included)}
        self.assertEqual([str(file.relative_to(TREE)) for file in files if file not in listed],
                         sorted(NOT_LISTED))
        failed = []
        for file, entry in entries.items():
            if "for_editors_" not in entry["command"]:
                continue
            words = re.sub(r" -o \S+ -c ", " -fsyntax-only -Wno-unused-command-line-argument ",
                           entry["command"]).split()
            compiler = "clang++" if file.endswith(".cpp") else "clang"
            done = subprocess.run([compiler, *words[1:]], cwd=entry["directory"], text=True,
                                  stderr=subprocess.STDOUT, stdout=subprocess.PIPE)
            failed += [done.stdout] * (done.returncode != 0)
        self.assertEqual(failed, [])


main(Cases)
