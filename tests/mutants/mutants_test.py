#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""mutants_test: tests run.py and drawn.py, and the exit status of proofs, with small designs.

Usage: mutants_test.py run|drawn|prove work-folder [verilators-runtime.a]
"""
import json
import os
import re
import subprocess
import sys
from pathlib import Path

from icesoc.mutants import model, results
from script import TREE, Script, edit, fresh, git, main, write

RUN = TREE / "tools/python", "-m", "icesoc.mutants.run"
PROJECT = "cmake_minimum_required(VERSION 3.25)\nproject(tiny {})\nenable_testing()\n"
TINY = """/* doubles */
static int twice(int n) {
    return 2 * n;
}
int main(void) {
    return twice(3) != 6;
}
"""
TWICE = "    return 2 * n;"
PAIR = """`default_nettype none
module pair (
    input wire clk_i, input wire a_i, input wire b_i, output reg both_o, output wire same_o);
    assign same_o = a_i | (a_i & b_i);
    always @(posedge clk_i)
        both_o <= a_i & b_i;
`ifdef FORMAL
    reg past = 0, a, b;
    always @(posedge clk_i)
        {past, a, b} <= {1'b1, a_i, b_i};
    always @* if (past) begin
        assert (same_o == a_i);
        cover (both_o);
    end
`endif
endmodule
"""
TEST = """#include "Vpair.h"
int main() {
    Vpair top;
    for (unsigned i = 0; i < 8; ++i) {
        top.clk_i = 0;
        top.eval();
        top.a_i = i & 1, top.b_i = i >> 1 & 1;
        top.eval();
        top.clk_i = 1;
        top.eval();
        if (top.both_o != (top.a_i & top.b_i))
            return 3;
    }
}
"""
PROGRAMS = r"""rule script
  command = printf '#!/bin/sh\necho said; exit $$((%s))\n' '$fails' >$out && chmod +x $out
rule model
  command = mkdir -p $$(dirname $out) && echo "$modules" >$$(dirname $out)/modules && touch $out
rule library
  command = touch $out
build hdl/verilated_Pair/VPair__ver.d: model
  modules = pair other
build hdl/verilated_Pair/VPair__ALL.a: library hdl/verilated_Pair/VPair__ver.d
build hdl/verilated_Bad/VBad__ver.d: model
  modules = bad
build hdl/verilated_Bad/VBad__ALL.a: library hdl/verilated_Bad/VBad__ver.d
build test_pair: script | hdl/verilated_Pair/VPair__ALL.a
  fails = MUTANT == 1
build test_bad: script | hdl/verilated_Bad/VBad__ALL.a
  fails = 1
"""


class Cases(Script):
    def setUp(self):
        self.work = fresh(sys.argv[2])

    def bugs(self, **bugs):
        """Seeds bugs, each given as a line to remove and a line to add."""
        write("tests/mutants/tiny.bugs.json", json.dumps({
            name: {"does": "A bug.", "test": "test_tiny", "file": "tiny.c", "old": old, "new": new}
            for name, (old, new) in bugs.items()}))

    def test_run(self):
        """Tests each result that a seeded bug can have, and an interrupted run."""
        write("CMakeLists.txt", PROJECT.format("C") + "add_executable(test_tiny tiny.c)\n"
              "add_test(NAME test_tiny COMMAND test_tiny)\n")
        write("tiny.c", TINY)
        write(".gitignore", "build\n")
        git("init -q .")
        git("add .")
        wrong = TWICE, "    return 3 * n;"
        self.bugs(wrong=wrong)
        self.ask(*RUN, "--jobs", "1")
        self.has("^caught *tiny/wrong ")
        kept = results.read("build/mutants/planted.xml")[1]
        self.assertEqual([(m.name, m.result, m.test, m.place) for m in kept],
                         [("tiny/wrong", "caught", "test_tiny", "tiny.c:3")])

        # A bug that an interrupted run has left is removed; otherwise the tests would run with it.
        copies = [Path("build/mutants", number) for number in "01"]
        write(copies[0] / "tiny.c.orig", TINY)
        edit(copies[0] / "tiny.c", "2 *", "3 *")
        write(copies[0] / "left_the_tree.c", "")
        self.bugs(wrong=wrong, comment=("/* doubles */", "/* halves */"),
                  nonsense=(TWICE, "    retrun 2 * n;"), nothing=(TWICE, TWICE),
                  stale=("    return 6 * n;", "    return 5 * n;"))
        self.ask(*RUN, "--jobs", "2", status=1)
        self.has("caught *tiny/wrong ", "SURVIVED *tiny/comment ", "does not build *tiny/nonsense ",
                 "does not apply *tiny/stale ", "does not apply *tiny/nothing ",
                 "^mutants: 1 of 5 caught")
        self.assertFalse((copies[0] / "left_the_tree.c").exists())
        for copy in copies:
            self.assertEqual((copy / "tiny.c").read_text(), TINY)
        self.ask(*RUN, "--check", status=1)
        self.has("tiny/stale: does not apply")
        self.make("mutants", "BLOCK=tiny/wrong", "JOBS=1", tree=".")
        self.has("^mutants: 1 of 1 caught")
        write("ip/little/little.bugs.json", Path("tests/mutants/tiny.bugs.json").read_text())
        self.make("mutants", "BLOCK=little/wrong", "JOBS=1", tree=".")  # a bug of a core
        self.has("^caught *little/wrong ", "^mutants: 1 of 1 caught")
        os.remove("ip/little/little.bugs.json")
        self.bugs(wrong=wrong)
        malformed = Path("tests/mutants/wrong.bugs.json")
        for text in '{"no": {"test": "and no file"}}\n', "no JSON\n", "[]\n":
            malformed.write_text(text)
            self.ask(*RUN, "--check", status=1)
            self.has("wrong.bugs.json: expected bugs in the format")
        malformed.unlink()

        # A test that fails even without a bug detects nothing.
        edit("tiny.c", "!= 6", "!= 7")
        self.ask(*RUN, "--jobs", "1", status=1)
        self.has("test_tiny fails without any mutant")

    def draw(self, status=0, block="pair"):
        self.make("mutants", "DRAW=8", "SEED=3", "JOBS=2", f"BLOCK={block}", tree=".",
                  status=status)

    def test_drawn(self):
        """The proof in this test covers only half of the module. Mutants that the proof misses are
        reported with their line, and mutants that are not bugs are excluded. The survivors are then
        put into a model, and a test that runs with this model detects them."""
        self.a_flip_flop_is_found_by_its_signal()
        pair = "hdl/small/pair.v"
        write(pair, PAIR)
        write("bus/none.v", "")
        write("ip/none", "")
        prove = f"{TREE}/tools/python -m icesoc.proof.prove pair 4 {self.work}"
        write("CMakeLists.txt",
              PROJECT.format("NONE") + f"add_test(NAME formal.pair COMMAND {prove} build/pair)\n")
        self.ask("cmake", "-S", ".", "-B", "build", "-G", "Ninja")
        self.draw(status=2)
        self.has("^SURVIVED .*formal.pair .*hdl/small/pair.v:[56] ", "^pair .* [1-9] the same$",
                 "below 95 %: pair$")
        # each mutant of line 4 of the module is equivalent to the module, or the proof detects it
        self.lacks("^SURVIVED .*pair.v:4 ")
        missed = [m for m in results.read("build/mutants/drawn.xml")[1] if m.result == "SURVIVED"]
        self.the_model_carries(missed, pair)
        edit(pair, "assert (same_o == a_i);",
             "assert (same_o == a_i); assert (both_o == (a && b));")
        self.draw()
        self.has(r"^(\d*) of \1 mutants tried", "^pair  *100.0 %")
        self.lacks("SURVIVED", file="build/mutants/drawn.xml")
        drawn = Path("build/mutants/drawn/pair/list").read_text()
        self.draw()
        self.assertEqual(Path("build/mutants/drawn/pair/list").read_text(), drawn)
        self.a_test_that_fails_as_it_is_catches_none()
        # A mutant that does not run is reported; the others are still judged.
        path = os.environ["PATH"]
        write("yosys", '#!/bin/sh\ncase $PWD in */drawn/pair/2) echo "no such thing" && exit 1 ;;\n'
              f'esac\nPATH={path} exec yosys "$@"\n')
        os.environ["PATH"] = f"{self.work}:{path}"
        self.draw(status=2)
        self.has("no such thing", "^mutants: 1 do not run", "^pair  *100.0 %")
        # With DRAW, BLOCK is the name of a proof, so it is not checked against the names of seeded
        # bugs.
        self.bugs(wrong=(TWICE, ""))
        self.draw(2, "nothing")
        self.has("no proof has a name that begins with nothing")

    def test_prove(self):
        """A proof that cannot run ends with another status than a proof that fails."""
        write("hdl/small/pair.v", PAIR)
        write("hdl/small/parent.v", "module parent(input a);\n    lost u_a (.a(a));\nendmodule\n")
        write("bus/none.v", "")
        write("ip/none", "")

        def prove(module, status, *said):
            self.ask(f"{TREE}/tools/python", "-m", "icesoc.proof.prove", module, "4", self.work,
                     f"build/{module}", status=status)
            self.has(*said)
        prove("pair", 0, "^pair: proven")
        prove("paar", 2, "^paar: no paar.v below bus, hdl, ip or testbench/sim$")
        prove("parent", 2, "Module .*lost.* referenced in module .*parent.* is not part",
              "^parent: Yosys cannot read the module")
        edit("hdl/small/pair.v", "assert (same_o == a_i)", "assert (same_o != a_i)")
        prove("pair", 1, "^pair: an assertion fails")

    def a_flip_flop_is_found_by_its_signal(self):
        """Yosys creates the flip-flops of a line in an order that depends on other modules."""
        def design(*names):
            module = {"cells": {}, "netnames": {}}
            for number, name in enumerate(names):
                module["netnames"][name] = {"bits": [10 + number], "hide_name": 0}
                module["cells"][f"$procdff${number}"] = {
                    "type": "$dff", "attributes": {"src": "/a/hdl/small/two.v:3.5-9.8"},
                    "connections": {"Q": [10 + number]}}
            write("plain.json", json.dumps({"modules": {"two": module}}))
            return model.cells("plain.json")

        drawn, other = design("sum", "left"), design("left", "sum")
        alike, number = model.place(drawn, "two", "$procdff$0")
        self.assertEqual(other["two"][alike][number][0], "$procdff$1")

    def the_model_carries(self, missed, pair):
        results.write("missed.xml", missed)
        self.ask(TREE / "tools/icesoc/mutants/model.py", "--cc", "-Wall", "--top-module", "pair",
                 "--prefix", "Vpair", "--Mdir", "model", pair,
                 env={**os.environ, "DRAWN": str(self.work / "missed.xml")})
        # later steps of a build read the Verilog files of the model again
        sources = re.findall(r"\S+[.]v\b", Path("model/Vpair__ver.d").read_text())
        self.assertTrue(sources)
        for source in sources:
            self.assertTrue(Path(source).exists(), source)
        root = subprocess.check_output(["verilator", "--getenv", "VERILATOR_ROOT"], text=True)
        include = f"{root.strip()}/include"
        # one file: its headers take most of the time of the compiler
        write("main.cpp", "".join(f'#include "{file}"\n' for file in Path("model").glob("*.cpp"))
              + TEST)
        self.ask("c++", "-Imodel", f"-I{include}", f"-I{include}/vltstd", "main.cpp",
                 sys.argv[3], *"-lz -lpthread -o test_pair".split())
        self.ask("./test_pair")  # without a mutant, the model behaves like the module
        for mutant in range(1, len(missed) + 1):
            self.ask("./test_pair", env={**os.environ, "MUTANT": str(mutant)}, status=3)

    def a_test_that_fails_as_it_is_catches_none(self):
        """If a test fails even without a mutant, or does not contain the module that it should
        test, the results of the other blocks are still reported."""
        write("copy/build/main/build.ninja", PROGRAMS)
        # a model that an earlier run has left is written again
        self.ask("ninja", "-C", "copy/build/main")
        write("copy/build/main/hdl/verilated_Pair/modules", "earlier\n")
        write("by_tests.py", f"""import pathlib, sys
from concurrent.futures import ThreadPoolExecutor
from icesoc.mutants import drawn, results, run
run.TOP, run.prepare = pathlib.Path.cwd(), lambda *_: None
drawn.TESTS = {{"pair|stream": "test_pair", "bad": "test_bad"}}
rows = [results.Mutant(name, "SURVIVED", "formal." + name, 1, "", {{"module": name}})
        for name in ("pair", "pair", "bad", "stream")]
with ThreadPoolExecutor(2) as pool:
    assert drawn.by_tests(rows, run.TOP / "copy", pool) == ["test_bad", "test_pair"]
assert [(row.result, row.test) for row in rows] == [
    ("caught", "test_pair"), ("SURVIVED", "formal.pair"), ("SURVIVED", "formal.bad"),
    ("SURVIVED", "formal.stream")], rows
""")
        self.ask(TREE / "tools/python", "by_tests.py")
        self.has("^said$", "test_bad fails without any mutant, so it caught none",
                 "test_pair does not contain stream, so it cannot catch its mutants")
        self.lacks("does not contain (pair|bad),")


main(Cases)
