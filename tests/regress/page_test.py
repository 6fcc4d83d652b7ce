#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""page_test: tests the page of the regression tool in Chromium, and its status summary, in which a
bug of one kind must turn only the status of this kind red. Usage: page_test.py case work-folder
build-folder"""
import json
import os
import re
import subprocess
from pathlib import Path
from types import SimpleNamespace

from project import BUILD, TREE, Project, append, main, write
from icesoc.mutants import results
from icesoc.regress import blocks
from icesoc.util import browser
from icesoc.util.tree import tree_state, write_state

VCD = """$timescale 1ns $end
$scope module top $end $var wire 1 ! clk_i $end
$scope module u_fifo $end $var wire 1 ! clk_i $end
$var reg 8 " level [7:0] $end $var reg 8 & mask [7:0] $end $upscope $end $upscope $end
$scope module program $end $var string 1 p.task task $end $upscope $end $enddefinitions $end
#0 0! b0 " b1010 & sUAV_radioTask p.task #5 1! #10 0! b10100111 " #15 1!
"""
FIFO = {"name": "hdl/fifo/fifo.v", "value": 97, "lines": 200, "limit": 95, "toggles": 96,
        "toggle_points": 9, "toggle_gate": 95, "why": "", "missed": ["12: level_o[3]", "40"]}

# Design for the coverage test: a counter with two bits that counts to 2.
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
        if (!top.clk_i) { // a property samples the values before the edge
            bool shy = std::getenv("SHY") && top.count_o == 2;
            top.rst_i = (i < 4 || i > 26) && !shy;
            top.enable_i = !std::getenv("LAZY") && i % 3;
        }
        top.eval();
    }
    VerilatedCov::write("build/coverage/rtl.dat");
}
"""


def measured(name, folders):
    """Writes a file with figures, in the format of the commands that measure."""
    Path("build", name).mkdir(parents=True, exist_ok=True)
    write_state(Path("build", name), tree_state(".", folders))


WRITTEN = "build/regress/report.html"


class Cases(Project):
    def browse(self, page):
        self.said = browser.elements(Path(page).resolve().as_uri())

    def test_page(self):
        write("t.vcd", VCD)
        self.tests("""add_test(NAME formal.broken COMMAND sh -c "echo 'Assert failed in broken'
    echo 'broken: trace: ${CMAKE_SOURCE_DIR}/t.vcd'; exit 1")
""")
        write("build/coverage/summary.json",
              json.dumps({"total": 97, "toggles": 95, "entries": [FIFO]}))
        self.regress("", 1)
        page = Path(WRITTEN).read_text()
        self.lacks('src="http|href="http', WRITTEN)  # offline
        # If the libraries could not be downloaded, the page is still complete and explains how to
        # get them.
        write("plain.html", re.sub("(?m)^(!function.*Tabulator=|.*var uPlot=).*\n", "", page))
        self.browse("plain.html")
        self.has("Tabulator and uPlot could not be downloaded",
                 "<td>test_c.Flicker</td>", 'class="dot dp"')
        if not (BUILD / "page/libraries.js").stat().st_size:
            self.skipTest("Tabulator and uPlot could not be fetched")
        self.clicks(page)
        self.part_of_a_run()
        self.small_and_wrong(page)

    def clicks(self, page):
        clicks = Path(__file__).with_name("clicks.js").read_text()
        write("clicked.html", page.replace("</body>", f"<script>\n{clicks}</script></body>"))
        self.browse("clicked.html")
        self.has(
            "seen: sorted test_d.Crash test_c.Flicker test_b.Bad test_a.Two test_a.One "
            "formal.thing formal.broken;", "filtered test_c.Flicker;",
            'csv "test",.* / "test_c.Flicker","passed",',
            "of 2000 some; largest b &lt;a&gt;; picked b; open b c &lt;a&gt;; at .*c.*; folded b "
            "&lt;a&gt;; canvas true true; read iii no. 2 2; moved i no. 0 2;",
            "3 failed", 'class="waveform"',
            ">UAV_radioTask<", "; rows program.task \u25B8 top; "
            "tree program.task \u25BE top clk_i \u25B8 u_fifo; "  # the clock is listed only once
            "deeper program.task \u25BE top clk_i \u25BE u_fifo level mask; "
            "values UAV_radioTask 1 a7 0a; readout cursor at time 15, where it failed; "
            "0 to 15 are shown; "
            "unsigned UAV_radioTask 1 167 u 0a; signed UAV_radioTask 1 -89 s 0a; "
            "earlier UAV_radioTask 0 0 s 0a; readout cursor at time 0, 15 before the failure; .*; "
            "later UAV_radioTask 1 -89 s 0a;",
            'id="results"', "test_c.Flicker",
            'id="runs".*>one<',  # the line of a run shows the subject of its commit
            "<div>test_b.Bad: value 1 is not 7", 'class="dot dp"', "12 clauses with 3 flops",
            r'<a href="../../hdl/fifo/fifo.v">hdl/fifo/fifo.v:12: level_o\[3\]</a><br>'
            '<a href="../../hdl/fifo/fifo.v">hdl/fifo/fifo.v:40</a>',
            'at <a href="../../x.cpp">x.cpp:12</a>; '
            'log <a href="failures/test_b.Bad-1.log"',
            'run has passed[)]: <a href="../../tests/room/CMakeLists.txt">'
            r"tests/room/CMakeLists.txt:8</a> \(2 lines\)")
        # no table of seeds exists, because all these failures have the same seed and are listed
        # above
        self.lacks('id="seeds"')
        self.assertEqual(json.loads(Path("build/regress/report.json").read_text())["blocks"], [
            {"block": "hdl/fifo", "green": "", "lines": [194, 200, 0]},
            {"block": "room", "green": "", "tests": [3, 2, 0], "proofs": [1, 1, 0]}])
        self.has('id="blocks".*>97.0 %<.*>2 failed of 5<.*>1 failed of 2<')

    def part_of_a_run(self):
        write("tests/plan.toml", '[a]\n"It works" = "test_a.One"\n"It waits" = "test_c.*"\n')
        write("tests/room/other", "new\n")
        self.regress("--name a.One")
        self.browse(WRITTEN)
        self.has('id="seeds"', ">1 passed, 4 did not run<", ">2 did not run<",
                 "<summary>1 without a test that ran</summary>")
        self.has("Requirements: 1 of 1 that were tested proven", ">It works<",
                 "<summary>1 with tests that did not run with these sources</summary>")
        self.lacks(">It waits<")

    def small_and_wrong(self, page):
        """At a width of 420 pixels, columns that do not fit are shown below their row. An error in
        a script is detected."""
        write("small.html", page.replace("</body>", """<script>setTimeout(() =>
top.document.body.append("wider: " + [...document.querySelectorAll(".tabulator-col, h2")]
  .filter(e => e.getBoundingClientRect().right > 421).map(e => e.innerText) + ";"), 1000);
</script></body>"""))
        write("frame.html", '<iframe src="small.html" width="420" height="3000"></iframe>')
        self.said = browser.elements(Path("frame.html").resolve().as_uri(),
                                     "--allow-file-access-from-files")
        self.has("wider: ;")
        self.assertEqual(browser.fault(WRITTEN), "")
        write("wrong.html", page.replace("of data.lights", "of data.lihgts"))
        self.assertRegex(browser.fault("wrong.html"), "^wrong.html:[0-9]*: Uncaught TypeError: "
                         "data.lihgts is not iterable: for [(]const light")
        self.ask("env", "ICESOC_TREE=.", TREE / "icesoc", "build", "pictures", "--from", "build",
                 "--to", ".", "regression")
        picture = Path("regression.png").read_bytes()
        self.assertEqual(picture[1:4], b"PNG")
        self.assertLess(len(picture), 100000)

    def test_blocks(self):
        """A test, a module and a file belong to the block of their folder. The last green commit of
        a block is the commit of the last run in which at least one test of the block ran and no
        test of the block was failing."""
        for file in ("hdl/fifo/fifo.v", "hdl/fifo/fifo_proof.vh", "hdl/wire/wire_in.v",
                     "ip/fir/fir.v", "sw/link/test/l.c"):
            write(file, "\n")
        known = blocks.Blocks(Path("."))
        for name, place, block in (
                ("test_fifo_deep.Fifo.One", "hdl", "hdl/fifo"), ("formal.fifo_2", "hdl/formal",
                "hdl/fifo"), ("hdl.cdc.test_fifo.1", "hdl", "hdl/fifo"),
                ("test_wire_modes.Modes.One", "hdl", "hdl/wire"),
                ("formal.idle_fir", "hdl/formal", "ip/fir"),
                ("test_ip_fir.Fir.One", "fir", "ip/fir"), ("test_x.One", "hdl", "hdl"),
                ("test_link.Link.One", "sw/link", "sw/link"), ("mission.plain", "e2e/mission",
                "e2e")):
            self.assertEqual(known.of_test(name, place), block)

        write("hdl/fifo/fifo_in.v", "\n")
        entries = [{"name": f"{name} lut", "value": value, "limit": 9}
                   for name, value in (("fifo", 8), ("fifo_in", 4))]
        self.assertEqual(blocks.blocks_of({"results": [], "mutants": [], "utilisation": {
            "entries": entries}}, [], SimpleNamespace(runs=[]), Path(".")),
            [{"block": "hdl/fifo", "green": "", "luts": [8, 9, 0]}])

        def run(commit, *ends):
            return {"commit": commit, "ends": [[*end.split(), 0, "", "1"] for end in ends]}
        runs = [run("one", "a p", "b p"), run("two", "a f"), run("three", "b p"),
                run("four", "c s")]
        of = {"a": "x", "b": "x", "c": "y"}
        self.assertEqual(blocks.last_green(SimpleNamespace(runs=runs), of), {"x": "one"})
        runs.append(run("five", "a p"))
        self.assertEqual(blocks.last_green(SimpleNamespace(runs=runs), of), {"x": "five"})

    def lights(self, words="--name 'a[.]'", status=0, **states):
        """Runs tests, by default those that pass. Then checks the status summary: each keyword
        argument is the name of a status and its expected state."""
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
        write("limits.toml", '[coverage]\n"hdl/" = { lines = 95, toggles = 95 }\n')
        self.ask("verilator", *"--cc --exe --build --coverage --assert -DCOVER_POINTS -O0".split(),
                 *"-Mdir build/small hdl/small/counter.v".split(), self.work / "main.cpp",
                 "-MAKEFLAGS", "OPT_FAST=-O0 OPT_SLOW=-O0 OPT_GLOBAL=-O0 CXX='ccache g++'")

        def measure(**environment):
            self.ask("build/small/Vcounter", env={**os.environ, **environment})
            done = subprocess.run([TREE / "tools/python", "-m", "icesoc.regress.coverage",
                                   "limits.toml", "build/coverage"], capture_output=True, text=True)
            measured("coverage", "hdl")
            return done.stdout + done.stderr

        below = "red   *1 files below their gate: hdl/small/counter.v"
        measure()
        self.lights(coverage="green")
        measure(LAZY="1")  # the stimulus is missing, but the test still passes
        self.lights(coverage=below, tests="green")
        # All lines and all toggles are covered, but one situation that a cover point names never
        # occurs.
        said = measure(SHY="1")
        self.lights(coverage=below)
        self.assertRegex(said, r"toggles 100.0 \(gate 95\), points 0.0 \(gate 100\); "
                         "never: [0-9]*: reset_at_two")
        measure()
        self.lights(coverage="green   *100.0 % of lines, 100.0 % of toggles, 1 of 1 cover points")
        self.has('"reset_at_two"', file="build/regress/report.html")
        append("limits.toml", '"gone.v" = {}\n')
        self.assertIn("limits.toml: no file belongs to the gate gone.v", measure())

    def test_lights_mutants(self):
        def planted(**verdicts):
            results.write("build/mutants/planted.xml", [
                results.Mutant(f"small/{name}", verdict, "test_a", 1)
                for name, verdict in verdicts.items()])

        measured("mutants", "hdl")
        for verdict, state in (("caught", "green  2 of 2 caught"),
                               ("SURVIVED", "red   *1 of 2 not caught: small/two"),
                               ("caught", "green")):
            planted(one="caught", two=verdict)
            self.lights(mutants=state, tests="green")
        missed = "red   *1 modules with drawn mutants that proofs and tests miss: fifo"
        for verdict, state in ("SURVIVED", missed), ("caught", "green"):
            drawn = [results.Mutant(f"fifo/fifo.{i}", verdict if i == 0 else "caught",
                                    "formal.fifo", 1, "hdl/fifo.v:3",
                                    {"module": "fifo", "does": "inv"}) for i in range(8)]
            results.write("build/mutants/drawn.xml", drawn, seed="1", tree=tree_state(".", "hdl"))
            self.lights(mutants=state)
        write("hdl/new.v", "\n")  # the sources have changed since they were measured
        self.lights(mutants="grey   sources have changed since it was green")

    def test_lights_figures(self):
        """Figures of `make synth` and `./icesoc bench` can be within a limit, beyond it, or
        missing."""
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
        measure(size="grey   1 of 1 designs changed since: ./icesoc synth")
        size(41)
        measure(size="red   *1 beyond their limits: whole 41 [(]at most 40[)]", tests="green",
                speed="green")
        size(0, ["whole: synthesis failed"])
        speed(49)
        measure(size="red .*whole: synthesis failed",
                speed="red   *1 beyond their limits: whole 49 [(]at least 50[)]")


main(Cases)
