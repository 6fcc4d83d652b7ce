#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""crossings: finds flip-flops that see another clock, or a pin, other than through hdl/cdc.

Usage: crossings.py TOP CLOCK SOURCE GENERATED WORK PARAMETERS [SYNCHRONOUS-INPUT...]

Yosys flattens TOP but for the modules of hdl/cdc, with its commands PARAMETERS before. A register
of CLOCK may see registers of CLOCK, the inputs named and outputs of hdl/cdc for that clock. A
register whose clock is a pin may see pins (they come with it) and its own kind. Asynchronous resets
are no data. Exit status 1: a crossing goes round hdl/cdc; each is told.
"""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

CLOCKS = {"clk_i", "dst_clk_i", "src_clk_i", "read_clk_i", "write_clk_i"}
OF_WRITER = {"full_o", "push_i", "data_i"}
NO_DATA = {"CLK", "ARST", "ALOAD", "RD_CLK", "WR_CLK"}


def cdc_clock(kind, port, connections):
    """The net of the clock that a port of an hdl/cdc module belongs to; None: of none."""
    if "async" in port or port in CLOCKS:
        return None
    if kind == "async_fifo":
        return connections["write_clk_i" if port in OF_WRITER else "read_clk_i"][0]
    for prefix in ("src", "dst"):
        if port.startswith(prefix + "_"):
            return connections[prefix + "_clk_i"][0]
    return connections["clk_i" if "clk_i" in connections else "dst_clk_i"][0]


def flattened(top, source, generated, work, parameters):
    """Returns the module TOP as Yosys' JSON has it."""
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


def main():
    top, clock, source, generated, work, parameters, *synchronous = sys.argv[1:]
    module = flattened(top, Path(source), Path(generated), work, parameters)
    names = {}
    for name, net in module["netnames"].items():
        for bit in net["bits"]:
            if bit not in names or len(name) < len(names[bit]):
                names[bit] = name
    source, comb, sinks = {}, {}, []  # of a net: its clock; what it depends on; (name, clock, nets)
    pins = {}
    for name, port in module["ports"].items():
        for bit in port["bits"] if port["direction"] == "input" else []:
            pins[bit] = name
            source[bit] = "pin"
    main_clock = module["ports"][clock]["bits"][0]
    for name in synchronous:
        for bit in module["ports"][name]["bits"]:
            source[bit] = main_clock
    for name, cell in module["cells"].items():
        kind, nets, way = cell["type"], cell["connections"], cell["port_directions"]
        ins = {p for p in nets if way[p] == "input"}
        outs = {p for p in nets if way[p] == "output"}
        found = re.search(r"\b(cdc_[a-z]+|async_fifo)\b", kind)
        if found:
            for port in nets:
                of = cdc_clock(found[1], port, nets)
                if port in ins and of is not None:
                    sinks.append((name + "." + port, of, nets[port]))
                for bit in nets[port] if port in outs else []:
                    source[bit] = of if of is not None else "unsynchronised"
        elif kind.startswith("$mem") or "CLK" in nets:
            own = (nets.get("CLK") or nets["WR_CLK"] or ["x"])[0]  # a ROM has none
            data = [b for p in ins - NO_DATA - {"RD_ADDR"} for b in nets[p]]
            sinks.append((name, own, data))
            for bit in nets.get("Q", nets.get("RD_DATA", [])):
                if "RD_ADDR" in nets:
                    comb[bit] = nets["RD_ADDR"] + ([("state", own)] if own != "x" else [])
                else:
                    source[bit] = own
        else:
            needs = [b for p in ins for b in nets[p]]
            for port in outs:
                for bit in nets[port]:
                    comb[bit] = needs
    seen, visited = {}, set()

    def origins(bit):
        """Returns the registers and pins that a net depends on: {clock: one of them}; each net is
        visited once."""
        stack = [bit]
        while stack:
            b = stack[-1]
            if b in seen:
                stack.pop()
            elif isinstance(b, tuple):
                seen[b] = {b[1]: "a memory"}
            elif b in source:
                seen[b] = {source[b]: names.get(b, "?")}
            elif b not in comb:
                seen[b] = {}
            else:
                new = [n for n in comb[b] if n not in seen and n not in visited]
                later = [] if b in visited else new
                visited.add(b)
                if later:
                    stack += later
                else:
                    seen[b] = {of: via for n in comb[b] for of, via in seen.get(n, {}).items()}
        return seen[bit]

    bad = set()
    for name, own, data in sinks:
        if not isinstance(own, int):
            continue
        for bit in data:
            for of, through in origins(bit).items():
                if of == own or (of == "pin" and own in pins and own != main_clock):
                    continue
                what = names.get(of, of) if isinstance(of, int) else of
                bad.add(f"{top}: {name} ({names.get(own, own)}) sees {through} ({what})")
    for line in sorted(bad):
        print(line)
    if not sinks:
        print(f"{top}: no register at all")
    sys.exit(1 if bad or not sinks else 0)


main()
