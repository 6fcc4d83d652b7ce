#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""commands_test: starts commands with make, with each of their variables, and tests their effects.

Usage: commands_test.py commands_... work-folder build-folder
"""
import os
import re
import shutil
import signal
import subprocess
from pathlib import Path

from icesoc.util.cmake import shown_tests
from project import (BUILD, LONGEST, REGRESS, TREE, Project, append, edit, git, main,
                     write)

FETCH = TREE / "tools/python", "-m", "icesoc.util.fetch"
WAVED = r"""#!/bin/sh
case $1 in
--gtest_list_tests) printf 'Fir.\n  Impulse\n  ImpulseAndStep\n' ;;
*) printf '$comment %s $end\n$var wire 1 a a $end\n$enddefinitions $end\n#0\n1a\n' "$1" >"$WAVE.vcd"
   vcd2fst "$WAVE.vcd" "$WAVE" ;;
esac
"""
TESTS = r"""
set(work ${CMAKE_SOURCE_DIR})
set(build ${CMAKE_BINARY_DIR})
add_custom_target(regress ALL COMMAND mkdir -p tests/regress tests/hdl/formal/thing
  COMMAND ln -sf REGRESS tests/regress/regress COMMAND sh -c "echo 3 >tests/hdl/formal/thing/cpu"
  WORKING_DIRECTORY ${build} VERBATIM)
foreach(target sanitized regmaps bench_programs mission)
  add_custom_target(${target})
endforeach()
add_custom_target(size COMMAND cp ${work}/size.json ${work}/build)
add_custom_target(nothing)
add_test(NAME bench.bad COMMAND sh -c
  "test ! -e ${work}/slow && cp ${work}/air.json $0" ${build}/bad.json --brief)
add_test(NAME bench.good COMMAND sh -c "flock -n ${build} cp ${work}/air.json $0"
         ${build}/good.json --brief)
set_tests_properties(bench.bad PROPERTIES ENVIRONMENT "NEEDS=")
set_tests_properties(bench.good PROPERTIES ENVIRONMENT "NEEDS=nothing")
foreach(core fir ${CORE_FOLDERS})
  get_filename_component(core ${core} NAME)
  add_custom_target(test_ip_${core} ALL COMMAND cp ${work}/waved ${build}/test_ip_${core})
  add_custom_target(tests_of_${core} DEPENDS test_ip_${core})
  list(APPEND known ${core})
  add_test(NAME test_ip_${core}.Impulse COMMAND echo "note: LEVELS: not read back")
endforeach()
set(KNOWN_CORES "${known}" CACHE INTERNAL "")
set(TESTED_CORES "${known}" CACHE INTERNAL "")
add_custom_target(synth_inputs COMMAND mkdir -p ${build}/synth
  COMMAND cp ${work}/utilisation ${build}/synth)
add_test(NAME test_s.Sane COMMAND sh -c
  "case ${build} in *sanitized) ! test -e ../../../../leak ;; esac")
set_tests_properties(test_s.Sane PROPERTIES LABELS sanitized)
foreach(label zeroc nightly)
  add_test(NAME ${label}.Suite CONFIGURATIONS ${label}
           COMMAND sh -c "echo ${label} >>../../../../done")
  set_tests_properties(${label}.Suite PROPERTIES LABELS ${label})
endforeach()
"""
STEPS = """#!/usr/bin/python3
import sys
name = "_".join(word for word in sys.argv[1:4] if word.isalpha())
open("done", "a").write(name + "\\n")
sys.exit(name == open("failing").read())
"""
DONE = """zeroc nightly run run fly synth_report core_examples check_netlist check_netlist
check_sanitizers check_fuzz check_mutants check_mutants check_faults check_soak bench
check_coverage check_fresh check_tutorial"""


class Cases(Project):
    def user(self, words, *more, **how):
        """Runs make in the whole source tree, in which everything has been built."""
        self.make(*words.split(), *more, build=BUILD, **how)

    def test_commands_run(self):
        flight = self.work / "flight"
        write(flight / "flight.jsonl", "{}\n")
        write(flight / "status", "up\n")
        for words, said in (
            # these errors are reported before a simulator for the replay is built
            (f"run REPLAY={flight} FROM=x", "FROM: expected a number, at least 0 s, got 'x'"),
            (f"run REPLAY={flight} FROM=2 TO=1", "FROM=2.0 TO=1.0: expected the start"),
            (f"run IMAGE=/none OUT={flight}", "cannot read '/none'"),
            ("synth BASE=none", "unknown commit BASE=none"),
            ("faults NAME=nonsense", "faults: none is called nonsense; there are clock_step")):
            with self.subTest(words):
                self.user(words, status=2)
                self.has(said)
                # The message must not advise a replay, because that would repeat the earlier flight
                # in this folder.
                self.lacks("Traceback|--help" + ("|REPLAY=" if "IMAGE" in words else ""))
        with open(self.work / "commands", "w+") as commands:
            commands.write("print $pc\nkill\n")
            commands.seek(0)
            self.user("gdb SIZE=96x64", f"OUT={self.work}/gdb", stdin=commands)
        self.has("Reset_Handler")
        self.user("firmware")
        self.has("^Written: build/firmware.json")
        self.user("faults NAME=no_memory MOMENTS=1 SEEDS=1 SEED=3")
        self.has("^faults: 1 moments of seeds 3 to 3, 0 failed")

    def test_commands_radio(self):
        """Runs short parts of commands that normally take hours."""
        # `soak` and `fly` both run test_chip_soak. Here the filter skips it in `soak`, so that it
        # runs only once.
        os.environ["GTEST_FILTER"] = "-ChipSoak*"
        self.user("soak MINUTES=0.01 FUZZED=1000")
        self.has("^modem controller: 1000 bytes of noise", "^link layer: 10000 bytes of noise",
                 "^soak: none wrong, .* none at another")
        del os.environ["GTEST_FILTER"]
        self.user("fly MINUTES=0.01")
        self.has("^chip soak: .* simulated")

    def entrance(self):
        """Adds to this project all files of a build that commands need."""
        write("cmake/setup.sh", "#!/bin/sh\n")
        write("ip/fir/fir_test.cpp", "")
        write("tests/bench/figures.py", (TREE / "tests/bench/figures.py").read_text())
        write("waved", WAVED)
        write("size.json", '[{"name": "call", "value": 4, "unit": "bytes"}]')
        write("air.json",
              '[{"name": "trip", "value": 20, "unit": "ms", "limit": 40, "share": 0.5}]')
        edit("tests/room/CMakeLists.txt", " d.Crash", "")
        append("tests/room/CMakeLists.txt", TESTS.replace("REGRESS", str(REGRESS)))

    def good(self, words, status=0):
        self.make("JOBS=1", *words.split(), tree=self.work, build=None, status=status)

    def bad(self, words, *said):
        self.good(words, 2)
        self.has(*said)

    def test_commands_small(self):
        self.entrance()
        self.ask("rm", "-rf", "build")
        self.good("build")
        self.assertTrue(os.access("build/main/tests/regress/regress", os.X_OK))
        self.good("test NAME=b.Bad LABEL=rtl SEED=7")
        self.bad("test NAME=b.Bad SEED=3", "value 3 is not 7")
        self.bad("test LABEL=nothing")
        self.good("test SEED=7")
        # the second run is the one with sanitizers
        self.assertEqual(self.said.count("100% tests passed"), 2)
        self.unchanged_tests_are_left_out()
        self.a_stopped_run_keeps_its_results()
        write("leak", "")
        self.bad("test SEED=7", "test_s.Sane")
        Path("leak").unlink()
        self.good("proofs")
        self.has("^1 proofs, 3 s of CPU time$")
        self.good("regress BLOCK=room NAME=[ab][.] LABEL=rtl SEED=7 WAVES=0 TESTS=2")
        self.has("^3 passed")
        self.bad("regress NAME=b.Bad REPEAT=2", "SEED=2")
        self.bad("regress FAILED=1", "^1 tests")
        self.bad("regress KEPT=1", "^1 tests, SEED=2")
        self.good("regress CHANGED=1 NAME=a[.]")
        # If a bench fails, the figures of the other benches are still written. Earlier figures of
        # the failed bench do not count as new.
        figures = Path("docs/figures.md")
        figures.parent.mkdir()
        trip = "| trip | 20 ms | limit 40, 50.0 % |\n"
        self.good("bench")
        self.assertEqual(figures.read_text().count(trip), 2, figures.read_text())
        self.has(rf"^Measured on .* at commit {git('rev-parse --short HEAD')} and changes to it\.$",
                 file=figures)
        write("slow", "")
        self.bad("bench", "^icesoc: bench bad: exit status 1")
        self.assertEqual(figures.read_text().count("\n| trip "), 1, figures.read_text())
        self.has("^[|] call [|] 4 bytes [|]", file=figures)
        os.environ["DISPLAY"] = ""
        self.good("wave IP=fir TEST=Impulse")
        self.has("^gtkwave .*/build/wave/fir.fst")
        self.has(" --gtest_filter=Fir.Impulse ", file="build/wave/fir.fst.vcd")
        self.good("wave IP=fir TEST=And")
        self.good("wave IP=test_ip_fir TEST=Impulse")  # any program
        self.has("^gtkwave .*/build/wave/test_ip_fir.fst")
        self.bad("wave IP=fir TEST=Imp", "expected an expression that matches one test, got 2")
        self.good("ip-test IP=fir")
        self.has("1 tests passed|100% tests passed", "^test_ip_fir.Impulse: LEVELS: not read back$")
        self.bad("ip-test IP=nobody", "IP: expected the name of a core, got 'nobody'; .*fir")
        self.elsewhere()
        self.bad("bisect TEST=test_a.One GOOD=nonsense BAD=HEAD SEED=1",
                 "unknown commit GOOD=nonsense")
        self.good("clean")
        self.assertFalse(Path("build").exists())

    def unchanged_tests_are_left_out(self):
        """`make test` runs only tests that have not passed with the current inputs (files, seed,
        packages)."""
        self.good("test SEED=7")
        self.has("^build/main: [0-9]+ tests have passed with the present files and packages; --all",
                 "^build/sanitized: 1 tests have")
        self.lacks("tests passed")
        self.good("test SEED=7 ALL=1")
        self.assertEqual(self.said.count("100% tests passed"), 2)
        write("note", "a file more")
        self.good("test SEED=7")
        self.assertEqual(self.said.count("100% tests passed"), 2)
        Path("note").unlink()

    def a_stopped_run_keeps_its_results(self):
        """After Ctrl-C during `make test`, junit.xml contains the tests that had finished, their
        passes count, and no process is left."""
        tests = Path("tests/room/CMakeLists.txt")
        before = tests.read_text()
        append(tests, 'add_test(NAME script.Waits COMMAND sh -c '
                      '"[ -e ../../go ] || { sleep 1234 & wait; }")\n')
        run = subprocess.Popen(["make", "-s", "-C", TREE, "test", "SEED=9", "TESTS=4"],
                               env={**os.environ, "ICESOC_TREE": str(self.work), "MAKEFLAGS": ""},
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                               start_new_session=True)
        said, ended = "", 0
        for line in run.stdout:
            said += line
            ended += " Test " in line and " sec" in line
            if ended == 4:
                break
        os.killpg(run.pid, signal.SIGINT)
        self.said = said + run.communicate(timeout=LONGEST)[0]
        self.has("^stopped after [4-9] of [0-9]+: [3-9] passed, [01] failed")
        left = ["pgrep", "--session", str(run.pid), "--runstates", "D,I,R,S,T,t"]
        self.assertEqual(subprocess.run(left, stdout=subprocess.PIPE).stdout, b"", self.said)
        self.has("<testcase name=.test_a.One", file="build/main/junit.xml")
        self.lacks("script.Waits", file="build/main/junit.xml")
        write("build/main/go", "")
        self.bad("test SEED=9", "value 9 is not 7", "^build/main: [3-9] tests have passed with the")
        tests.write_text(before)

    def elsewhere(self):
        """If a core outside the tree is passed to one command, all later commands know it."""
        mine = self.work / "elsewhere/mine"
        write(mine / "mine_test.cpp", "")
        write("utilisation", '#!/bin/sh\necho "utilisation $*"\n')
        os.chmod("utilisation", 0o755)
        write("ip/cores.list", "fir\n")
        self.bad(f"run CORES=mine CORE_FOLDERS={mine}", f"{mine}/ground.py not found")
        write(mine / "ground.py", "")
        self.bad(f"run CORES=mine CORE_FOLDERS={os.path.relpath(mine)}",
                 "the chip has no core 'mine'")
        self.good(f"ip-test IP=mine CORE_FOLDERS={os.path.relpath(mine)}")
        self.has(f"^CORE_FOLDERS.*={mine}$", file="build/main/CMakeCache.txt")
        for words, said in (("regress NAME=test_ip_mine", "^1 passed"),
                            ("ip-synth IP=mine", "^utilisation .*--design mine$"),
                            ("synth DESIGN=mine", "^utilisation .*--design mine$"),
                            ("wave IP=mine TEST=Impulse", "^gtkwave .*/build/wave/mine.fst")):
            self.good(words)
            self.has(said)
        write("ip/cores.list", "fir\nmine clock_i=@B8\n")
        self.good("rm-ip NAME=mine")
        self.has("^CORE_FOLDERS.*=$", file="build/main/CMakeCache.txt")
        self.assertEqual(Path("ip/cores.list").read_text(), "fir\n")
        self.assertTrue((mine / "ground.py").exists())
        self.bad("wave IP=mine TEST=Impulse", "'mine'.*fir")
        # If the folder of a core or of a repository is deleted, the build continues without it.
        mine = self.work / "repository/mine"
        write(mine / "core.toml", "")
        write(mine / "mine_test.cpp", "")
        write(mine.parent / "cores.list", "fir\nmine\n")
        self.good(f"ip-test IP=mine CORE_FOLDERS={mine.parent}")
        self.has(f"^CORES:.*={mine.parent}/cores.list$", file="build/main/CMakeCache.txt")
        shutil.rmtree(mine.parent)
        self.good("ip-test IP=fir")
        self.has(f"^icesoc: {mine} no longer exists; the build continues without it: "
                 "CORE_FOLDERS=FOLDER adds a core again$")
        self.has("^CORE_FOLDERS:.*=$", "^CORES:.*=.*/ip/cores.list$",
                 file="build/main/CMakeCache.txt")
        self.good("ip-test IP=fir")
        self.lacks("no longer exists")

    def test_commands_nightly(self):
        """A step runs even if earlier steps failed, and each failure is reported."""
        self.entrance()
        write("icesoc", STEPS)  # replaces commands that would take hours
        os.chmod("icesoc", 0o755)
        edit("tests/room/t.sh", "value $SEED is not 7", "failed with $SEED")
        edit("tests/room/t.sh", '"$SEED" = 7', "! -e ../../../../bad")
        for failing, seeds, status in (("none", 2, 0), ("check_mutants", 2, 2), ("fly", 2, 2),
                                       ("check_fresh", 2, 2), ("a test", 2, 2),
                                       # two random seeds, and the two stored seeds that have failed
                                       # before
                                       ("a test", 4, 2)):
            write("done", "")
            write("failing", failing)
            if failing == "a test":
                write("bad", "")
            self.good("nightly NIGHTLY=2", status)
            self.assertEqual(Path("done").read_text().split(), DONE.split(), failing)
            self.assertEqual(len(re.findall("^[0-9]* tests, SEED=", self.said, re.M)), seeds)

    def test_make(self):
        """Tests set-up, downloads, and which targets a test needs."""
        work = self.work / "made"
        # The name of the user's folder may contain an apostrophe.
        cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "icesoc"
        (work / "it's").mkdir(parents=True)
        (work / "it's/icesoc").symlink_to(cache)
        self.ask(*FETCH, "ghdl", work / "ghdl",
                 env={**os.environ, "XDG_CACHE_HOME": f"{work}/it's"})
        self.ask(work / "ghdl/ghdl", "--version")
        # Without a network, or if a checksum is wrong, the build continues without the libraries
        # for the pages, prints a message, and keeps no partial file.
        archive = "tabulator-tables-6.5.3.tgz"
        write(work / "npm/tabulator-tables/-" / archive, "wrong\n")
        page, empty = work / "page", work / "empty"
        for mirror in "http://127.0.0.1:9", (work / "npm").as_uri():
            self.ask(*FETCH, "page", page,
                     env={**os.environ, "XDG_CACHE_HOME": str(empty), "ICESOC_NPM": mirror})
            self.has("cannot get Tabulator and uPlot")
            self.assertEqual((page / "libraries.js").read_text(), "")
            self.assertFalse((page / "done").exists())
            self.assertEqual(list(empty.glob("icesoc/foreign/*")), [])
        self.has(f"{archive} has another SHA-256")
        # The tests of one block build only the programs that they need.
        self.ask(BUILD / "tests/regress/regress", "--build", BUILD, "--prepare", "--list",
                 "--block", "fir")
        self.has("^(ip/fir/)?test_ip_fir$")
        self.assertLess(self.said.count("\n"), 20)
        # Programs that `make test` runs with sanitizers. A program that lacks the label would not
        # run with them.
        for program in "test_os_cases", "test_link", "test_ground_engine", "test_icec":
            self.said = shown_tests(BUILD, "-N", "-L", "sanitized", "-R", f"^{program}[._]")[1]
            self.has(f"#[0-9]+: {program}[._]")


main(Cases)
