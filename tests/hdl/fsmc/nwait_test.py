#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""nwait: checks that NWAIT does not glitch in the netlist of fsmc_bridge, with random delays
(nwait_bench.v). lint.crossings_* checks the other outputs to pins.

nwait_test.py SOURCE GENERATED OUTPUT [SEEDS OPERATIONS]
"""
import json
import pathlib
import re
import subprocess
import sys

from icesoc.synth import sources, synthesis, timing, utilisation

SOURCE = pathlib.Path(sys.argv[1])
HERE = pathlib.Path(__file__).parent
INPUTS = [f"I{n}" for n in range(6)]
# Replaces the primitives by their models, except for the LUTs with delays. Flip-flops start at 0.
SCRIPT = """
read_json @NETLIST@
read_verilog -lib <<EOT
module delay_lut #(parameter NUMBER = 0, INIT = 0) (input I0, I1, I2, I3, I4, I5, output O);
endmodule
EOT
read_verilog +/xilinx/cells_sim.v
hierarchy -check -top fsmc_bridge
proc
flatten
setundef -init -zero
setundef -undriven -zero
opt_clean
delete =A:whitebox =A:blackbox %u
write_verilog -noattr @OUTPUT@
"""


def pins(cell, output):
    return [(pin, bits) for pin, bits in cell["connections"].items()
            if (cell["port_directions"][pin] == "output") == output]


def cone_of(module, port):
    """Returns the LUTs between registers or pins and an output port."""
    driver = {bit: name for name, cell in module["cells"].items()
              for _, bits in pins(cell, True) for bit in bits}
    cone, bits = set(), list(module["ports"][port]["bits"])
    while bits:
        name = driver.get(bits.pop())
        if name is None or name in cone or not timing.is_combinational(
                module["cells"][name]["type"]):
            continue
        cone.add(name)
        bits += [bit for _, pin in pins(module["cells"][name], False) for bit in pin]
    return [name for name in sorted(cone) if module["cells"][name]["type"].startswith("LUT")]


def delay(module, names):
    """Replaces these LUTs by LUTs with delays."""
    for number, name in enumerate(names):
        cell = module["cells"][name]
        inputs = [cell["connections"].get(pin, ["0"]) for pin in INPUTS]
        size = 1 << int(cell["type"][3:])  # the table of a smaller LUT is repeated
        table = cell["parameters"]["INIT"].rjust(size, "0")[-size:] * (64 // size)
        module["cells"][name] = cell | {
            "type": "delay_lut",
            "parameters": {"NUMBER": f"{number:032b}", "INIT": table},
            "port_directions": dict.fromkeys(INPUTS, "input") | {"O": "output"},
            "connections": dict(zip(INPUTS, inputs)) | {"O": cell["connections"]["O"]}}


def bench(module, output):
    """Builds the bench with LUTs of the netlist that have delays; returns the program."""
    names = cone_of(module, "fsmc_nwait_n_o")
    if len(names) < 10:
        sys.exit(f"nwait: expected at least 10 LUTs that lead to NWAIT, got {len(names)}")
    print(f"{len(names)} LUTs lead to NWAIT")
    delay(module, names)
    delayed, flat, program = (output / f"nwait.{kind}" for kind in ("json", "v", "vvp"))
    delayed.write_text(json.dumps({"modules": {"fsmc_bridge": module}}))
    script = synthesis.filled(SCRIPT, {"NETLIST": delayed, "OUTPUT": flat})
    (output / "nwait.ys").write_text(script)
    subprocess.run(["yosys", "-q", "-s", output / "nwait.ys"], check=True)
    subprocess.run(["iverilog", "-g2012", "-s", "nwait_bench", "-o", program,
                    HERE / "nwait_bench.v", flat], check=True)
    return program


def main():
    generated, output = map(pathlib.Path, sys.argv[2:4])
    seeds, operations = map(int, sys.argv[4:6] or ("3", "100"))
    o = utilisation.options_of(["--source", str(SOURCE), "--generated", str(generated),
                                "--output", str(output)])
    library = utilisation.rtl_of(o)
    plan = sources.read_plan(library, SOURCE)
    design = next(design for design in plan.designs if design.name == "fsmc_bridge")
    run = synthesis.mapped(design, "xc6s", library,
                           synthesis.Options(SOURCE / "synth/yosys", output / "cache"))
    module = json.loads(run.netlist.read_text())["modules"]["fsmc_bridge"]
    program, faults = bench(module, output), []
    for seed in range(1, seeds + 1):
        text = subprocess.run(["vvp", "-n", program, f"+seed={seed}", f"+operations={operations}"],
                              text=True, stdout=subprocess.PIPE, check=True).stdout
        print(f"seed {seed}: {text.strip()}")
        result = re.search(r"(\d+) waits, (\d+) glitches, (\d+) late, (\d+) errors", text)
        if not result or int(result[1]) < operations / 4 or any(map(int, result.groups()[1:])):
            faults.append(f"seed {seed}: expected at least {operations // 4} waits, and 0 "
                          "glitches, late accesses and errors")
    for fault in faults:
        print(f"nwait: {fault}", file=sys.stderr)
    return int(bool(faults))


if __name__ == "__main__":
    sys.exit(main())
