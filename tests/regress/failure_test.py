#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""failure_test: tests the report of the regression tool about a failed test: the reason, the
changes since the test passed, the waveform.

Usage: failure_test.py case work-folder build-folder
"""
import re
from pathlib import Path

from project import BREAK, REGRESS, TREE, Project, append, commit, edit, git, main, write
from icesoc.regress.failures import reason_of

# Tests that misbehave: what the test does, and the message about it.
RUDE = {
    "Hang": ("exec sleep 1000", "^1 x  Timeout"),
    "Loud": ("yes 'a line' | head -c 1000000; echo; echo 'x is 3'; exit 1", "^1 x  x is 3$"),
    "Long": (r"head -c 300000 /dev/zero | tr '\0' x; exit 1", r"^1 x  \.\.\.x{150,200}$"),
    "Crash": ("echo begun; kill -SEGV $$", "^1 x  SegFault: begun$"),
    "Mute": ("exit 3", "^1 x  failed without a word$"),
    "Red": (r"printf '\033[31mx.c:1: error: red\033[0m\n'; exit 1", "^1 x  x.c:1: error: red$"),
    "Leaves": ("setsid sleep 1000 >/dev/null 2>&1 &",
               r"^Ended a process that a test left behind: .*sleep 1000 "
               r"\(in build/main/tests/room\)$"),
    "Writes": ("echo >../../../../written", "^Changed while the tests ran, .*: written$")}
IDEMPOTENT = "! error: unexpected operation mode. expected Normal, received Idempotent"
# reason -> log of a tool in which the reason occurs; {} in the log is replaced by the reason.
REASONS = {
    "busy is true, not false":
        "g.cpp:4: Failure\nValue of: busy\n  Actual: true\nExpected: false\ng.cpp:7: Failure",
    "status is 5, not 0; after the call; a.cpp:7: the mode":
        "g.cpp:4: Failure\nExpected equality of these values:\n  status\n    Which is: 5\n  0\n"
        "after the call\nGoogle Test trace:\n../../a.cpp:7: the mode\n",
    "list differs at [1]: expected 5, got 4":
        "g.cpp:4: Failure\nExpected equality of these values:\n  list\n    Which is: { 3, 4 }\n"
        "  want\n    Which is: { 3, 5 }\n",
    "list differs at [2]: expected its end, got 7":
        "g.cpp:4: Failure\nExpected equality of these values:\n  list\n"
        "    Which is: { 3, 4, 7 }\n  want\n    Which is: { 3, 4 }\n",
    "list differs beyond [1], where its text was cut off; EXPECT_SAME reports the place":
        "g.cpp:4: Failure\nExpected equality of these values:\n  list\n"
        "    Which is: { 3, 4, ... }\n  want\n    Which is: { 3, 4, ... }\n",
    # elements that contain a comma: texts, pairs, lists, characters
    'list differs at [1]: expected "x, y", got "x"':
        "g.cpp:4: Failure\nExpected equality of these values:\n  list\n"
        '    Which is: { "a, \\"b", "x" }\n  want\n    Which is: { "a, \\"b", "x, y" }\n',
    "list differs at [1]: expected (3, 5), got (3, 4)":
        "g.cpp:4: Failure\nExpected equality of these values:\n  list\n"
        "    Which is: { (1, 2), (3, 4) }\n  want\n    Which is: { (1, 2), (3, 5) }\n",
    "list differs at [1]: expected { 6 }, got { 5, 6 }":
        "g.cpp:4: Failure\nExpected equality of these values:\n  list\n"
        "    Which is: { { 1, 2 }, { 5, 6 } }\n  want\n    Which is: { { 1, 2 }, { 6 } }\n",
    "list differs at [1]: expected 'b' (98, 0x62), got '\"' (34, 0x22)":
        "g.cpp:4: Failure\nExpected equality of these values:\n  list\n"
        "    Which is: { ',' (44, 0x2C), '\"' (34, 0x22) }\n"
        "  want\n    Which is: { ',' (44, 0x2C), 'b' (98, 0x62) }\n",
    "list differs at [0]: expected 3, got its end":
        "g.cpp:4: Failure\nExpected equality of these values:\n  list\n    Which is: {}\n"
        "  want\n    Which is: { 3 }\n",
    "filter(list) differs at [40]: expected -3, got 7":
        "g.cpp:4: Failure\nfilter(list) differs at [40]: expected -3, got 7\n",
    "call(1) is 5, not Ok, which is 0":
        "g.cpp:4: Failure\nExpected equality of these values:\n  call(1)\n    Which is: 5\n  Ok\n"
        "    Which is: 0\n",
    "status is 5, not 0":
        "g.cpp:4: Failure\nExpected equality of these values:\n  0\n  status\n    Which is: 5\n",
    "sum: waited for ready":
        'one error before\nunknown file: Failure\nC++ exception with description "{}" thrown in '
        "the test body.\nat clock cycle 7\n[  FAILED  ] A.Throws (7 ms)",
    "a file has no [name]":
        'unknown file: Failure\nC++ exception with description "{}" thrown in SetUp().\n',
    "a.c:1:10: fatal error: none.h: No such file or directory":
        'FAILED: x\nsh -c "gcc -c a.c"\n{}\n    1 | #include "none.h"\nninja: build stopped',
    "twice.c:3:5: warning: ISO C90": "/t.sh: begun\n{}\nmake: *** [x] Error 1",
    "c.c:(.text+0x5): undefined reference to `f'":
        "/bin/ld: c.o: in function `main':\n{}\ncollect2: error: ld returned 1 exit status",
    'CMake Error at CMakeLists.txt:3 (nonsense): Unknown CMake command "nonsense".':
        'CMake Error at CMakeLists.txt:3 (nonsense):\n  Unknown CMake command "nonsense".\n--',
    "%Error: m.v:1:44: syntax error, unexpected ';', expecting TYPE-IDENTIFIER":
        "{}\n    1 | module m(input a); assign b = c +;\n%Error: Exiting due to 1 error(s)",
    "m.v:1: ERROR: syntax error, unexpected ';'": "{}",
    "result(2): expected 5, got 4": "/a/e2.vhd:2:44:@0ms:(assertion failure): {}\n"
                                    "ghdl:error: assertion failed\nfir: vectors of SEED=1",
    "SUMMARY: AddressSanitizer: heap-buffer-overflow u.cpp:2 in main":
        "==13123==ERROR: AddressSanitizer: heap-buffer-overflow on address 0x602000000014\n{}",
    "u.cpp:2:47: runtime error: signed integer overflow: 2147483647 + 1": "begun\n{}",
    "KeyError: 'k'":
        'ERROR: test_c (__main__.T.test_c)\n---\nTraceback (most recent call last):\n  a["k"]\n'
        "{}\n\nFAIL: test_a (__main__.T.test_a)\nAssertionError: 1 != 2\nFAILED (failures=3)",
    "AssertionError: 'no wind' is not in the output: it rains":
        f"F\nFAIL: test_b (__main__.T.test_b)\nA wrong key causes an error.\n{'-' * 70}\n"
        "Traceback (most recent call last):\n  File \"b.py\", line 2, in test_b\n{}\n",
    "s.ice:1:40: error: 'Strin' is not a type that is known here":
        "{}\nmodule M { interface I { void f(int a, Strin b); } }",
    "Ice.ConnectionRefusedException: Ice.ConnectionRefusedException: Connection refused":
        "    p.ice_ping()\nIce.ConnectionRefusedException: Ice.ConnectionRefusedException:\n"
        "Connection refused",
    "ice: src/Ice/Network.cpp:2714: ::Ice::ConnectionRefusedException: connection refused: by peer":
        "ice: src/Ice/Network.cpp:2714: ::Ice::ConnectionRefusedException:\n"
        "connection refused: by peer",
    IDEMPOTENT: "{}\nexception ::Ice::UnknownLocalException\n{\n    unknown = Ice::Marshal\n}",
    "the picture differs": "Ice.Exception: not served, as expected\n{}\nThe mission failed (1).",
    "1 2 differ: byte 1, line 1": "{}\nand a word more",
    "differs: -a +b": "@@ -1,2 +1,2 @@\n same\n-a\n+b"}
BLAME = r"""
foreach(i 1 2 3)
  set(failed "[  FAILED  ] g.Case${i} (${i}7 ms)")
  add_test(NAME test_g.Case${i} COMMAND sh -c
    "printf 'x.cpp:1: Failure\nExpected 1, got 2\n${failed}\n'; exit 1")
endforeach()
add_test(NAME ice.x COMMAND sh -c "printf 'ran\n%s\n}\n'; exit 1")
set(s ${CMAKE_SOURCE_DIR}/hdl/a)
set(at ${s}/broken_proof.vh:1)
set(t ${CMAKE_BINARY_DIR}/t.vcd)
foreach(m around broken) # as written by Yosys: all cells around, and the end of the previous line
  set(cell "($flatten/u_x./u_y.$assert$${at}$12)")
  add_test(NAME formal.${m} COMMAND sh -c
    "echo 'Assert failed in ${m}: ${s}/around.v:7.1-8.9|${at}.6-3.20 ${cell}'; touch '${t}'
     echo '${m}: trace: ${t}'; echo '${m}: an assertion fails'; exit 1")
endforeach()
"""
# The log of a failed flight, and a program in place of the simulator: it replays this flight and
# writes a waveform.
ENDED = """  0.1 s  UAV -> ground
mission: the vision core's result differs from the C++ reference: 141 corners, not 140
-- 11/23/26 06:27:52.116 XBeeAT: link idle
icesoc-sim: Cortex-M3: 748300 instructions; asleep 99.5 % of the time
icesoc-sim: 2.0 s simulated, 37 packets on the air
The mission failed (exit status 1).
To write a waveform of its end: ./icesoc run --replay fly --from 1.500 --to 2.000
To debug it backwards from its end: ./icesoc gdb --replay fly
"""
SIMULATOR = """#!/bin/sh
echo "$@" >asked
cp build/regress/report.html page
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
    def test_reasons(self):
        """The report extracts the reason of a failure from the output of each tool that tests
        run."""
        for reason, log in REASONS.items():
            with self.subTest(reason):
                # "Which is: {}" is an empty list
                log = re.sub(r"(?<!Which is: )\{\}", lambda _: reason, log)
                self.assertEqual(reason_of(log), reason)

    def test_rude(self):
        """Tests that misbehave are reported in the first line of the report, and the run
        continues."""
        self.tests("".join(f"add_test(NAME test_r.{name} COMMAND sh -c [=[{does}]=])\n"
                           for name, (does, _) in RUDE.items()) +
                   "add_test(NAME test_r.Gone COMMAND /none)\n"
                   "set_tests_properties(test_r.Hang PROPERTIES TIMEOUT 2)\n")
        self.regress("--name test_r --jobs 4", 1)
        self.has("^2 passed, 7 failed, 0 skipped", "^1 x  Unable to find executable: /none$",
                 *(said for _, said in RUDE.values()))
        # A limit of 250 KB for files has the same effect as a full disk.
        self.ask("sh", "-c", "trap '' XFSZ; ulimit -f 500; exec $0 --name test_a", REGRESS,
                 status=2)
        self.has("^2 passed, 0 failed",
                 "^regress: cannot write build/regress/report.html: File too large$")
        self.assertFalse(Path("build/regress/report.html.part").exists())
        self.assertEqual(Path("build/regress/history.jsonl").read_text().count("\n"), 2)

    def test_blame(self):
        """Failures are grouped by bug. In a group, the failure that is nearest to the cause comes
        first."""
        self.tests(BLAME.replace("%s", IDEMPOTENT))
        write("hdl/a/broken_proof.vh", "begin\n    assert (full ||\n        !taken);\nend\n")
        self.regress("--name 'test_g|formal|ice'", 1)
        self.has(f"^1 x  {re.escape(IDEMPOTENT)}$",
                 "^3 x  Expected 1, got 2$", "gtkwave build/regress/failures/formal.broken.vcd",
                 "^The longest: .* s ")
        self.assertEqual(re.search("^.* x  .*", self.said, re.M)[0],
                         "2 x  hdl/a/broken_proof.vh:2: assert (full || !taken);")
        self.assertIn("broken", re.search(r"^    \./icesoc test.*", self.said, re.M)[0])
        trace = "build/regress/failures/formal.broken.vcd"
        self.assertTrue(Path(trace).is_file())
        self.has('message="! error: unexpected operation mode',
                 f"^wave: {trace}$", file="build/regress/junit.xml")

    def test_changed(self):
        """The report lists the files of a failed test that have changed since the test passed,
        committed or not, added or removed. The files of a program are its sources."""
        files = {"hdl/fifo/fifo.v": "a\nb\nc\nd\n", "hdl/old.v": "1\n", "docs/page.md": "1\n",
                 "hdl/fifo/test.c": '#include "n.h"\nint main(void) { return LIMIT; }\n',
                 "hdl/fifo/n.h": "#define LIMIT 0\n"}
        for name, text in files.items():
            write(name, text)
        edit("CMakeLists.txt", "small NONE", "small C")
        write("other.c", "int main(void) { return 0; }\n")  # this file belongs to another program
        self.tests("add_test(NAME test_u.Unit COMMAND test_u)\n" + "".join(
            f"add_executable({name} ${{CMAKE_SOURCE_DIR}}/{source})\n"
            f"add_custom_command(TARGET {name} POST_BUILD BYPRODUCTS {name}.list COMMAND true)\n"
            for name, source in (("test_u", "hdl/fifo/test.c"), ("test_v", "other.c"))))
        self.ask("ninja", "-C", "build/main", "test_u")
        self.regress("--name 'a.One|u.Unit'")
        write("docs/page.md", "0\n")  # so no commit contains the tree that the run recorded
        commit("two")
        edit("tests/room/t.sh", *BREAK)
        # The test has never passed, so the report lists the uncommitted files.
        self.regress("--name b.Bad", 1)
        self.has("^        changed since the last commit [(]no recorded run has passed[)]: "
                 r"tests/room/t.sh:3 \(1 line\)$")
        write("hdl/fifo/fifo.v", "a\nB\nc\nD\nE\n")
        write("docs/page.md", "2\n")
        append("other.c", "// changed\n")
        Path("hdl/old.v").unlink()
        commit("three")
        self.regress("--changed --prepare --list --name u.Unit")
        self.has("^Nothing to run")
        # a new file counts as an input of the program only if it is a header
        write("hdl/new.v", "int g;\n")
        write("hdl/fifo/n.h", "#define LIMIT 3\n")
        self.regress("--changed --prepare --list --name u.Unit")
        self.has("^tests/room/test_u$")
        self.ask("ninja", "-C", "build/main", "test_u")
        self.regress("--name 'a.One|u.Unit' --seed 2", 1)
        # files that were not committed when the test passed are also listed
        passed = git("rev-parse --short=10 HEAD~2")
        since, one = f"^        changed since it passed at {passed}", r"1 \(1 line\)"
        own = rf"hdl/fifo/n.h:{one}, "
        script = r"tests/room/t.sh:3 \(1 line\)$"
        self.has(f"{since} with SEED=1: {own}hdl/new.v:{one}, hdl/fifo/fifo.v:2 "
                 rf"\(3 lines\), hdl/old.v:{one}, {script}")  # uncommitted files are first
        # the report about u.Unit lists only files of its program and of its folder
        self.has(f"{since} with SEED=1: {own}{script}")
        self.has("changed: changed since it passed",
                 file="build/regress/junit.xml")
        self.has('"changed":"changed since it passed', file="build/regress/report.html")
        self.ask("git", "cat-file", "-e", git("hash-object hdl/new.v"), status=1)  # no object
        write(".git/info/exclude", "flicker\n")
        self.regress("--name c.Flicker")
        write("flicker", "")
        self.regress("--name c.Flicker", 1)
        self.has("^        nothing has changed since it passed at [0-9a-f]*$")
        # if no tree was recorded, the report uses the commit of the run
        self.ask("rm", "-r", "build/regress/tree")
        self.regress("--name a.One", 1)
        self.has(rf"{since}: {own}hdl/new.v:{one}, hdl/fifo/fifo.v:1 \(5 lines\), "
                 ".* tests/room/t.sh")

    def test_waves(self):
        """The report is written even if the test is next to a core, outside tests/, or if its trace
        is damaged."""
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
        wire, up = "$var wire 1 {0} {0} $end ", "$upscope $end "
        word = "$var wire 1 @ !memory[3] $end "
        wave = ("$timescale 1ns $end $scope module top $end $var wire 1 ! clk_i $end "
                f"$scope module u_a $end {wire.format('&')}{up}"
                f"$scope module u_post $end {wire.format('#')}{word}{up}{up}"
                "$enddefinitions $end #0 0! 0& 0# 0@ #5 1! 1& 1# 1@ #10 0! ")
        write("ip/core/core.v", "module core;\n    post #(.N(1)) u_post (.b(b));\nendmodule\n")
        write("ip/core/post.v", "module post;\nendmodule\n")
        commit("two modules")
        append("ip/core/post.v", "// a bug\n")
        write("ip/core/t.vcd", re.sub(r"(end|#\d+|\d[!&#@]) ", r"\1\n", wave))  # for vcd2fst
        write("ip/core/damaged.vcd", wave.replace("#5", "#five"))
        write("build/trace/ip/core/verilated_core/Vcore.h", "VL_IN8(&clk_i,0,0);\n")
        append("CMakeLists.txt", "add_subdirectory(ip/core)\n")
        self.tests("")
        self.regress("--name 'test_w|damaged'", 1)
        self.has("^0 passed, 2 failed", "formal.damaged.vcd is damaged, so the page does")
        self.has("^TOP.clk_i$", file="build/regress/failures/test_w.Wave-1.gtkw")
        self.has("test_w.Wave-1.fst", r'"signals":\[\["top.u_post.#"',
                 file="build/regress/report.html")

    def test_vhdl(self):
        """For a GHDL test, the report lists only files that GHDL compiles for it. In the waveform,
        the instance of the first of these files comes first, with the names of this instance for
        signals that its parents contain as well."""
        join = "testbench/common/join_waves.sh"
        write(join, (TREE / join).read_text())
        write("cmake/vhdl_test.sh", '#!/bin/sh\n[ ! -e wrong ] && exit\n'
              'echo "$PWD/ip/core/core_tb.vhd:5:9:@120ns:(assertion error): differs"\n'
              '[ -z "${WAVE:-}" ] || vcd2fst "${0%/*}/t.vcd" "$WAVE"\nexit 1\n')
        scope, up = "$scope module ", "$upscope $end\n"
        write("cmake/t.vcd", "$timescale 1ns $end\n" + "".join(
            f"{scope}{name} $end\n$var wire 4 {key} {signal} $end\n" for name, key, signal in (
                ("core_tb", "&", "result"), ("u_dut", "!", "count"), ("u_core", "#", "state"),
                ("u_inner", "&", "sum"), ("u_leaf", "%", "carry"))) + 5 * up +
              "$enddefinitions $end\n#0\n" + "\n".join(
            f"b{value:04b} {key}" if key else f"#{value}" for value, key in (
                (0, "!"), (0, "#"), (0, "&"), (0, "%"), (50, ""), (1, "!"), (1, "#"), (1, "&"),
                (1, "%"))) + "\n")
        for name in "core_tb", "core", "inner", "leaf", "other":
            write(f"ip/core/{name}.vhd", f"entity {name} is\nend;\n")
        write("ip/core/core.vhd", "entity core is\nend;\narchitecture rtl of core is\nbegin\n"
              "  U_Inner : entity work.inner\n    port map (a => a);\nend;\n")
        write("ip/core/inner.vhd", "entity inner is\nend;\narchitecture rtl of inner is\nbegin\n"
              "  u_leaf : leaf port map (a => a);\nend;\n")
        write("hdl/a/other.v", "module other;\n    inner u_other (.a(a));\nendmodule\n")
        files = " ".join(f"${{CMAKE_SOURCE_DIR}}/ip/core/{name}.vhd"
                         for name in ("leaf", "inner", "core", "core_tb"))
        self.tests("add_test(NAME core.vhdl COMMAND ${CMAKE_SOURCE_DIR}/cmake/vhdl_test.sh core "
                   f"{files} WORKING_DIRECTORY ${{CMAKE_SOURCE_DIR}})\n")
        commit("a core in VHDL")
        self.regress("--name vhdl")
        append("hdl/a/other.v", "// changed\n")
        append("ip/core/other.vhd", "-- changed\n")
        append("ip/core/inner.vhd", "-- a bug\n")
        write("wrong", "")
        self.regress("--name vhdl", 1)
        self.has(r"^        changed since it passed at [0-9a-f]+: ip/core/inner.vhd:7 \(1 line\)$",
                 "^1 x  differs$", "^        at ip/core/core_tb.vhd:5$",
                 "^Waveform of core.vhdl around clock 12 ")
        self.has(r'"signals":\[\["core_tb.u_dut.u_core.u_inner.sum"',
                 file="build/regress/report.html")
        rows = Path("build/regress/failures/core.vhdl-1.gtkw").read_text()
        self.assertIn("\ncore_tb.u_dut.u_core.u_inner.sum[3:0]\n", rows)
        self.assertNotIn("u_leaf", rows)

    def test_flight(self):
        """A flight that fails is replayed around the last event of a core."""
        join = "testbench/common/join_waves.sh"
        write(join, (TREE / join).read_text())
        write("build/trace/gen/soc_cores.vh",
              "camera u_camera (\n  .clk_i(clk_i), .bus_valid_i(slot_valid[2]), .irq_o(i));\n"
              "core u_core (\n    .clk_i(clk_i), .bus_valid_i(slot_valid[3]), .irq_o(j));\n")
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
        self.has("141 corners", file="page")
        self.ask("fst2vcd", f"{left}.fst")
        # the first task was running before the waveform of the signals begins
        self.assertRegex(self.said.replace("\n", " "),
                         "#3 .*sidleTask .*#10 .*0. .*#20 .*1. .*sradioTask .*#33 sidleTask")
        self.has("^program.task$", file=f"{left}.gtkw")
        self.has(r'"program.task",0,\[3,"idleTask",20,"radioTask",33,"idleTask"\]\],'
                 # signals of the core come before the ports
                 r'\["TOP.u_core.busy"', file="build/regress/report.html")


main(Cases)
