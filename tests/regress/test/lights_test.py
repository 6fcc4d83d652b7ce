#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""lights_test: a bug of each kind turns its light red, and no other.

Usage: lights_test.py lights_... work-folder build-folder
"""
import json
import os
import subprocess
from pathlib import Path

from project import REGRESS, TREE, Project, edit, main, write

# The coverage test's design: two bits that count to 2.
COUNTER = """`default_nettype none
module counter (input wire clk_i, input wire rst_i, input wire enable_i, output reg [1:0] count_o);
    always @(posedge clk_i) begin
        if (enable_i)
            count_o <= (count_o == 2) ? 0 : count_o + 1;
        if (rst_i)
            count_o <= 0;
    end
`ifdef COVER_POINTS
    reset_at_two: cover property (@(posedge clk_i) rst_i && count_o == 2);
`endif
endmodule
"""
STIMULUS = """#include "Vcounter.h"
#include <cstdlib>
#include <verilated_cov.h>
int main() {
    Vcounter top;
    for (int i = 0; i < 40; ++i) {
        top.clk_i = i & 1;
        if (!top.clk_i) { // a property samples what was there before the edge
            bool shy = std::getenv("SHY") && top.count_o == 2;
            top.rst_i = (i < 4 || i > 26) && !shy;
            top.enable_i = !std::getenv("LAZY") && i % 3;
        }
        top.eval();
    }
    VerilatedCov::write("build/coverage/rtl.dat");
}
"""


def tree(folders):
    return subprocess.check_output([REGRESS, "--tree", folders], text=True)


def measured(name, folders):
    """Writes the file that a measurement's command leaves beside its figures."""
    write(f"build/{name}/tree", tree(folders))


class Cases(Project):
    def lights(self, words="--name 'a[.]'", status=0, **states):
        """The states of some lights after a run; by default of the tests that pass."""
        self.regress(words, status)
        self.has(*(f"^{name}  *{state}" for name, state in states.items()))

    def test_lights_function(self):
        self.lights(tests="green")
        self.lights("--name '[ab][.]'", 1, tests="red   *1 failed: test_b.Bad")

    def test_lights_proof(self):
        self.lights("--name 'formal|a[.]'", proofs="green")
        self.tests("add_test(NAME formal.counter COMMAND false)\n")
        self.lights("--name 'formal|a[.]'", 1, proofs="red   *1 failed: formal.counter",
                    tests="green")

    def test_lights_coverage(self):
        write("hdl/small/counter.v", COUNTER)
        write("main.cpp", STIMULUS)
        write("build/coverage/none", "")
        write("gates.json", '{"gates": {"hdl/": {"lines": 95, "toggles": 95}}}')
        self.ask("verilator", *"--cc --exe --build --coverage --assert -DCOVER_POINTS -O0".split(),
                 *"-Mdir build/small hdl/small/counter.v".split(), self.work / "main.cpp",
                 "-MAKEFLAGS", "OPT_FAST=-O0 OPT_SLOW=-O0 OPT_GLOBAL=-O0 CXX='ccache g++'")

        def measure(**environment):
            self.ask("build/small/Vcounter", env={**os.environ, **environment})
            done = subprocess.run([TREE / "tests/regress/coverage.py", "gates.json",
                                   "build/coverage"], capture_output=True, text=True)
            measured("coverage", "hdl")
            return done.stdout + done.stderr

        below = "red   *1 files below their gate: hdl/small/counter.v"
        measure()
        self.lights(coverage="green")
        measure(LAZY="1")  # the stimulus is forgotten: the test still passes
        self.lights(coverage=below, tests="green")
        # All lines, all toggles; but one situation, named in the design, never comes.
        said = measure(SHY="1")
        self.lights(coverage=below)
        self.assertRegex(said, r"toggles 100.0 \(gate 95\), points 0.0 \(gate 100\); "
                         "never: [0-9]*: reset_at_two")
        measure()
        self.lights(coverage="green   *100.0 % of lines, 100.0 % of toggles, 1 of 1 cover points")
        self.has('"reset_at_two"', file="build/regress/report.html")
        edit("gates.json", '{"hdl/"', '{"gone.v": {}, "hdl/"')
        self.assertIn("a gate of no file: gone.v", measure())

    def test_lights_mutants(self):
        results = "small/one\tcaught\ttest_a\t1\nsmall/two\t{}\ttest_a\t1\n"
        measured("mutants", "hdl")
        for verdict, state in (("caught", "green  2 of 2 caught"),
                               ("SURVIVED", "red   *1 of 2 not caught: small/two"),
                               ("caught", "green")):
            write("build/mutants/results.tsv", results.format(verdict))
            self.lights(mutants=state, tests="green")
        missed = "red   *1 modules of which proofs and tests miss drawn mutants: fifo"
        for score, state in (87.5, missed), (100, "green"):
            fifo = {"drawn": 8, "same": 0, "caught": 7, "score": score}
            write("build/mutants/drawn.json",
                  json.dumps({"seed": "1", "tree": tree("hdl").strip(), "gate": 95,
                              "survived": [], "modules": {"fifo": fifo}}))
            self.lights(mutants=state)
        write("hdl/new.v", "\n")  # the measured sources have changed
        self.lights(mutants="grey   sources have changed since it was green")

    def test_lights_figures(self):
        """As `make synth` and `make bench` report them: within a limit, beyond it, without a
        figure."""
        def entry(value, unit, limit):
            return [{"name": "whole", "value": value, "unit": unit, "limit": limit}]

        def size(value, failures=(), state="as accepted"):
            write("build/synth/report.json", json.dumps(
                {"failures": failures, "states": {"whole": state},
                 "entries": entry(value, "LUT", 40)}))

        def speed(value):
            write("build/bench/simulator.json", json.dumps(entry(value, "clocks/s, at least", 50)))

        def measure(**states):
            measured("synth", "project")
            measured("bench", "hdl")
            self.lights(**states)

        size(40)
        speed(60)
        measure(size="green", speed="green")
        size(40, state="changed since")
        measure(size="grey   1 changed since, 0 never measured here: make synth")
        size(41)
        measure(size="red   *1 beyond their limits: whole 41 [(]at most 40[)]", tests="green",
                speed="green")
        size(0, ["whole: synthesis failed"])
        speed(49)
        measure(size="red .*whole: synthesis failed",
                speed="red   *1 beyond their limits: whole 49 [(]at least 50[)]")


main(Cases)
