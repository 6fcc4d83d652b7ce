#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""cost: what a core costs in the chip, its share of decoder and memory port included: make ip-synth IP=fir.

    cost.py BASELINE.json MAP.regs.json CORE...

Adds up the LUTs and flip-flops that the netlist of the whole chip has by instance: the accepted one (synth/baseline.json),
or with CHIP=1 that of the chip as it is listed now. The decoder's are shared equally by the slots, the arbiter's by the memory ports. Logic that two instances share is counted
at one of them.
"""
import json
import re
import sys


def costs(signals, pattern):
    """LUTs and flip-flops of the instances whose path fits."""
    found = [c for path, of in signals.items() if re.fullmatch(pattern, path) for c in of.values()]
    return [sum(lut for lut, _ in found), sum(ff for _, ff in found)]


def parts_of(core, signals, constants):
    """Rows: what, LUTs, flip-flops."""
    whole, wrapper = (costs(signals, p) for p in (rf"u_{core}(\..*)?", rf"u_{core}\.u_(wrapper|registers|bus)(\..*)?"))
    slots, ports = constants["SLOT_COUNT"], constants["NPI_PORT_COUNT"]
    rows = [("the core", *(a - b for a, b in zip(whole, wrapper)))]
    if any(wrapper):  # of one file in VHDL nothing is apart
        rows.append(("its registers", *wrapper))
    rows.append((f"decoder, one of {slots} slots", *(c / slots for c in costs(signals, "u_bus_decoder"))))
    port = constants.get(f"NPI_PORT_{core.upper()}")
    if port is not None:
        rows.append((f"memory port {port}", *costs(signals, rf"u_memory\.u_arbiter\.g_port\[{port}\].*")))
        shared = costs(signals, r"u_memory(?!\.u_arbiter\.g_port\[).*")
        rows.append((f"arbiter, one of {ports} ports", *(c / ports for c in shared)))
    return rows + [("together", sum(r[1] for r in rows), sum(r[2] for r in rows))]


def main(words):
    if len(words) < 3:
        sys.exit("usage: cost.py BASELINE.json MAP.regs.json CORE...")
    with open(words[0]) as f:
        chip = json.load(f)["designs"]["soc"]
    signals = chip["signals"]
    with open(words[1]) as f:
        constants = {c["name"]: c["value"] for c in json.load(f)["constants"]}
    for core in words[2:]:
        if not any(re.fullmatch(rf"u_{core}(\..*)?", path) for path in signals) or "SLOT_" + core.upper() not in constants:
            print(f"{core} in the chip: not in {words[0]}: a line in ip/cores.list, then make ip-synth IP={core} CHIP=1")
            continue
        print(f"{core} in the chip, by {words[0]}:")
        for what, lut, ff in parts_of(core, signals, constants):
            print(f"  {what:26} {lut:6.0f} LUT {ff:6.0f} FF")
    print(f"the chip: {chip['lut']} LUT, {chip['ff']} FF, {chip['ram']:g} block RAMs")


main(sys.argv[1:])
