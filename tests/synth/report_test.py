#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""report_test: runs the command `utilisation` on a small project, like a user. parts_test.py tests
the parts of the command. The case `counts` stores its netlists in a folder; the other cases begin
with this folder.

Usage: report_test.py case utilisation-program work-folder kept-folder
"""
import contextlib
import json
import os
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

from icesoc.util.browser import elements, fault
from script import TREE, Script, append, commit, edit, fresh, git, main, repository, write

CASE, PROGRAM, KEPT = sys.argv[1], Path(sys.argv[2]).resolve(), Path(sys.argv[4]).resolve()
BLOCKS = Path("project/hdl/blocks")
SLOW = """#!/bin/sh
[ "$1" = -V ] || for _ in $(seq 200); do
    ! grep -q 'waiting for another run' second || break
    sleep 0.1
done
exec yosys "$@"
"""
MADE = """cmake_minimum_required(VERSION 3.25)
project(small NONE)
add_custom_target(synth_inputs COMMAND ${CMAKE_COMMAND} -E make_directory gen)
"""
DEEP = """module deep (input clk_i, write_i, input [3:0] at_i, from_i, input [31:0] i,
             output reg [31:0] o);
    (* ram_style = "block" *) reg [31:0] words [0:15];
    always @(posedge clk_i) begin
        if (write_i) words[at_i] <= i;
        o <= words[from_i];
    end
endmodule
"""
# A module with a register after the adder of a multiplier; the upper bits of the register repeat
# the sign.
SCALED = """module scaled (input clk_i, en_i, input signed [17:0] a_i, input signed [15:0] b_i,
               input signed [33:0] c_i, output reg signed [37:0] o);
    reg signed [33:0] product;
    reg signed [37:0] before;
    always @(posedge clk_i) if (en_i) begin
        product <= a_i * b_i;
        before  <= c_i;
        o       <= before + product;
    end
endmodule
"""


def grow(folder):
    """Adds twelve flip-flops to a design."""
    edit(folder / "pair.v", "    wire [5:0] word;", "    wire [5:0] word;\n    reg [11:0] extra;")
    edit(folder / "pair.v", "        data_o <= word",
         "        extra <= {extra[5:0], word};\n        data_o <= extra[11:6] ^ word")


class Cases(Script):
    def setUp(self):
        # File names must be relative, because a design is identified by them.
        fresh(sys.argv[3])
        shutil.copytree(TREE / "tests/synth/project", "project")
        for folder in "bus", "ip":
            write(f"project/{folder}/none", "")
        for folder in "yosys", "primitives":
            shutil.copytree(TREE / "synth" / folder, f"project/synth/{folder}")
        Path("gen").mkdir()
        Path("out").mkdir()
        if CASE != "counts":
            shutil.copytree(KEPT, "out/cache")

    files = ""  # Verilog files of cores

    def run_program(self, *options, status=0):
        self.ask(PROGRAM, "--source", "project", "--generated", "gen", "--output", "out",
                 "--files", self.files, *options, status=status)

    def users_tree(self):
        """Turns the project into a tree in which commands of make can run."""
        for folder in "build/main/synth", "build/synth":
            Path("project", folder).mkdir(parents=True)
        tool = Path("project/build/main/synth/utilisation")
        write(tool, f"#!/bin/sh\nexec '{PROGRAM}' --files '' \"$@\"\n")
        tool.chmod(0o755)
        Path("gen").rename("project/build/main/gen")
        Path("out/cache").rename("project/build/synth/cache")

    def made(self, *words, status=0):
        """Runs make in the project, like a user."""
        self.make(*words, tree="project", build="build/main", status=status)

    def test_counts(self):
        """The figures must agree with the sources of the blocks, and with Yosys' own `stat`."""
        # A package must be read before the module that uses it, and does not count as a design.
        write("gen/typed_sizes.sv", "package typed_sizes; typedef logic [2:0] t; endpackage\n")
        write("gen/typed.sv", "module typed(input logic clk_i, input typed_sizes::t d_i, output "
              "typed_sizes::t q_o); always_ff @(posedge clk_i) q_o <= d_i; endmodule\n")
        self.files = ";".join(str(Path(file).resolve()) for file in (
            BLOCKS / "store.v", "gen/typed_sizes.sv", "gen/typed.sv"))
        write("gen/clocks.v", """module clocks (input clk_i, output pll_o, output reg q_o);
            wire clk;
            PLL_BASE u_pll (.CLKIN(clk_i), .CLKOUT0(pll_o)); // in Yosys' second library
            BUFG u_buffer (.I(pll_o), .O(clk)); // in the first library, but not used by the mapping
            always @(posedge clk) q_o <= !q_o;
            endmodule\n""")
        # Yosys infers a memory here, although no array is declared.
        cases = " ".join(f"{n}: o <= {n * n % 509};" for n in range(1024))
        write("gen/squares.v", "module squares (input clk_i, input [9:0] n_i, output reg [8:0] o); "
              f"always @(posedge clk_i) case (n_i) {cases} endcase endmodule\n")
        edit("project/synth/designs.json", '"designs"', '"xilinx": ["clocks"], "designs"')
        self.run_program("--family", "ecp5", "--design", "clocks")
        self.run_program()
        # A checkout of the same sources in another folder must have the same netlists.
        self.lacks(str(Path.cwd()), file=next(Path("out/cache").glob("store.xc6s.*.ys")))
        # The generated Verilog must not contain this path either, because its hash identifies
        # accepted figures.
        for file in (PROGRAM.parents[1] / "gen").glob("*.v"):
            self.lacks(re.escape(f"{TREE}/"), file=file)
        # The clock and the LUTs are shown with their ranges over all mappings of the design.
        self.has(r"^wide .* [0-9.]+ \([0-9.]*-[0-9.]*\) +[0-9]+-[0-9]+$",
                 r"nine of ten of [0-9]+ published reports of map, of [0-9]+ of TRCE",
                 r"^wide +[0-9]+ \([0-9]*-[0-9]*\) ")

        def figures(design):
            return json.loads(next(Path("out/cache").glob(f"{design}.xc6s.*.figures")).read_text())

        self.assertEqual(figures("clocks")["cells"], {"BUFG": 1, "FDRE": 1, "INV": 1,
                                                      "PLL_BASE": 1})
        self.assertEqual(figures("typed")["cells"], {"FDRE": 3})
        self.assertEqual(figures("squares")["cells"], {"RAMB8BWER": 1})
        self.lacks("^typed_sizes ")
        self.assertEqual(figures("wide")["cells"]["CARRY4"], 4, "a counter of 16 bits")
        store, whole = figures("store"), figures("whole")
        self.assertEqual((store["cells"]["RAM32M"], store["lutRam"]), (1, 4), "32 x 6 bits")
        self.assertEqual(whole["costs"]["u_counter"]["count_o"][2], 5)
        self.assertEqual(whole["costs"]["u_store"]["words"][:3], [4, 4, 0])
        self.ask("yosys", "-p", f"read_verilog {BLOCKS}/*.v; synth_xilinx -family xc6s -flatten "
                 "-noiopad -noclkbuf -top pair; tee -q -o stat stat")
        cells = re.findall(r"^ +(?:(LUT\d|INV) +(\d+)|(\d+) +\S+ +(LUT\d|INV))$",
                           Path("stat").read_text(), re.M)
        sites = 4  # number of LUTs that are used as RAM
        self.assertEqual(whole["lut"], sites + sum(int(row[1] or row[2]) for row in cells))
        # In the accepted chip, the cost of a core includes its slot in the decoder. The cost of a
        # slot is the difference between a decoder for three slots and one for two.
        shutil.copy(TREE / "bus/bus_decoder.v", "project/bus")
        write("gen/map.regs.json", json.dumps({
            "block": "map", "doc": "", "registers": [], "constants": [
                {"name": "SLOT_LOW", "value": 2, "doc": ""},
                {"name": "SLOT_COUNT", "value": 3, "doc": ""}]}))
        write("project/synth/baseline.json", json.dumps({"yosys": "", "designs": {"soc": {
            "lut": 9, "ff": 9, "slices": 9, "carry": 0, "dsp": 2, "ram": 1.5, "mhz": 99,
            "signals": {"u_low": {"sum": [7, 8, 1.5, 2]}}}}}))
        self.run_program("--core", "low")
        # A slot costs LUTs for 32 bits of read data, and flip-flops for a select and four address
        # bits.
        self.has(r"^low +[1-9]\d +13 +1.5 +2 +7 / 8 +[1-9]\d* / 5$",
                 "^The chip: 9 LUT, 9 FF, 1.5 block RAMs, 2 DSP")
        self.run_program("--core", "high")
        self.has("high is not in the chip of synth/baseline.json: add the line 'high' to "
                 "ip/cores.list, then run ./icesoc core synth high --chip")
        shutil.rmtree(KEPT, ignore_errors=True)
        shutil.copytree("out/cache", KEPT)

    def test_growth(self):
        """An additional register makes the check fail and is named. After --accept the
        check passes, with results from the cache."""
        self.run_program("--accept")
        self.run_program()
        self.lacks(r"^\[")
        grow(BLOCKS)
        self.run_program(status=None)
        self.has("FAILED whole:", "extra +.*FF")
        self.assertEqual(len(re.findall(r"^\[", self.said, re.M)), 1, "more than what has changed")
        self.run_program("--accept")
        self.run_program()

    def test_partial(self):
        """A single design can be reported while others have changed. Limits also apply to accepted
        figures."""
        self.run_program()
        edit(BLOCKS / "pair.v", "    wire [5:0] word;",
             "    wire [5:0] word;\n    wire unused = 1;")
        self.run_program("--design", "store")
        self.lacks("^wide ")
        self.has("^Designs: 2 measured now, 1 changed since")
        self.has('"whole": "changed since"', '"name": "wide lut"', file="out/report.json")
        # In a fresh clone, designs that have not been measured do not count as removed.
        self.run_program("--accept")
        shutil.rmtree("out/cache")
        self.run_program("--design", "store")
        self.has("^Designs: 1 measured now, 2 as accepted")
        append(BLOCKS / "counter.v", "// changed\n")
        write(BLOCKS / "fresh.v", "module fresh(input wire a_i); endmodule\n")
        self.run_program("--design", "store")
        self.has("^Designs: 1 measured now, 2 changed since, 1 never measured here")
        edit("project/synth/designs.json", '"lut": 40', '"lut": 1')
        self.run_program("--accept", status=None)
        self.has("above the limit of 1, so no figures were accepted")

    def test_broken(self):
        write(BLOCKS / "broken.v", "module broken(input wire a_i); assign b = ; endmodule\n")
        write("gen/typed.sv", "module typed(input logic a_i); assign b = ; endmodule\n")
        self.files = "gen/typed.sv"
        self.run_program(status=None)
        self.has("broken.v:1: ERROR: syntax error", "^wide ", "^broken .*failed",
                 "typed.sv:1: ERROR: syntax error.*\n.*needs what sv2v makes of it")
        self.has('"broken: synthesis failed"', file="out/report.json")
        # a file in the state in which a merge with conflicts leaves it
        for name in "baseline", "designs":
            write(f"project/synth/{name}.json", "{\n<<<<<<< HEAD\n")
            self.run_program(status=None)
            self.has(f"^utilisation: project/synth/{name}.json: .*line 2")

    def test_twice(self):
        """In the first run, Yosys starts when the second run is waiting, or after 20 s."""
        write("slow", SLOW)
        shutil.rmtree("out")
        words = (PROGRAM, "--source", "project", "--generated", "gen", "--output", "out",
                 "--files", "", "--design", "wide", "--yosys", Path("slow").resolve())
        with open("first", "w") as first, open("second", "w") as second:
            begun = subprocess.Popen(words, stdout=first, stderr=first)
            # waits until the first run has locked the folder
            while not Path("out/cache").exists() and begun.poll() is None:
                time.sleep(0.1)
            waited = subprocess.run(words, stdout=second, stderr=second)
        self.assertEqual((begun.wait(), waited.returncode), (0, 0))
        self.has("waiting for another run in out", file="second")
        self.has(r"^\[", file="first")
        self.lacks(r"^\[", file="second")

    def dump(self, page):
        """Returns the elements of the page after its scripts have run."""
        return elements(f"{Path(page).resolve().as_uri()}#whole/u_store", width=1440, height=900)

    def test_page(self):
        self.run_program("--family", "ecp5")
        page = Path("out/report.html")
        text = page.read_text()
        self.assertLess(len(text), 2_000_000)
        self.lacks('(src|href)="?https?:', file=page)
        # If the libraries could not be downloaded, the page is still complete and explains how to
        # get them.
        write("plain.html", "\n".join(line for line in text.split("\n") if not re.search(
            "^!function.*Tabulator=|^.*var uPlot=", line)))
        seen = re.search('<p class="soft">.*?(?=<script id)', self.dump("plain.html"), re.S)[0]
        self.said = re.sub(r"\s+", " ", re.sub("<[^>]*>", " ", seen))
        self.has("Tabulator and uPlot could not be downloaded")
        self.lacks("NaN|undefined")
        self.has(r"after routing: [0-9]+ to [0-9]+ MHz; nine of ten published designs \(of "
                 r"[0-9]+\) are in this range",
                 r" flip-flops 11 .* 50 \(0.3 %\) .* wide 1 .* store \d+ .* share of LUTs "
                 r"0.2 %, slices \d+ to \d+, .* ecp5 LUT \d+, ecp5 FF \d+ .* pair 15 .* "
                 r"u_store .* read_addr_i 5 0 project/hdl/blocks/store.v:12 .* clk_i 11 12 [0-9.]+ "
                 r"project/hdl/blocks/pair.v:8 .* rst_i synchronous 5 project/hdl/blocks/pair.v:9 ")
        self.has(r" 8 to 8.5 ns left of 10 1 .* u_counter.count_o.4. 9 FDRE "
                 r"project/hdl/blocks/counter.v:13 .* now 15 11 7 [0-9.]+ this run ")
        if not (PROGRAM.parents[1] / "page/libraries.js").stat().st_size:
            self.skipTest("Tabulator and uPlot could not be fetched")
        # A second script clicks like a user, and writes out the elements that are then visible.
        clicks = (TREE / "tests/synth/clicks.js").read_text()
        write("clicked.html", text.replace(
            "</body>", f'<p id="seen"></p><script>{clicks}</script></body>'))
        self.said = self.dump("clicked.html").split('<p id="seen">')[-1]
        for part in (
                "at first Signals of u_store, u_store; first Within all budgets; chip 5 15 LUT0.2 "
                "% of 9112", "folders whole,hdl/blocks, 2 modules; opened whole,hdl/blocks, 2 "
                "modules,wide,store at hdl/blocks; sorted whole,hdl/blocks, 2 modules,store,wide;",
                "sorted hdl/blocks, 2 modules,wide,store,whole; picked 1 Inside whole: ",
                "tree pair u_storestore u_countercounter; here Signals of u_store;",
                "paths 1; step project/hdl/blocks/[a-z]*.v:1[23]; on the way to x,y,y,z; "
                r"slow Longest paths, at 104.5 MHz; clock ([0-9.]+) Longest paths, at \1 MHz, "
                # parts_test.py checks these texts in detail
                r"by [1-9]\d*; wider 0; rounded 104.5,104.4,104.0; "
                r"slack [0-9.]+ to [0-9.]+ ns left of 10 [1-9]\d* ; "
                "history now  this run 15 11 7;"):
            self.has(part)
        self.assertEqual(fault(page), "")
        self.has('"peer": 100', file="out/report.json")

    def test_compare(self):
        """Shows the differences from another commit, or between two commits, as Markdown."""
        self.users_tree()
        here = Path("project").resolve()
        write(here / "CMakeLists.txt", MADE)
        write(here / ".gitignore", "build\n")
        registers = {"block": "pair", "doc": "", "type": "0x0007", "version": "0x0100",
                     "registers": [{"name": "MODE", "word": 3, "access": "rw", "doc": ""}]}
        write(here / "hdl/blocks/pair.regs.json", json.dumps(registers))
        with contextlib.chdir(here):
            repository()
            commit("The first one")
        self.ask(PROGRAM, "--files", "", cwd=here)
        self.made("synth", "BASE=HEAD..")
        self.has("^No figure of any design differs", "^no breaking change")
        designs = here / "synth/designs.json"
        edit(designs, '"WIDTH": 16', '"WIDTH": 17')
        edit(designs, '"name": "wide"', '"name": "wider"')
        grow(here / "hdl/blocks")
        self.ask(PROGRAM, "--files", "", cwd=here)
        self.made("synth", "BASE=HEAD..")
        grown = r"^\| whole \| .* \| \d+ -> \d+ \(\+12\) \|"
        # If the measured files were not committed, the state of a measurement is unknown.
        self.has(r"^Utilisation since .* \(The first one\):", grown, r"^\| wide \| gone \| gone \|",
                 r"^\| wider \| \d+ \(new\) \|", r"^\| \w+\+ \| not measured \|")
        self.has(r"^\| wider ", file=here / "build/summary.md")
        # If a design has grown by more than allowed, the difference is printed and the exit status
        # is not 0.
        kept = designs.read_text()
        edit(designs, '"ff": 30', '"ff": 20')
        self.made("synth", "BASE=HEAD", status=None)
        self.has("^FAILED whole", grown)
        write(designs, kept)
        # The comparison between two commits gives the same result, whatever is checked out.
        write(here / "hdl/blocks/pair.regs.json", json.dumps({**registers, "registers": []}))
        with contextlib.chdir(here):
            commit("The second one")
            names = [git("describe --always --abbrev=10", name) for name in ("HEAD", "HEAD~1")]
        write(here / "build/regress/history.jsonl", "".join(
            json.dumps({"commit": name, "passed": len(ends), "failed": 1,
                        "ends": [[f"test_{end[0]}.X", end[1]] for end in ends]}) + "\n"
            for name, ends in ((names[0], ["ap"]), (names[0], ["af", "bp", "cp", "ep"]),
                               (names[1], ["ap", "bf", "dp", "ep"]))))
        write(here / "hdl/blocks/pair.v", "module pair\n")
        (here / "build/synth/report.json").unlink()
        self.made("synth", "BASE=HEAD~1..HEAD")
        self.has(r"^Utilisation since .* \(The first one\), at .* \(The second one\):", grown,
                 r"^\| \w+ \| 4 passed, 1 failed \|",
                 "^breaking   pair: MODE .word 3. is gone$", "^Tests that fail now: test_a.X$",
                 "^Tests that pass again: test_b.X$", "^Tests that are new: test_c.X$",
                 "^Tests that did not run: test_d.X$")
        for wrong in "nonsense", "HEAD..nonsense":
            self.made("synth", f"BASE={wrong}", status=None)
            self.has("unknown commit BASE=nonsense")

    def test_made(self):
        self.users_tree()
        self.made("synth-accept", "DESIGN=store")
        self.made("synth", "DESIGN=store")
        self.lacks("^wide ")
        self.made("synth", "FAMILY=none", status=None)
        self.has("'none'.*choose from")
        write("project/build/main/CMakeCache.txt", "KNOWN_CORES:INTERNAL=store\n")
        self.made("ip-synth", "IP=missing", status=None)
        self.has("expected the name of a core, got 'missing'; known: store")

    def test_equivalent(self):
        """A netlist is proven equivalent to its RTL only once. The proof of a netlist with a fault
        fails."""
        for name, text in ("scaled", SCALED), ("deep", DEEP):
            write(BLOCKS / f"{name}.v", text)
        self.run_program("--equivalent")
        for name in "store", "whole", "wide", "scaled", "deep":
            self.has(rf"(?m)^{name} +proven")
        self.run_program("--equivalent", "--design", "deep", "--family", "ecp5")
        for proof in Path("out/cache").glob("*.miter*"):
            proof.unlink()
        self.run_program("--equivalent")
        self.has("(?m)^whole +proven")
        self.assertEqual(list(Path("out/cache").glob("*.miter*")), [], "proven again")
        proof, = Path("out/cache").glob("whole.xc6s.*.proof")
        file = proof.with_name(proof.name.rsplit(".", 2)[0] + ".json")
        good = file.read_text()
        # If the netlist for a simulator has not changed, it and the files that were made from it
        # are kept.
        for age in 100, None:
            self.run_program("--netlist", "whole", "--to", "out/sim/whole.v")
            if age:
                os.utime("out/sim/whole.v", (age, age))
        self.assertEqual(Path("out/sim/whole.v").stat().st_mtime, 100)
        # From this file, Ninja knows on which sources the netlist depends.
        self.has(rf"^{Path.cwd()}/out/sim/whole.v: .*/blocks/counter.v .*/blocks/store.v",
                 file="out/sim/whole.d")

        def function(cells):
            cell = next(cell for cell in cells if cell["type"] == "LUT2")
            cell["parameters"]["INIT"] = cell["parameters"]["INIT"].translate({48: 49, 49: 48})

        def enable(cells):
            cell = next(cell for cell in cells if cell["type"] == "FDRE" and
                        cell["connections"]["CE"] != ["1"])
            cell["connections"]["CE"] = ["1"]

        def pins(cells):
            pins = next(cell for cell in cells if cell["type"] == "RAM32M")["connections"]
            pins["DIA"].reverse()

        for fault in function, enable, pins:
            netlist = json.loads(good)
            (module,) = netlist["modules"].values()
            fault(module["cells"].values())
            write(file, json.dumps(netlist))
            self.run_program("--equivalent", "--design", "whole", status=1)
            self.has("(?m)^whole +differs after")

    def test_edif(self):
        """The netlist for ISE must contain each cell that Yosys counts exactly once, and its
        parentheses must be balanced."""
        self.users_tree()
        self.made("synth-edif", "DESIGN=whole")
        ise = Path("project/build/synth/ise")
        edif, cells = (ise / "whole.edf").read_text(), (ise / "whole.json").read_text()
        self.assertEqual(edif.count("("), edif.count(")"))
        for cell in "RAM32M", "CARRY4", "FDRE":
            inside = edif.count(f"(cellRef {cell} ")
            self.assertEqual(inside, cells.count(f'"type": "{cell}"'), cell)
            self.assertTrue(inside, cell)
        self.has(r"\(design (pair|whole)", file=ise / "whole.edf")
        self.assertTrue((ise / "verilog/store.v").exists(), "the Verilog for XST")
        # If a primitive exists in two forms, and only one form has some bits of a port, the port is
        # connected bit by bit.
        write("project/hdl/blocks/deep.v", DEEP)
        self.made("synth-edif", "DESIGN=deep")
        self.has("cellRef RAMB8BWER", file=ise / "deep.edf")
        self.lacks(r"\(member [A-Za-z0-9_]* -", file=ise / "deep.edf")


main(Cases)
