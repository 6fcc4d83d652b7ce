#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""regress_test: tests the regression tool with a small project: results, selection of tests,
history.

Usage: regress_test.py case work-folder build-folder
"""
import contextlib
import datetime
import fcntl
import io
import itertools
import json
import os
import re
import signal
import subprocess
import time
import types
import unittest.mock
import xml.etree.ElementTree as xml
from pathlib import Path

from project import (BREAK, LONGEST, REGRESS, TREE, Project, append, commit, edit, git, main,
                     write)
from icesoc.mutants import results
from icesoc.regress import execution, junit, unchanged
from icesoc.regress.ctest import write_finished
from icesoc.regress.tests import Test

NEEDS = """
add_custom_command(OUTPUT ${CMAKE_BINARY_DIR}/tool COMMAND touch ${CMAKE_BINARY_DIR}/tool)
add_custom_command(OUTPUT ${CMAKE_BINARY_DIR}/other COMMAND touch ${CMAKE_BINARY_DIR}/other)
add_custom_target(tools ALL DEPENDS ${CMAKE_BINARY_DIR}/tool ${CMAKE_BINARY_DIR}/other)
add_test(NAME script.tool COMMAND ${t} ${CMAKE_BINARY_DIR}/tool ${CMAKE_CURRENT_BINARY_DIR}/work)
add_test(NAME script.whole COMMAND ${t} ${CMAKE_BINARY_DIR})
add_test(NAME script.says COMMAND ${t} ${CMAKE_BINARY_DIR})
set_tests_properties(script.says PROPERTIES ENVIRONMENT "NEEDS=other tools")
add_test(NAME script.after COMMAND ${t})
add_test(NAME absent.program COMMAND ${CMAKE_BINARY_DIR}/absent)
set_tests_properties(script.tool PROPERTIES FIXTURES_SETUP f)
set_tests_properties(script.after PROPERTIES FIXTURES_REQUIRED f)
add_custom_target(test_tame DEPENDS ${CMAKE_SOURCE_DIR}/tame.cpp)
add_executable(test_built ${CMAKE_SOURCE_DIR}/built.cpp)
add_test(NAME test_built.Fir.Works COMMAND test_built)
add_test(NAME test_built.Order.ComesFirst COMMAND test_built)
foreach(n soon radio tame)
  add_test(NAME test_${n}_NOT_BUILT COMMAND false)
  set_tests_properties(test_${n}_NOT_BUILT PROPERTIES LABELS "${n};x")
endforeach()
"""
HANG = """#include <pthread.h>
#include <unistd.h>
static void* rest(void* p) { pause(); return p; }
static void spin(volatile int hangs) { while (hangs) {} }
int main(void) {
    pthread_t other;
    pthread_create(&other, 0, rest, 0);
    spin(access("../../../../flicker", F_OK) == 0);
    return 0;
}
"""
LATE = "add_test(NAME test_late_NOT_BUILT COMMAND false)\n"


class Cases(Project):
    def needs(self, words, programs):
        self.regress(f"--prepare --list {words}")
        self.assertEqual(" ".join(self.said.split()), programs, words)

    def test_results(self):
        self.regress("--seed 5", 1)
        self.has("4 passed, 2 failed, 0 skipped",
                 "^proofs *green *1 hold, 1 of them as before, from unchanged files$",
                 r"\./icesoc test --name '\^test_b\\\.Bad\$' --seed 5",
                 "1 x  SegFault without a word")
        self.has("value 5 is not 7", file="build/regress/failures/test_b.Bad-5.log")
        self.has('failures="1" errors="1"', '<error message="SegFault without a word [(]SEED=5[)]"',
                 '<failure message="value 5 is not 7 &lt;/script&gt; [(]SEED=5[)]"',
                 file="build/regress/junit.xml")
        self.junit_is_valid()
        self.lacks("not 7 </script>", "build/regress/report.html")
        self.page_is_small()

    def junit_is_valid(self):
        """Checks JUnit files against Jenkins' junit-10.xsd: elements, attributes (required ones
        first), children. GitLab reads names, times, failures and outputs from these files."""
        schema = {
            "testsuites": ("", "name time tests failures errors", "testsuite"),
            "testsuite": ("name tests failures errors", "time skipped timestamp",
                          "properties testcase"),
            "properties": ("", "", "property"), "property": ("name value", "", ""),
            "testcase": ("name", "time classname", "skipped error failure system-out"),
            "skipped": ("", "", ""), "failure": ("", "message", ""), "error": ("", "message", ""),
            "system-out": ("", "", "")}
        root = xml.parse("build/regress/junit.xml").getroot()
        self.assertEqual(root.tag, "testsuites")
        for element in root.iter():
            needed, others, children = (words.split() for words in schema[element.tag])
            self.assertLessEqual(set(needed), set(element.attrib), element.tag)
            self.assertLessEqual(set(element.attrib), {*needed, *others}, element.tag)
            self.assertLessEqual({each.tag for each in element}, set(children), element.tag)
        for suite in root:
            self.assertRegex(suite.get("time"), r"^\d+\.\d{3}$")
            begin = datetime.datetime.fromisoformat(suite.get("timestamp"))
            self.assertLess(datetime.datetime.now().astimezone() - begin,
                            datetime.timedelta(hours=1))
            self.assertEqual({each.get("name"): each.get("value") for each in suite[0]},
                             {"seed": "5", "commit": git("describe --always --dirty --abbrev=10")})
        self.assertEqual({suite.get("name"): suite.get("failures") for suite in root}, {
            "test_a": "0", "test_b": "1", "test_c": "0", "test_d": "0", "formal": "0"})

    def test_ages(self):
        """A test that has taken three times its usual time is reported with its age, and again when
        its age has doubled. Without a history, it is first reported after 60 s."""
        usual = {"quick": 0.1, "slow": 20.0, "new": None, "formal.long": 40.0}
        tests = [types.SimpleNamespace(name=name) for name in usual]
        progress = execution.Progress(tests, types.SimpleNamespace(seconds=usual.get,
                                                                     usual=usual.get), 2)
        begun = 1000.0
        for name in usual:
            progress.start(name)
        for age, said, hang in ((9, [], ""), (11, ["quick has run for 11 s, usually 0.1 s"], ""),
                                (21, [], ""), (29, None, ""), (31, None, "quick"),
                                (61, ["quick has run for 61 s, usually 0.1 s",
                                      "slow has run for 61 s, usually 20.0 s",
                                      "new has run for 61 s, usually unknown"], "quick"),
                                (119, [], "quick"), (201, None, "quick slow"),
                                (601, None, "quick slow new")):
            with contextlib.redirect_stdout(io.StringIO()) as out, \
                    unittest.mock.patch("time.monotonic", lambda: begun + age):
                progress.running = dict.fromkeys(usual, begun)
                self.assertEqual([name for name, _ in progress.late(lambda _: age)],
                                 hang.split(), age)
            if said is not None:
                self.assertEqual(out.getvalue().splitlines(), said, age)
        self.idle_and_starved(progress, usual)
        # names of cases with parameters contain spaces
        for name in ("test_a.One", "test_p.Of/Case.Works/1  # GetParam() = (true, 2)",
                     "test_t.Case.Works<(anonymous namespace)::Kind<V, 2u>>"):
            self.assertEqual(junit.begun(f"      Start  978: {name}\n"), name)
            self.assertEqual(junit.ended(f" 9/12 Test #978: {name} ......   Passed    0.01 sec\n"),
                             (name, "Passed", 0.01, 12))

    def idle_and_starved(self, progress, usual):
        """A test that uses no CPU time for ten seconds is considered to hang. A test that gets a
        small part of a CPU is considered to hang only when its CPU time is ten times its usual
        time."""
        for share, hangs in ((0.001, {"quick": 42, "slow": 212}), (0.15, {"quick": 201})):
            progress.busy, first = {}, {}
            for age in range(1, 300):
                with contextlib.redirect_stdout(io.StringIO()), \
                        unittest.mock.patch("time.monotonic", lambda: 2000.0 + age):
                    progress.running = {name: 2000.0 for name in ("quick", "slow")}
                    for name, _ in progress.late(lambda _: share * age):
                        first.setdefault(name, age)
            self.assertEqual(list(first), list(hangs))
            for name, age in hangs.items():
                self.assertAlmostEqual(first[name], age, delta=3)

    def test_hang(self):
        """A test that has taken ten times its usual time is ended. Its stack is printed, and it
        counts as failed. Here the minimum of 30 s is disabled."""
        write("hang.c", HANG)
        edit("CMakeLists.txt", "small NONE", "small C")
        self.tests("""add_executable(test_h ${CMAKE_SOURCE_DIR}/hang.c)
add_test(NAME script.Wraps COMMAND sh -c
  "p=$<TARGET_FILE:test_h>; $p & one=$!; $p & wait $one; kill -9 $! 2>/dev/null; exit 0")
""")
        self.ask("ninja", "-C", "build/main", "test_h")
        self.regress("--name 'Wraps|a.One'")
        write("flicker", "")
        self.ask(TREE / "tools/python", "-c", """import sys
from icesoc.regress import execution, regress
execution.SHORTEST_HANG = 2
sys.exit(regress.main(["--name", "Wraps|a.One"]))""", status=1)
        self.has("^1 passed, 1 failed",
                 "^1 x  Hang, ended after [2-9] s of CPU time, usually 0.. s, in spin, called by "
                 "main: Aborted")
        # the thread that waits comes last
        self.has("^Stack of test_h:$", "^Thread 1 .*\n#0 .*spin [(](.*\n)*Thread 2 .*\n#0 .*pause",
                 file="build/regress/failures/script.Wraps-1.log")
        self.has('<error message="Hang, ended after', file="build/regress/junit.xml")
        # `make test` and `core test` end it as well
        self.ask(TREE / "tools/python", "-c", """import sys
from icesoc.regress import ctest, execution
execution.SHORTEST_HANG = 2
sys.argv[1:] = ["--test-dir", "build/main", "--end-hangs", "-R", "Wraps|a.One"]
sys.exit(ctest.main())""", status=8)
        self.has("a.One .* Passed", "^        #0 .*spin [(]",
                 "^    script.Wraps: Hang, ended after [2-9] s of CPU time, usually 0.. s, in "
                 "spin, called by main$")

    def test_stack(self):
        """The stack of a hang begins with the thread that uses the CPU, and names of functions have
        no types."""
        text = "\n".join(["[New LWP 8]", 'Thread 2 (Thread 0x7f (LWP 8) "t"):',
                          "#0  wait (private=0) at ./futex.h:57",
                          'Thread 1 (Thread 0x7e (LWP 7) "t"):',
                          "#0  0x55 in (anonymous namespace)::Fir_Hangs_Test::TestBody() ()",
                          "#1  0x56 in void testing::Run<testing::Test, void>(int (*)()) ()",
                          "#2  0x57 in bool Core<F<int> >::call<bool>(int) ()"])
        for busy, first in (("7", "1"), ("8", "2"), ("", "1")):
            threads = execution.stacks_of(text, lambda thread: int(thread == busy))
            self.assertEqual([thread[0].split()[1] for thread in threads],
                             [first, "1" if first == "2" else "2"])
        self.assertEqual([*map(execution.function_of, execution.stacks_of(
            text, lambda thread: 0)[0][1:])],
            ["Fir_Hangs_Test::TestBody", "testing::Run", "Core::call"])

    def test_stopped(self):
        """After Ctrl-C, or the end of the terminal, the page, JUnit and the history contain the
        tests that had finished, and no process is left. One test lists the tests of its build
        folder, which must not overwrite the log of the run."""
        lists = ("import pathlib; from icesoc.regress.tests import list_tests; "
                 "list_tests(pathlib.Path('${CMAKE_BINARY_DIR}'))")
        self.tests('add_test(NAME script.Waits COMMAND sh -c "sleep 1234 & wait")\n'
                   f'add_test(NAME script.Lists COMMAND {TREE}/tools/python -c "{lists}")\n'
                   "set_tests_properties(script.Lists PROPERTIES DEPENDS test_b.Bad)\n")
        self.regress("--name 'a.One|formal'")
        for number, status in ((signal.SIGINT, 130), (signal.SIGHUP, 129)):
            run = subprocess.Popen([REGRESS, "--seed", "5"], stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, text=True, start_new_session=True)
            said = list(itertools.takewhile(lambda line: not line.startswith("7 of 8"), run.stdout))
            os.killpg(run.pid, number)
            self.said = "".join(said) + run.communicate(timeout=LONGEST)[0]
            self.assertEqual(run.returncode, status, self.said)
            left = ["pgrep", "--session", str(run.pid), "--runstates", "D,I,R,S,T,t"]
            self.assertEqual(subprocess.run(left, stdout=subprocess.PIPE).stdout, b"")
            self.has("^stopped after 7 of 8: 5 passed, 2 failed, 0 skipped in",
                     "^1 x  value 5 is not 7 </script>$", "^tests  *red ",
                     "^proofs *grey *stopped after 7 of 8: 1 passed$")
            self.has("value 5 is not 7", file="build/regress/failures/test_b.Bad-5.log")
            self.has('"stopped":"after 7 of 8"', file="build/regress/report.html")
            self.has('tests="1" failures="1" ', 'name="stopped" value="after 7 of 8"',
                     file="build/regress/junit.xml")
        self.regress("--rerun-failed", 1)
        self.has("^2 tests, SEED=1")
        # CTest has not printed the number of tests when no test has ended
        with contextlib.redirect_stdout(io.StringIO()) as printed:
            write_finished(self.work, self.work / "junit.xml", {}, 0)
        self.assertEqual(printed.getvalue(),
                         "\nstopped before a test had ended: 0 passed, 0 failed\n")

    def test_slow_terminal(self):
        """TERM while the terminal is slow: results that CTest has printed and the tool has not read
        yet are not lost."""
        write("slow/CTestTestfile.cmake", "".join(
            f"add_test({number:03}{'x' * 2000} true)\n" for number in range(200)))
        kept_file = self.work / "slow/junit.xml"
        run = subprocess.Popen(
            [TREE / "tools/python", "-m", "icesoc.regress.ctest", "--test-dir", "slow",
             "--output-junit", kept_file], stdout=subprocess.PIPE, text=True)
        run.stdout.readline()
        log, size = Path("slow/Testing/Temporary/LastTest.log.tmp"), -1
        while not log.exists() or log.stat().st_size != size:  # until all pipes are full
            size = log.stat().st_size if log.exists() else -1
            time.sleep(1)
        run.send_signal(signal.SIGTERM)
        self.said = run.communicate(timeout=LONGEST)[0]
        self.assertEqual(run.returncode, 143)
        logged = log.read_text().count("Test Passed.")
        kept = kept_file.read_text().count("<testcase ")
        self.assertGreater(logged, 20)
        self.assertLessEqual(logged - kept, 1)  # CTest was killed while it printed one line
        self.has(f"^stopped after {kept} of 200: {kept} passed, 0 failed$")

    def test_unchanged(self):
        """Some changed inputs make a test run again: files with paths in its program, all
        files of the tree for a script, and the build's packages with their dependencies, but no
        other package."""
        source, build = self.work, self.work / "build/main"
        write("data/one.txt", "1")
        write("build/main/digests.json", "damaged")
        status = Path("build/status")

        def package(name, version, needs=""):
            append(status, f"Package: {name}\nStatus: install ok installed\nVersion: {version}\n"
                   + (f"Depends: libx (>= 1), {needs}\n" if needs else "") + "\n")
        write("cmake/setup.sh", "packages='\nyosys synthesis\n'\n")
        write(build / "program", f"#!/bin/sh\ncat {source}/data {build}/out/result\n")
        write("build/main/out/result", "r")
        # CMake names dpkg's list of packages in build.ninja
        outside = self.work.with_name("unchanged_status")
        outside.write_text("1")
        write(build / "build.ninja", f"build {outside}: phony\n")
        tests = {"program": Test(1, "test_a.One", [f"{build}/test_a"]),
                 "script": Test(2, "lint.a", [str(source / "tests/room/t.sh")])}
        os.rename(build / "program", build / "test_a")

        def state():
            inputs = unchanged.Inputs(source, build, "1")
            inputs.packages = unchanged.packages(source, status)
            found = {name: inputs.of(test) for name, test in tests.items()}
            inputs.save()
            return found
        package("yosys", "1", "tcl")
        package("tcl", "8")
        before = state()
        for what, act, changed in (
                ("nothing", lambda: None, ""),
                ("an unrelated package", lambda: package("game", "1"), ""),
                ("the list of packages", lambda: append(outside, "2"), ""),
                ("what tests write", lambda: write("build/main/out/result", "s"), ""),
                ("a file that it does not name", lambda: write("other.txt", "1"), "script"),
                ("a file that it names", lambda: write("data/one.txt", "2"), "program script"),
                ("a file more in a folder", lambda: write("data/two.txt", "2"), "program script"),
                ("the program", lambda: append(build / "test_a", "#"), "program"),
                ("a package that yosys needs", lambda: edit(status, "Version: 8", "Version: 9"),
                 "program script")):
            act()
            now = state()
            self.assertEqual([name for name in tests if now[name] != before[name]],
                             changed.split(), what)
            before = now

    def page_is_small(self):
        self.assertLess(Path("build/regress/report.html").stat().st_size, 2000000)

    def test_plan(self):
        """For each requirement the report shows whether it is proven, has failed, did not run with
        these sources, or has no test."""
        plan = Path("tests/plan.toml")
        lines = ('[thing]\n"It works" = "test_a.* formal.thing"\n'
                 '"It stands" = "test_a.One test_b.*"\n')
        plan.write_text(lines + '"It flies" = "test_c.Nobody*"\n')
        self.regress("--plan", 1)
        self.has("^no test is called test_c.Nobody[*], which is to prove: It flies$")
        plan.write_text(lines)
        self.regress("--plan")
        self.has("^2 requirements$")
        self.regress("--name a.One")
        self.has("^plan  *grey   *0 of 2 requirements")
        self.regress("--name 'a[.]|formal'")
        self.has("^plan  *grey   *1 of 2 requirements")
        self.regress("--name b.Bad", 1)
        self.has("^plan  *red  *1 of 2 requirements of docs/ are not proven: It stands$")
        self.has(r'"open":\["test_b.Bad"\],"page":"thing",'
                 r'"patterns":\["test_a.One","test_b.\*"\],"state":"failed"',
                 file="build/regress/report.html")
        self.regress("--name b.Bad --seed 7")
        self.has("^plan  *green  *2 requirements")
        append("tests/room/t.sh", "# changed\n")
        self.regress("--name a.One")
        self.has("^plan  *grey   *0 of 2 requirements")
        self.tests(LATE)
        append(plan, '"It comes" = "test_late.One"\n')
        # this is accepted, because a program that is not built may contain any test
        self.regress("--plan")
        append(plan, '"It has no test" = ""\n')
        self.regress("--plan", 2)
        self.has("plan.toml: It has no test: expected")
        append(plan, "It is none\n")
        self.regress("--plan", 2)
        self.has("plan.toml: .*line 6")

    def test_company(self):
        """Tests the display of progress, the rule that there is only one run at a time, messages
        about mistyped words, and that nothing is built needlessly."""
        self.regress("--name 'a.One|formal'")
        # the number of tests is shown, because their duration is unknown
        self.has("^1 of 2, 0 failed, 1 left",
                 "^2 of 2, 0 failed, 0:00 left", "^tests  *green  1 passed, 4 did not run$",
                 "^proofs  *green  1 hold, 1 of them")
        self.regress("--jobs none", 2)
        self.has("^regress: .*see --help")
        self.tests("add_test(NAME test_a.OneMore COMMAND true)\n")
        self.regress("--name test_a.One")
        self.has("^1 passed")  # an exact name selects only one test
        write("tame.cpp", "// unused\nTEST_F(Tame, Eats) {}\n")
        write("built.cpp", "int main() {}\n")
        edit("CMakeLists.txt", "small NONE", "small CXX")
        self.tests(NEEDS)
        for words, programs in (
            ("--name '^script.whole'", "all"), ("--name '^script.says'", "other tools"),
            ("--name '^test_a'", ""), ("--name '^absent'", "all"),
            ("--name 'soon\\.'", "test_soon"),
            # the text before the case already selects the test
            ("--name 'script\\.after'", "tool"),
            ("--name One", "test_radio test_soon"),  # programs with unknown cases are built
            # no test name begins with these words
            ("--name '^One|^(script|docs).says'", "other tools"),
            ("--name '^test_tame.*Eat'", "test_tame"),
            ("--label 'rtl|radio'", "test_radio"),
            ("--name rue", "test_radio test_soon"),
            ("--name tame", "test_radio test_soon test_tame"),
            ("--name '(tam)'", "test_radio test_soon test_tame")):
            self.needs(words, programs)
        self.a_plain_word_is_a_whole_one()
        self.regress("--prepare --name script.tool")
        self.has("^Building tool ")
        self.assertTrue(Path("build/main/tool").exists())
        self.assertFalse(Path("build/main/other").exists())
        # With --changed, tests are not built if they have never passed here and do not depend on an
        # edit.
        commit("more")
        self.needs("--changed --name '^script|soon|radio'",
                   "Nothing to run: no test changed since the last run.")
        append("tests/room/t.sh", "# edit\n")
        self.needs("--changed --name '^script.says'", "other tools")
        git("checkout -q tests/room/t.sh")
        self.regress("--prepare --name '^test_a.Nobody'", 2)
        self.has(r"no test matches --name '\^test_a.Nobody'; .*/regress --build .* --list. lists",
                 r"^labels: ")
        # the command that prints the names works
        listing = re.search("`(.*)` lists", self.said)[1].partition(" ")[2]
        self.regress(listing)
        self.has("^test_a.One$")
        self.regress("--by-make --name '^test_b.Bad$'", 1)
        self.has(r"make test NAME='\^test_b\\\.Bad\$' SEED=1")
        self.regress("--block romo", 2)
        self.has("no test matches --block 'romo'; did you mean room[?]; ")
        git("checkout -q HEAD~1 tests/room/CMakeLists.txt")
        self.tests(LATE)
        self.regress("--label formal", 1)
        # also runs programs that were not built, because they may have tests with this label
        self.has("1 passed, 1 failed")
        # Another run holds the lock until this run has reported that it is waiting.
        with open("build/regress/lock", "w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            run = subprocess.Popen([REGRESS, "--name", "a.One"], stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, text=True)
            waiting = "waiting for another run in build/regress"
            self.assertTrue(any(waiting in line for line in run.stdout))
        run.communicate()
        self.assertEqual(run.returncode, 0)

    def a_plain_word_is_a_whole_one(self):
        """The word `fir` does not select `first`. A new case in the source of a program is found,
        although the program has already been built."""
        self.ask("ninja", "-C", "build/main", "test_built")
        self.regress("--name Fir --list")
        self.assertIn("test_built.Fir.Works\n", self.said)
        self.assertNotIn("First", self.said)
        self.regress("--name built.Newest --list", 2)
        write("built.cpp", "#define TEST(a, b) int a##b\nTEST(Fir, IsNewest);\nint main() {}\n")
        self.needs("--name Newest", "test_radio test_soon tests/room/test_built")
        self.regress("--prepare --list --name built.Fir.IsNewest", 2)
        self.has("^tests/room/test_built$")
        self.needs("--name Oldest", "test_radio test_soon")

    def test_selection(self):
        for words, chosen in (("block thing", "formal.thing"), ("label formal", "formal.thing"),
                              ("name One", "test_a.One")):
            self.regress(f"--{words} --list")
            self.assertEqual(self.said, f"{chosen}\n", words)
        self.regress("--block room --list")
        self.assertEqual(self.said.count("\n"), 6)
        self.regress("--name nothing", 2)
        self.has("labels: formal rtl")
        self.regress("--name '*'", 2)
        self.has(r"^regress: .*'\*': expected a regular expression")
        self.regress("--build nowhere", 2)

    def test_again(self):
        self.regress("", 1)
        self.regress("--rerun-failed", 1)
        self.has("2 tests, SEED=1")
        self.regress("--changed", 1)
        # the tests that passed do not run, because they have not changed
        self.has("2 tests, SEED=1")
        append("tests/room/t.sh", "# changed\n")
        self.regress("--changed", 1)
        self.has("6 tests, SEED=1")
        self.regress("--name a.One --repeat 3 --seed 7")
        self.has("SEED=9", "3 passed, 0 failed")
        # When a bug has been removed, the tests that failed run again. A pass is valid only for the
        # sources with which the test ran.
        write("tests/plan.toml", '[thing]\n"It works" = "test_a.One"\n')
        edit("tests/room/t.sh", *BREAK)
        self.regress("--changed --name a[.]", 1)
        self.has("^2 tests", "^plan  *red")
        self.regress("--name formal")
        # a failing seed has been recorded
        self.has('"test": "test_a.One"', file="build/regress/report.json")
        edit("tests/room/t.sh", *reversed(BREAK))
        self.regress("--name formal")
        self.has("^plan  *green")
        self.lacks('"test": "test_a.One"', "build/regress/report.json")
        self.regress("--changed --name a[.]")
        self.has("^1 tests, SEED=1$", "^plan  *green")

    def test_flaky(self):
        self.regress("", 1)
        self.lacks("Flaky")
        write("flicker", "")
        self.regress("", 1)
        self.has("Flaky: test_c.Flicker")
        append("build/regress/history.jsonl", '{"damaged\n')
        self.regress("--name One")
        self.has("1 damaged lines")

    def test_seeds(self):
        self.regress("--kept")
        self.has("no failing seed of these tests is known")
        self.regress("--name 'test_[ab]' --seed random --repeat 2", 1)
        seeds = re.findall("^3 tests, SEED=(.*)", self.said, re.M)
        self.assertEqual(len(seeds), 2)
        # these tests pass, but the failing seeds stay recorded
        self.regress("--name 'test_[ab]' --seed 7")
        self.has("2 failing seeds are kept")
        page = Path("build/regress/report.html")
        before = page.read_bytes()
        # the page of the earlier run is unchanged, because no selected test has a recorded seed
        self.regress("--kept --name 'a[.]'")
        self.has("no failing seed of these tests is known")
        self.assertEqual(page.read_bytes(), before)
        self.regress("--kept", 1)
        self.has("0 passed, 2 failed", *(f"^1 tests, SEED={seed}" for seed in seeds))
        self.has(*(rf'"seed":"{seed}","since":\d+,"test":"test_b.Bad","times":2' for seed in seeds),
                 file=page)
        edit("tests/room/t.sh", "[ \"$SEED\" = 7 ]", "true")  # removes the bug
        self.regress("--kept")
        self.regress("--kept")
        self.has("no failing seed of these tests is known")

    def test_bisect(self):
        """Of five commits, the second cannot be configured, and the third breaks test_a.One. The
        search must not change the user's checkout."""
        write("change", "")
        commit("something else")
        append("CMakeLists.txt", "broken(\n")
        commit("does not configure")
        git("revert --no-edit HEAD")
        self.regress("--name a.One")  # this run, in which the test passes, is recorded
        edit("tests/room/t.sh", *BREAK)
        commit("breaks it")
        for later in "12":
            write("change", later)
            commit(f"later {later}")
        write("change", "mine")
        write("build/main/tests/regress/regress", f'#!/bin/sh\nexec {REGRESS} "$@"\n')
        first = git("rev-list --max-parents=0 HEAD")
        for words, status, said in (
            ("test_a.One", 0, "^since [0-9a-f]* breaks it [(]a, "),
            (f"test_a.One --good {first}", 0, "^since [0-9a-f]* breaks it [(]a, "),
            (f"test_a.Two --good {first}", 2, "passes at"),
            ("test_b.Bad", 2, "name one with GOOD="),
            ("test_a.One --good nonsense", 2, "unknown commit GOOD=nonsense")):
            self.ask("env", "ICESOC_TREE=.", TREE / "icesoc", "bisect", "--built", *words.split(),
                     status=status)
            self.has(said)
            self.assertEqual(Path("change").read_text(), "mine")
            self.assertFalse(Path("build/bisect/tree").exists())

    def test_large(self):
        """The page stays small if there are more tests than this project has."""
        write("long.vcd", "$scope module top $end\n" +
              "".join(f"$var wire 16 s{s} a_signal_{s} $end\n" for s in range(100)) +
              "$upscope $end $enddefinitions $end\n" + "".join(
                  f"#{1000000 + t}\n" + "".join(f"b1{t % 2}10101010101010 s{s}\n"
                                                for s in range(100)) for t in range(300)))
        some = {"value": 97, "lines": 200, "limit": 95, "toggles": 96, "toggle_points": 900,
                "toggle_gate": 95, "why": "",
                "missed": [f"{m}: some_signal_of_it[{m}]" for m in range(500)]}
        write("build/coverage/summary.json", json.dumps(
            {"total": 97.1, "toggles": 95.2,
             "entries": [{"name": f"hdl/block/some_module_{f}.v", **some} for f in range(600)]}))
        Path("build/mutants").mkdir()
        results.write("build/mutants/planted.xml", [
            results.Mutant(f"block/some_seeded_bug_{i}", "caught", "test_block.Case", 7)
            for i in range(400)])
        self.tests("""
foreach(i RANGE 1 400)
  add_test(NAME test_with_a_long_name.AndManyCases.Number/${i} COMMAND ${t} a.${i})
endforeach()
foreach(i RANGE 1 30)
  add_test(NAME test_loud.Case${i} COMMAND sh -c "seq 1 20000; exit 1")
endforeach()
foreach(i RANGE 1 8)
  add_test(NAME formal.long${i} COMMAND sh -c
    "echo 'long${i}: trace: ${CMAKE_SOURCE_DIR}/long.vcd'; exit 1")
endforeach()
""")
        self.regress("", 1)
        self.has("404 passed, 40 failed")
        drawn = Path("build/regress/report.html").read_text().count('"signals":[["top.a_signal_')
        self.assertEqual(drawn, 8)
        self.page_is_small()


main(Cases)
