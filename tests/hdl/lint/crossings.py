#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""crossings: finds flip-flops that depend on another clock or on a pin, other than through hdl/cdc,
and outputs to pins that may glitch.

Usage: crossings.py TOP CLOCK SOURCE GENERATED WORK PARAMETERS [SYNCHRONOUS-INPUT...]

Yosys runs the commands PARAMETERS, then flattens TOP, but keeps the modules of hdl/cdc. A register
of CLOCK may depend on registers of CLOCK, on the listed inputs, and on outputs of hdl/cdc for
CLOCK. A register that a pin clocks may depend on pins, because they change together with this pin,
and on registers that a pin clocks. Asynchronous resets do not count as data. An output to a pin
must be driven by a flip-flop, or depend on pins only; SAMPLED lists the exceptions. Exit status 1
means that a crossing bypasses hdl/cdc, or that an output may glitch; each of them is listed.
"""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

CLOCKS = {"clk_i", "dst_clk_i", "src_clk_i", "read_clk_i", "write_clk_i"}
OF_WRITER = {"full_o", "push_i", "data_i"}
PIN = re.compile(r"fsmc_.*_o|modem_.*_o|core_pins_o|irq_o")
# The processor samples fsmc_d_o only 4 HCLK after NWAIT. formal.fsmc_bridge and
# tests/hdl/fsmc/nwait_test.py show that fsmc_nwait_n_o does not glitch.
SAMPLED = {"fsmc_d_o", "fsmc_nwait_n_o"}
NO_DATA = {"CLK", "ARST", "ALOAD", "RD_CLK", "WR_CLK"}


def cdc_clock(kind, port, connections):
    """Returns the net of the clock to which a port of an hdl/cdc module belongs; None if it belongs
    to no clock."""
    if "async" in port or port in CLOCKS:
        return None
    if kind == "async_fifo":
        return connections["write_clk_i" if port in OF_WRITER else "read_clk_i"][0]
    for prefix in ("src", "dst"):
        if port.startswith(prefix + "_"):
            return connections[prefix + "_clk_i"][0]
    return connections["clk_i" if "clk_i" in connections else "dst_clk_i"][0]


def flattened(top, source, generated, work, parameters):
    """Returns the flattened module TOP from the JSON that Yosys writes."""
    hdl = [source / "hdl" / part for part in ("fsmc", "ddr", "modem", "system", "cdc", "")]
    folders = [generated, *(source / "ip").glob("*/"), source / "bus", *hdl, source / "synth"]
    file = next(f / (top + ".v") for f in folders if (f / (top + ".v")).is_file())
    os.makedirs(work, exist_ok=True)
    netlist = f"{work}/{top}.json"
    includes = (generated, source / "bus", source / "hdl/ddr", source / "hdl/system")
    script = f"""verilog_defaults -add {' '.join(f'-I{folder}' for folder in includes)}
        read_verilog {file}
        {parameters} hierarchy -top {top} {' '.join(f'-libdir {folder}' for folder in folders)}
        proc; setattr -mod -set keep_hierarchy 1 cdc_* *cdc_* *async_fifo*
        flatten; opt_clean; memory -nomap; opt_clean
        write_json {netlist}"""
    run = subprocess.run(["yosys", "-q", "-p", script], capture_output=True, text=True)
    if run.returncode:
        print(run.stdout + run.stderr)
        sys.exit(2)
    with open(netlist) as read:
        return json.load(read)["modules"][top]


def names_of(module):
    """Returns the shortest name of each net."""
    names = {}
    for name, net in module["netnames"].items():
        for bit in net["bits"]:
            if bit not in names or len(name) < len(names[bit]):
                names[bit] = name
    return names


class Nets:
    """The connections of a module's nets. clock: the clock of each net; comb: the nets on which
    each net depends combinationally; sinks: (name, clock, nets) of each register and of each input
    of a module of hdl/cdc."""

    def __init__(self, module, main_clock, synchronous):
        self.names, self.clock, self.comb, self.sinks = names_of(module), {}, {}, []
        self.seen, self.visited, self.inverted = {}, set(), {}
        ports = module["ports"].values()
        self.pins = {b for port in ports if port["direction"] == "input" for b in port["bits"]}
        self.clock = dict.fromkeys(self.pins, "pin")
        for name in synchronous:
            self.clock.update(dict.fromkeys(module["ports"][name]["bits"], main_clock))
        for name, cell in module["cells"].items():
            nets, way = cell["connections"], cell["port_directions"]
            ins = {p for p in nets if way[p] == "input"}
            found = re.search(r"\b(cdc_[a-z]+|async_fifo)\b", cell["type"])
            if found:
                self.add_crossing(name, found[1], nets, ins)
            elif cell["type"].startswith("$mem") or "CLK" in nets:
                self.add_register(name, nets, ins)
            else:
                needs = [b for p in ins for b in nets[p]]
                outs = [b for p in nets if way[p] == "output" for b in nets[p]]
                self.comb.update(dict.fromkeys(outs, needs))
                if cell["type"] == "$not":
                    self.inverted.update(zip(outs, needs))

    def add_crossing(self, name, kind, nets, ins):
        """Adds an instance of a module of hdl/cdc."""
        for port in nets:
            of = cdc_clock(kind, port, nets)
            if port not in ins:
                own = of if of is not None else "unsynchronised"
                self.clock.update(dict.fromkeys(nets[port], own))
            elif of is not None:
                self.sinks.append((name + "." + port, of, nets[port]))

    def add_register(self, name, nets, ins):
        """Adds a register or a memory."""
        # a ROM has no clock; its clock is "x"
        own = (nets.get("CLK") or nets["WR_CLK"] or ["x"])[0]
        self.sinks.append((name, own, [b for p in ins - NO_DATA - {"RD_ADDR"} for b in nets[p]]))
        for bit in nets.get("Q", nets.get("RD_DATA", [])):
            if "RD_ADDR" in nets:
                self.comb[bit] = nets["RD_ADDR"] + ([("state", own)] if own != "x" else [])
            else:
                self.clock[bit] = own

    def origins(self, bit):
        """Returns the registers and pins on which a net depends, as a dictionary with one register
        or pin per clock. Visits each net once."""
        seen, stack = self.seen, [bit]
        while stack:
            b = stack[-1]
            if b in seen:
                stack.pop()
            elif isinstance(b, tuple):
                seen[b] = {b[1]: "a memory"}
            elif b in self.clock:
                seen[b] = {self.clock[b]: self.names.get(b, "?")}
            else:
                needs = self.comb.get(b, [])
                new = [n for n in needs if n not in seen and n not in self.visited]
                if new and b not in self.visited:
                    stack += new
                else:
                    seen[b] = {of: via for n in needs for of, via in seen.get(n, {}).items()}
                self.visited.add(b)
        return seen[bit]

    def glitches(self, ports):
        """Returns the outputs to pins that may glitch. An output cannot glitch if a flip-flop
        drives it, or if it depends on pins only. A block without the pins of the FSMC is inside the
        chip, so its outputs are not pins."""
        bad = set()
        if "fsmc_a_i" not in ports:
            return bad
        for name in filter(PIN.fullmatch, ports.keys() - SAMPLED):
            for bit in ports[name]["bits"]:
                bit = self.inverted.get(bit, bit)
                if isinstance(bit, int) and bit not in self.clock and \
                        self.origins(bit).keys() - {"pin"}:
                    bad.add(f"{name}: expected a flip-flop at the pin, got logic of "
                            f"{', '.join(sorted(map(str, self.origins(bit).values())))}; it may "
                            "glitch")
        return bad

    def bad(self, main_clock):
        """Returns the sinks that depend on a source that is not allowed."""
        return {
            f"{name} ({self.names.get(own, own)}) sees {through} ({self.names.get(of, of)})"
            for name, own, data in self.sinks
            if isinstance(own, int)
            for bit in data
            for of, through in self.origins(bit).items()
            if of != own and not (of == "pin" and own in self.pins and own != main_clock)
        }


def main():
    top, clock, source, generated, work, parameters, *synchronous = sys.argv[1:]
    module = flattened(top, Path(source), Path(generated), work, parameters)
    main_clock = module["ports"][clock]["bits"][0]
    nets = Nets(module, main_clock, synchronous)
    bad = sorted(nets.bad(main_clock)) if nets.sinks else ["no register at all"]
    bad += sorted(nets.glitches(module["ports"]))
    for line in bad:
        print(f"{top}: {line}")
    sys.exit(1 if bad else 0)


main()
