#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""ahead_test: checks that a model with inputs one step ahead (tools/icesoc/proof/ahead.py) behaves
like the original model: with and without retiming, each failing assertion fails exactly one step
later, and an assertion that holds does not fail.

Usage: ahead_test.py work-folder
"""
import os
import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

from icesoc.proof import ahead

# Flip-flops of two clocks, one with an asynchronous reset and one without an initial value.
MODULE = """module several (input clk_i, write_i, rst_i, input [1:0] d_i);
    reg [1:0] count = 0, held, copy = 2;
    reg       seen = 0;
    always @(posedge clk_i) begin
        count <= count + d_i;
        copy  <= held;
    end
    always @(posedge write_i) held <= d_i;
    always @(posedge clk_i or posedge rst_i)
        if (rst_i) seen <= 0;
        else if (count == 3) seen <= 1;
    always @* begin
        assume (d_i != 3);
        assert (copy != 2 || count != 3); // the following assertions fail
        assert (held != 1);
        assert (!(seen && count == 0));
        assert (!(copy == 1 && seen));
        assert (!(copy == 3 && held != 3)); // fails only because `held` has no initial value
        assert (!(rst_i && seen)); // holds
    end
endmodule
"""
CONVERT = """read_verilog -formal -sv several.v; prep -top several; clk2fflogic; dffunmap
chformal -early; setundef -anyseq -undriven; opt_clean; techmap; opt -fast -nosdff -nodffe
dfflegalize -cell $_DFF_P_ 01; delete -output w:*; abc -g AND -fast; opt_clean
write_aiger -zinit several.aig"""


def steps(model, commands):
    """Returns for each assertion the step in which it fails first, or None."""
    found = []
    for bad in model.bads:
        ahead.write(replace(model, bads=[bad]), Path("one.aig"))
        said = subprocess.run(
            ["yosys-abc", "-c", f"read_aiger one.aig; fold; {commands}strash; bmc3 -F 20"],
            text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=True).stdout
        step = re.search(r"asserted in frame (\d+)", said)
        found.append(int(step[1]) if step else None)
    return found


os.makedirs(sys.argv[1], exist_ok=True)
os.chdir(sys.argv[1])
Path("several.v").write_text(MODULE)
subprocess.run(["yosys", "-q", "-p", CONVERT.replace("\n", "; ")], check=True)
original = ahead.read(Path("several.aig"))
fails = steps(original, "")
later = [step if step is None else step + 1 for step in fails]
if fails.count(None) != 1 or len(fails) != 6:
    sys.exit(f"expected that 5 of 6 assertions fail, got {fails}")
for how in "", "retime -M 3 -f; ":
    got = steps(ahead.ahead(original), how)
    if got != later:
        sys.exit(f"'{how}': expected failures in the steps {later}, got {got}")
print(f"ahead: the assertions fail in the steps {fails}, and one step later ahead")
