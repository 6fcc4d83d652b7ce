#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""figures: writes docs/figures.md, a table for each JSON file that `make bench`, `size` and `firmware` have left.

    figures.py OUTPUT.md FILE.json...

A file is a list of entries, or an object with the list in "entries": name, value, unit, and where there is one limit
and share (measured by limit), or peer and ratio.
"""
import datetime
import json
import os
import subprocess
import sys

TITLES = {
    "simulator": "Simulator", "air": "Radio link on the half-duplex air", "speed": "Simulation of RTL against Icarus", "link": "Radio link through the RTL",
    "plugin": "Stock Ice through the plugin", "trust": "Attacks, losses of power in updates, bytes of a key", "load": "Load on the ground's engine and gateway",
    "latency": "Latency of a call", "modem": "Modem set-up",
    "fsmc": "FSMC bridge", "memory": "Memory ports", "firmware": "Firmware on the Cortex-M3", "cores": "Cores",
    "wrapper": "Generated wrapper against one by hand", "new_core": "A new core", "slice": "Slice compiler",
    "size": "Bytes of the firmware's layers",
}


def number(value):
    return f"{value:,.4g}" if isinstance(value, float) and abs(value) < 1e4 else f"{value:,.0f}"


def row(entry):
    beside = ""
    if "limit" in entry:
        beside = f"limit {number(entry['limit'])}"
        if "share" in entry:
            beside += f", {100 * entry['share']:.1f} %"
    elif "peer" in entry:
        beside = f"{entry['peer']}, {entry['ratio']} times"
    elif "by_hand" in entry:
        beside = f"by hand {entry['by_hand']}, from VHDL {entry['in_vhdl']}"
    return f"| {entry['name']} | {number(entry['value'])} {entry['unit']} | {beside} |"


def main(words):
    if len(words) < 2:
        sys.exit(__doc__)
    git = lambda *a: subprocess.run(["git", *a], capture_output=True, text=True).stdout.strip()
    changed = " and changes to it" if git("status", "--porcelain", "--untracked-files=no") else ""
    lines = ["# Figures", "",
             "Written by `make bench`: one run on one machine, each figure beside its limit or its peer of the",
             "same run. What each one means, and how it is measured, is said on the page of its subject.", "",
             f"Measured on {datetime.date.today()} at commit {git('rev-parse', '--short', 'HEAD')}{changed}."]
    for path in words[1:]:
        content = json.load(open(path))
        entries = content["entries"] if isinstance(content, dict) else content
        name = os.path.splitext(os.path.basename(path))[0]
        lines += ["", f"## {TITLES.get(name, name)}", "| what | measured | beside |", "|---|---|---|"]
        lines += [row(e) for e in entries]
    with open(words[0], "w") as page:
        page.write("\n".join(lines) + "\n")


main(sys.argv[1:])
