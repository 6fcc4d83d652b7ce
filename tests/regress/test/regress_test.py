#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""regress_test: the regression tool on a small project: results, reasons, choice of tests, waves.

Usage: regress_test.py case work-folder build-folder
"""
import fcntl
import json
import re
import subprocess
from pathlib import Path

from project import BREAK, REGRESS, TREE, Project, append, commit, edit, git, main, write

# A test that misbehaves: what it does, and what is said of it.
RUDE = {
    "Hang": ("exec sleep 1000", "^1 x  Timeout"),
    "Loud": ("yes 'a line' | head -c 1000000; echo; echo 'x is 3'; exit 1", "^1 x  x is 3$"),
    "Long": (r"head -c 300000 /dev/zero | tr '\0' x; exit 1", r"^1 x  \.\.\.x{150,200}$"),
    "Crash": ("echo begun; kill -SEGV $$", "^1 x  SegFault: begun$"),
    "Mute": ("exit 3", "^1 x  failed without a word$"),
    "Red": (r"printf '\033[31mx.c:1: error: red\033[0m\n'; exit 1", "^1 x  x.c:1: error: red$"),
    "Leaves": ("setsid sleep 1000 >/dev/null 2>&1 &",
               r"^A test has left behind, and it was ended: .*sleep 1000 "
               r"\(in build/main/tests/room\)$"),
    "Writes": ("echo >../../../../written", "^Changed while the tests ran, .*: written$")}
# Messages about a wrong line: of Verilator, GHDL, GCC, slice2c, a sanitizer.
TOOLS = ("%Error: bus/counter.v:5:9: wrong", "lamp.vhd:4:5:@0ms:(assertion failure): dark",
         "twice.c:3:5: warning: ISO C90", "Lamp.ice:1:36: error: no Colour",
         "SUMMARY: AddressSanitizer: leak")
IDEMPOTENT = "! error: unexpected operation mode. expected Normal, received Idempotent"
BLAME = r"""
foreach(i 1 2 3)
  set(failed "[  FAILED  ] g.Case${i} (${i}7 ms)")
  add_test(NAME test_g.Case${i} COMMAND sh -c
    "printf 'x.cpp:1: Failure\nExpected 1, got 2\n${failed}\n'; exit 1")
endforeach()
add_test(NAME ice.x COMMAND sh -c "printf 'ran\n%s\n}\n'; exit 1")
add_test(NAME python.x COMMAND python3 -c "print('begun'); {}['key']")
add_test(NAME mission.x COMMAND sh -c
  "echo 'Ice.Exception: not served, as expected'; echo 'the picture differs'; exit 1")
set(s ${CMAKE_SOURCE_DIR}/hdl/a)
set(at ${s}/broken_proof.vh:1)
set(t ${CMAKE_BINARY_DIR}/t.vcd)
foreach(m around broken) # as Yosys writes it: all cells around, and the end of the line before
  set(cell "($flatten/u_x./u_y.$assert$${at}$12)")
  add_test(NAME formal.${m} COMMAND sh -c
    "echo 'Assert failed in ${m}: ${s}/around.v:7.1-8.9|${at}.6-3.20 ${cell}'; touch '${t}'
     echo '${m}: trace: ${t}'; echo '${m}: an assertion fails'; exit 1")
endforeach()
"""
NEEDS = """
add_custom_command(OUTPUT ${CMAKE_BINARY_DIR}/tool COMMAND touch ${CMAKE_BINARY_DIR}/tool)
add_custom_command(OUTPUT ${CMAKE_BINARY_DIR}/other COMMAND touch ${CMAKE_BINARY_DIR}/other)
add_custom_target(tools ALL DEPENDS ${CMAKE_BINARY_DIR}/tool ${CMAKE_BINARY_DIR}/other)
add_test(NAME script.tool COMMAND ${t} ${CMAKE_BINARY_DIR}/tool ${CMAKE_CURRENT_BINARY_DIR}/work)
add_test(NAME script.whole COMMAND ${t} ${CMAKE_BINARY_DIR})
add_test(NAME script.says COMMAND ${t} ${CMAKE_BINARY_DIR})
set_tests_properties(script.says PROPERTIES ENVIRONMENT "NEEDS=other tools")
add_test(NAME script.after COMMAND ${t})
set_tests_properties(script.tool PROPERTIES FIXTURES_SETUP f)
set_tests_properties(script.after PROPERTIES FIXTURES_REQUIRED f)
foreach(n soon radio)
  add_test(NAME test_${n}_NOT_BUILT COMMAND false)
  set(labels ${CMAKE_CURRENT_BINARY_DIR}/test_${n}_labels.cmake)
  file(WRITE ${labels} "PROPERTIES LABELS \\"${n};x\\"")
endforeach()
"""
LATE = "add_test(NAME test_late_NOT_BUILT COMMAND false)\n"
# A flight that failed, and the simulator that flies it again and writes this waveform.
ENDED = """  0.1 s  UAV -> ground
mission: the vision core's result differs from the C++ reference: 141 corners, not 140
-- 11/23/26 06:27:52.116 XBeeAT: link idle
icesoc-sim: Cortex-M3: 748300 instructions; asleep 99.5 % of the time
icesoc-sim: 2.0 s simulated, 37 packets on the air
The mission failed (exit status 1).
Its end as a waveform: make run REPLAY='fly' FROM=1.500 TO=2.000
Its end, and backwards from there: make gdb REPLAY='fly'
"""
SIMULATOR = """#!/bin/sh
echo "$@" >asked
while [ "$1" != --wave ]; do shift; done
vcd2fst - "$2" <<'END'
$timescale 1ps $end
$scope module TOP $end
$var wire 1 ! irq_o $end
$scope module u_core $end
$var wire 1 & busy $end
$upscope $end
$upscope $end
$enddefinitions $end
#10
0!
0&
#20
1!
1&
END
cat >"$2.program.vcd" <<'END'
$timescale 1 ps $end
$scope module program $end
$var string 1 p.task task $end
$upscope $end
$enddefinitions $end
#3
sidleTask p.task
#20
sradioTask p.task
#33
sidleTask p.task
END
"""


class Cases(Project):
    def needs(self, words, programs):
        self.regress(f"--prepare --list {words}")
        self.assertEqual(" ".join(self.said.split()), programs, words)

    def test_results(self):
        self.regress("--seed 5", 1)
        self.has("4 passed, 2 failed, 0 skipped",
                 "^proofs *green *1 hold, 1 of them as before, from unchanged files$",
                 r"make test NAME='\^test_b\\\.Bad\$\$' SEED=5", "1 x  SegFault without a word")
        self.has("value 5 is not 7", file="build/regress/failures/test_b.Bad-5.log")
        self.has('failures="2"', 'message="value 5 is not 7 &lt;/script&gt; [(]SEED=5[)]"',
                 file="build/regress/junit.xml")
        self.has("test_d.Crash", "[|] x.cpp:12: value 5 is not 7 &lt;/script> [|] test_b.Bad [|] ",
                 file="build/regress/summary.md")
        self.lacks("not 7 </script>", "build/regress/report.html")
        self.page_is_small()

    def page_is_small(self):
        self.assertLess(Path("build/regress/report.html").stat().st_size, 2000000)

    def test_rude(self):
        """Of tests that misbehave the first line says so, and the run goes on."""
        self.tests("".join(f"add_test(NAME test_r.{name} COMMAND sh -c [=[{does}]=])\n"
                           for name, (does, _) in RUDE.items()) +
                   "add_test(NAME test_r.Gone COMMAND /none)\n"
                   "set_tests_properties(test_r.Hang PROPERTIES TIMEOUT 2)\n")
        self.regress("--name test_r --jobs 4", 1)
        self.has("^2 passed, 7 failed, 0 skipped", "^1 x  Unable to find executable: /none$",
                 *(said for _, said in RUDE.values()))
        # A limit of 250 KB on files stands for a full disk.
        self.ask("sh", "-c", "trap '' XFSZ; ulimit -f 500; exec $0 --name test_a", REGRESS,
                 status=2)
        self.has("^2 passed, 0 failed",
                 "^regress: cannot write build/regress/report.html: is the disk full[?]$")
        self.assertFalse(Path("build/regress/report.html.part").exists())
        self.assertEqual(Path("build/regress/history.jsonl").read_text().count("\n"), 2)

    def test_plan(self):
        """Which requirement is proven, failed, has not run with these sources, or has no test."""
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
        self.has("^[|] It stands [|] thing [|] test_b.Bad [|]$", file="build/regress/summary.md")
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
        self.regress("--plan")  # a program that is not built may have any test
        append(plan, '"It has no test" = ""\n')
        self.regress("--plan", 2)
        self.has("plan.toml: It has no test: not")
        append(plan, "It is none\n")
        self.regress("--plan", 2)
        self.has("plan.toml: .*line 6")

    def test_blame(self):
        """One group for one bug, a test's own last word, the failure nearest to the cause first."""
        self.tests(BLAME.replace("%s", IDEMPOTENT) + "".join(
            f"add_test(NAME lint.tool{n} COMMAND sh -c \"echo '${{t}}: begun'; echo '{said}'\n"
            "echo 'make: *** [x] Error 1'; exit 1\")\n" for n, said in enumerate(TOOLS)))
        write("hdl/a/broken_proof.vh", "begin\n    assert (full ||\n        !taken);\nend\n")
        self.regress("--name 'test_g|mission|formal|ice|python|lint'", 1)
        self.has(*(f"^1 x  {re.escape(said)}$" for said in (*TOOLS, IDEMPOTENT, "KeyError: 'key'",
                                                            "the picture differs")),
                 "^3 x  Expected 1, got 2$", "gtkwave build/regress/failures/formal.broken.vcd",
                 "^The longest: .* s ")
        self.assertEqual(re.search("^.* x  .*", self.said, re.M)[0],
                         "2 x  hdl/a/broken_proof.vh:2: assert (full || !taken);")
        self.assertIn("broken", re.search("^    make test.*", self.said, re.M)[0])
        trace = "build/regress/failures/formal.broken.vcd"
        self.assertTrue(Path(trace).is_file())
        self.has('message="! error: unexpected operation mode',
                 f'<property name="wave" value="{trace}"', file="build/regress/junit.xml")

    def test_changed(self):
        """The changed files of a failed test since it passed: committed or not, new or gone; for a
        program its sources."""
        files = {"hdl/fifo/fifo.v": "a\nb\nc\nd\n", "hdl/old.v": "1\n", "docs/page.md": "1\n",
                 "hdl/fifo/test.c": '#include "n.h"\nint main(void) { return LIMIT; }\n',
                 "hdl/fifo/n.h": "#define LIMIT 0\n"}
        for name, text in files.items():
            write(name, text)
        edit("CMakeLists.txt", "small NONE", "small C")
        self.tests("add_executable(test_u ${CMAKE_SOURCE_DIR}/hdl/fifo/test.c)\n"
                   "add_test(NAME test_u.Unit COMMAND test_u)\n")
        self.ask("ninja", "-C", "build/main", "test_u")
        self.regress("--name 'a.One|u.Unit'")
        write("docs/page.md", "0\n")  # no commit has the tree that was noted
        commit("two")
        edit("tests/room/t.sh", *BREAK)
        self.regress("--name b.Bad", 1)  # never passed: files that are not committed
        self.has("^        changed since the commit; it is not known to have passed: "
                 r"tests/room/t.sh:3 \(1 line\)$")
        write("hdl/fifo/fifo.v", "a\nB\nc\nD\nE\n")
        write("docs/page.md", "2\n")
        Path("hdl/old.v").unlink()
        commit("three")
        self.regress("--changed --prepare --list --name u.Unit")
        self.has("^Nothing to run")
        write("hdl/new.v", "int g;\n")  # is none of its inputs, a header is
        write("hdl/fifo/n.h", "#define LIMIT 3\n")
        self.regress("--changed --prepare --list --name u.Unit")
        self.has("^tests/room/test_u$")
        self.ask("ninja", "-C", "build/main", "test_u")
        self.regress("--name 'a.One|u.Unit' --seed 2", 1)
        passed = git("rev-parse --short=10 HEAD~2")  # and files that were not committed then
        since, one = f"^        changed since it passed at {passed}", r"1 \(1 line\)"
        own = rf"hdl/fifo/n.h:{one}, "
        script = r"tests/room/t.sh:3 \(1 line\)$"
        self.has(f"{since} with SEED=1: {own}hdl/new.v:{one}, hdl/fifo/fifo.v:2 "
                 rf"\(3 lines\), hdl/old.v:{one}, {script}")  # mine first
        self.has(f"{since} with SEED=1: {own}{script}")  # its program, its folder
        self.has('<property name="changed" value="changed since it passed',
                 file="build/regress/junit.xml")
        self.has('"changed":"changed since it passed', file="build/regress/report.html")
        self.ask("git", "cat-file", "-e", git("hash-object hdl/new.v"), status=1)  # no object
        write(".git/info/exclude", "flicker\n")
        self.regress("--name c.Flicker")
        write("flicker", "")
        self.regress("--name c.Flicker", 1)
        self.has("^        nothing has changed since it passed at [0-9a-f]*$")
        self.ask("rm", "-r", "build/regress/tree")  # without noted trees the commit is left
        self.regress("--name a.One", 1)
        self.has(rf"{since}: {own}hdl/new.v:{one}, hdl/fifo/fifo.v:1 \(5 lines\), "
                 ".* tests/room/t.sh")

    def test_company(self):
        """Progress, one run at a time, messages about mistyped words, no needless builds."""
        self.regress("--name 'a.One|formal'")
        self.has("^1 of 2, 0 failed, 1 left",  # nobody knows how long they take
                 "^2 of 2, 0 failed, 0:00 left", "^tests  *green  1 passed, 4 did not run$",
                 "^proofs  *green  1 hold, 1 of them")
        self.regress("--seed abc", 2)
        self.has("'abc' is neither a number nor .random")
        self.regress("--jobs none", 2)
        self.has("^regress: .*see --help")
        self.tests("add_test(NAME test_a.OneMore COMMAND true)\n")
        self.regress("--name test_a.One")
        self.has("^1 passed")  # an exact name is one test
        self.tests(NEEDS)
        for words, programs in (
            ("--name '^script.whole'", "all"), ("--name '^script.says'", "other tools"),
            ("--name '^test_a'", ""), ("--name 'soon\\.'", "test_soon"),
            ("--name 'script\\.after'", "tool"),  # by what goes before it
            ("--name One", "test_radio test_soon"),  # any may have such a case
            ("--label 'rtl|radio'", "test_radio")):
            self.needs(words, programs)
        self.regress("--prepare --name script.tool")
        self.has("^Building tool ")
        self.assertTrue(Path("build/main/tool").exists())
        self.assertFalse(Path("build/main/other").exists())
        # With --changed: tests that have never passed here and do not depend on an edit are not
        # built.
        commit("more")
        self.needs("--changed --name '^script|soon|radio'",
                   "Nothing to run: no test changed since the last run.")
        append("tests/room/t.sh", "# edit\n")
        self.needs("--changed --name '^script.says'", "other tools")
        git("checkout -q tests/room/t.sh")
        self.regress("--prepare --name '^test_a.Nobody'", 2)
        self.has(r"no test is chosen by NAME='\^test_a.Nobody'; .ctest --test-dir")
        git("checkout -q HEAD~1 tests/room/CMakeLists.txt")
        self.tests(LATE)
        self.regress("--label formal", 1)
        self.has("1 passed, 1 failed")  # programs that are not built may have that label
        # Another run has the lock until this one has said that it waits.
        with open("build/regress/lock", "w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            run = subprocess.Popen([REGRESS, "--name", "a.One"], stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, text=True)
            waiting = "waiting for another run in build/regress"
            self.assertTrue(any(waiting in line for line in run.stdout))
        run.communicate()
        self.assertEqual(run.returncode, 0)

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
        self.has(r"^regress: .*'\*' is no regular expression")
        self.regress("--build nowhere", 2)

    def test_again(self):
        self.regress("", 1)
        self.regress("--rerun-failed", 1)
        self.has("2 tests, SEED=1")
        self.regress("--changed", 1)
        self.has("2 tests, SEED=1")  # the tests that passed have not changed
        append("tests/room/t.sh", "# changed\n")
        self.regress("--changed", 1)
        self.has("6 tests, SEED=1")
        self.regress("--name a.One --repeat 3 --seed 7")
        self.has("SEED=9", "3 passed, 0 failed")
        # A removed bug: the failed tests run, and the sources of the last pass count as that pass.
        write("tests/plan.toml", '[thing]\n"It works" = "test_a.One"\n')
        edit("tests/room/t.sh", *BREAK)
        self.regress("--changed --name a.One", 1)
        self.has("^plan  *red")
        self.has("test_a.One SEED=1$", file="build/regress/summary.md")
        edit("tests/room/t.sh", *reversed(BREAK))
        self.regress("--name a.Two")
        self.has("^plan  *green")
        self.regress("--changed --name a.One")
        self.has("^1 tests, SEED=1$", "^plan  *green")
        self.lacks("test_a.One SEED=1$", "build/regress/summary.md")

    def test_flaky(self):
        self.regress("", 1)
        self.lacks("Flaky")
        write("flicker", "")
        self.regress("", 1)
        self.has("Flaky: test_c.Flicker")
        self.has("test_c.Flicker", file="build/regress/summary.md")
        append("build/regress/history.jsonl", '{"damaged\n')
        self.regress("--name One")
        self.has("1 damaged lines")

    def test_seeds(self):
        self.regress("--kept")
        self.has("no seed is kept")
        self.regress("--name 'test_[ab]' --seed random --repeat 2", 1)
        seeds = re.findall("^3 tests, SEED=(.*)", self.said, re.M)
        self.assertEqual(len(seeds), 2)
        kept = "build/regress/seeds.jsonl"
        self.has(*(f'"seed":"{seed}","since":.*"test":"test_b.Bad"' for seed in seeds), file=kept)
        self.lacks("test_a", kept)
        self.regress("--name 'test_[ab]' --seed 7")  # passes with another seed: the others stay
        self.has("2 failing seeds are kept")
        page = Path("build/regress/report.html")
        before = page.read_bytes()
        self.regress("--kept --name 'a[.]'")  # none of these: another run's page stays unchanged
        self.has("no seed is kept")
        self.assertEqual(page.read_bytes(), before)
        self.regress("--kept", 1)
        self.has("0 passed, 2 failed", *(f"^1 tests, SEED={seed}" for seed in seeds))
        self.has('"times":2', file=kept)
        self.has(f"test_b.Bad SEED={seeds[-1]}", file="build/regress/summary.md")
        self.has(r'"seeds":\[\{', file=page)
        edit("tests/room/t.sh", "[ \"$SEED\" = 7 ]", "true")  # the bug is mended
        self.regress("--kept")
        self.assertEqual(Path(kept).read_text(), "")

    def test_bisect(self):
        """Of five commits the third breaks test_a.One, the second does not configure; the checkout
        stays as it is."""
        write("change", "")
        commit("something else")
        append("CMakeLists.txt", "broken(\n")
        commit("does not configure")
        git("revert --no-edit HEAD")
        self.regress("--name a.One")  # passes, and is noted
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
            ("test_b.Bad", 2, "GOOD= names one"),
            ("test_a.One --good nonsense", 2, "no commit GOOD=nonsense")):
            self.ask("env", "ICESOC_TREE=.", TREE / "icesoc", "bisect", "--built", *words.split(),
                     status=status)
            self.has(said)
            self.assertEqual(Path("change").read_text(), "mine")
            self.assertFalse(Path("build/bisect/tree").exists())

    def test_waves(self):
        """A test that runs beside a core, not below tests/, and a trace that is damaged: the
        report comes in any case."""
        join = "testbench/common/join_waves.sh"
        write(join, (TREE / join).read_text())
        write("ip/core/wave.sh", '#!/bin/sh\necho "wrong at clock cycle 5"\n'
              '[ -z "${WAVE:-}" ] || vcd2fst "${0%/*}/t.vcd" "$WAVE"\nexit 1\n')
        write("ip/core/CMakeLists.txt", """
add_test(NAME test_w.Wave COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/wave.sh)
set(damaged ${CMAKE_CURRENT_SOURCE_DIR}/damaged.vcd)
add_test(NAME formal.damaged COMMAND sh -c "echo 'damaged: trace: ${damaged}'; exit 1")
add_custom_target(test_w)
""")
        wave = ("$timescale 1ns $end $var wire 1 ! clk_i $end $enddefinitions $end "
                "#0 0! #5 1! #10 0!\n")
        write("ip/core/t.vcd", wave)
        write("ip/core/damaged.vcd", wave.replace("#5", "#five"))
        write("build/trace/ip/core/verilated_core/Vcore.h", "VL_IN8(&clk_i,0,0);\n")
        append("CMakeLists.txt", "add_subdirectory(ip/core)\n")
        self.tests("")
        self.regress("--name 'test_w|damaged'", 1)
        self.has("^0 passed, 2 failed", "formal.damaged.vcd is damaged, and not drawn")
        self.has("^TOP.clk_i$", file="build/regress/failures/test_w.Wave-1.gtkw")
        self.has("test_w.Wave-1.fst", file="build/regress/report.html")

    def test_flight(self):
        """A flight that fails is flown again around the last event of a core."""
        join = "testbench/common/join_waves.sh"
        write(join, (TREE / join).read_text())
        write("build/trace/gen/soc_cores.vh",
              "camera u_camera (\n  .clk_i(clk_i), `SLOT(2), .irq_o(i));\n"
              "core u_core (\n    .clk_i(clk_i), `SLOT(3), .irq_o(j));\n")
        write("build/trace/build.ninja", "rule r\n command = true\nbuild icesoc-sim: r\n")
        write("build/trace/testbench/sim/icesoc-sim", SIMULATOR)
        write("fly/events.jsonl", '{"ns":1000000000,"slot":1,"events":1}\n'
              '{"ns":1500000000,"slot":3,"events":1}\n{"ns":1900000000,"slot":1,"events":1}\n'
              '{"ns":2')
        write("ended", ENDED)
        self.tests("set(ended ${CMAKE_SOURCE_DIR}/ended)\n"
                   'add_test(NAME mission.x COMMAND sh -c "cat ${ended}; exit 1")\n'
                   "set_tests_properties(mission.x PROPERTIES LABELS e2e)\n")
        self.regress("--name mission --waves 3", 1)
        self.has("^1 x  mission: the vision core's result differs from the C[+][+] reference: 141 ")
        left = "build/regress/failures/mission.x-1"
        self.has(f"^--replay fly --out {left}.replay --wave .*mission.x-1.fst --from 1.498500 "
                 "--to 1.500500$", file="asked")
        self.ask("fst2vcd", f"{left}.fst")
        self.assertRegex(self.said.replace("\n", " "),
                         "#3 .*sidleTask .*#10 .*0. .*#20 .*1. .*sradioTask .*#33 sidleTask")
        self.has("^program.task$", file=f"{left}.gtkw")
        self.has(r'"program.task",0,\[3,"idleTask",20,"radioTask",33,"idleTask"\]\],'
                 r'\["TOP.u_core.busy"', file="build/regress/report.html")  # the core before ports

    def test_large(self):
        """More tests than this project has: the page stays small."""
        write("long.vcd", "$scope module top $end\n" +
              "".join(f"$var wire 16 s{s} a_signal_{s} $end\n" for s in range(100)) +
              "$upscope $end $enddefinitions $end\n" + "".join(
                  f"#{1000000 + t}\n" + "".join(f"b1{t % 2}10101010101010 s{s}\n"
                                                for s in range(100)) for t in range(300)))
        some = {"percent": 97, "lines": 200, "gate": 95, "toggles": 96, "toggle_points": 900,
                "toggle_gate": 95, "why": "",
                "missed": [f"{m}: some_signal_of_it[{m}]" for m in range(500)]}
        write("build/coverage/summary.json", json.dumps(
            {"total": 97.1, "toggles": 95.2,
             "files": [{"file": f"hdl/block/some_module_{f}.v", **some} for f in range(600)]}))
        write("build/mutants/results.tsv", "".join(
            f"block/some_seeded_bug_{i}\tcaught\ttest_block.Case\t7\n" for i in range(400)))
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
