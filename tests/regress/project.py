# SPDX-License-Identifier: MIT
"""project: a small project for tests of the regression tool. Its tests pass, fail, crash or give
varying results.

The arguments of the test programs are case, work-folder and build-folder. Each case begins with the
project as it was committed.
"""
import os
import shlex
import sys
from pathlib import Path

from script import (LONGEST, TREE, Script, append, commit, edit, fresh, git,  # noqa: F401
                    main, repository, write)

BUILD = Path(sys.argv[3]) if len(sys.argv) > 3 else TREE / "build/main"
REGRESS = BUILD / "tests/regress/regress"

# Files of the project: test_a passes, test_b fails for all seeds except 7, test_c depends on the
# file `flicker`, test_d crashes.
FILES = {
    "CMakeLists.txt": """cmake_minimum_required(VERSION 3.25)
project(small NONE)
enable_testing()
add_subdirectory(tests/room)
""",
    "tests/room/CMakeLists.txt": """set(t ${CMAKE_CURRENT_SOURCE_DIR}/t.sh)
foreach(n a.One a.Two b.Bad c.Flicker d.Crash)
  add_test(NAME test_${n} COMMAND ${t} ${n})
  set_tests_properties(test_${n} PROPERTIES LABELS rtl)
endforeach()
add_test(NAME formal.thing COMMAND ${t} formal)
set_tests_properties(formal.thing PROPERTIES LABELS formal)
""",
    "tests/room/t.sh": """#!/bin/sh
case $1 in
b.Bad)
    [ "$SEED" = 7 ] || {
        echo "x.cpp:12: Failure"
        echo "value $SEED is not 7 </script>"
        exit 1
    } ;;
c.Flicker) [ ! -e ../../../../flicker ] ;;
d.Crash) kill -SEGV $$ ;;
formal)
    echo "kept: cached result of yesterday"
    echo "thing: bounded, 6 clocks"
    echo "thing: proven, 12 clauses with 3 flops"
    echo "thing: 2 covers reached" ;;
esac
""",
    ".gitignore": "build\n"}
# change of t.sh that makes test_a.One fail
BREAK = ("case $1 in\n", "case $1 in\na.One) exit 1 ;;\n")


class Project(Script):
    def setUp(self):
        self.work = fresh(sys.argv[2])
        repository()
        for name, text in FILES.items():
            write(name, text)
        self.tests("")
        os.symlink(BUILD / "page", "build/main/page")
        commit("one")

    def tests(self, text):
        """Adds tests to the project and configures it again."""
        append("tests/room/CMakeLists.txt", text)
        self.ask("cmake", "-S", ".", "-B", "build/main", "-G", "Ninja")

    def regress(self, words="", status=0, **how):
        self.ask(REGRESS, *shlex.split(words), status=status, **how)
