#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""figures: writes docs/figures.md, with a table for each JSON file that `./icesoc bench`, `size`
and `firmware` have written. Benches in Python write their files with the functions `figure` and
`leave`.

    figures.py OUTPUT.md FILE.json...

tools/icesoc/util/measured.py describes the files.
"""
import datetime
import json
import os
import re
import subprocess
import sys
from pathlib import Path

from icesoc.util import measured

TITLES = {
    "simulator": "Simulator", "air": "Radio link on the half-duplex air",
    "fleet": "Several vehicles on one channel", "plugin": "Stock Ice through the plugin",
    "trust": "Attacks, power losses during updates, cost of a key",
    "load": "Load on the ground's engine and gateway", "modem": "Modem set-up",
    "directory": "IceGrid's registry and IceStorm",
    "fsmc": "FSMC bridge", "memory": "Memory ports", "firmware": "Firmware on the Cortex-M3",
    "cores": "Cores", "edits": "Edits, from the edit to the result", "slice": "Slice compiler",
    "size": "Bytes of the firmware's layers",
}

NOTES = {  # notes that are printed below the titles
    "size": "The limit of each layer is the paper's figure for it (Table II). A build also fails "
            "if a layer\nexceeds its smaller budget in "
            "[`tests/limits.toml`](../tests/limits.toml)."}

# Patterns of the parts of a figure name that become a column heading. Figures with names
# that differ only in such a part share a row if the row has two to six columns.
AXES = [r"\d+ vehicles?", r"loss \d\.\d\d", r"bursts, \w+", r"\d+ m, fading", r"interferer \d+ %",
        "in the clear|encrypted|with a key", r"of \d+ bytes", r"\d+ ports", r"HCLK \d+ MHz"]
HEAD = """# Figures

`./icesoc bench` writes this page. It measures everything in one run on one machine, and compares
each figure with its limit, or with another implementation that it measures in the same run. The
page of each subject explains its figures and how they are measured.

`a of b, c %` means: `a` was measured, the limit is `b`, and `a` is `c` percent of `b`. Goodput and
its limit count the bytes that programs exchange. If `(d %)` follows, `a` is `d` percent of all
bytes that the modems could transfer, including the overhead of frames.
"""


def figure(name, value, unit, limit=None, peer=None, ratio=None):
    """Returns the entry of a figure for the JSON file. The figure is compared with `limit` if it is
    given. `peer` is a text about another system with which the figure was compared, and `ratio` is
    the result of this comparison."""
    entry = {"name": name, "value": value, "unit": unit, "command": "./icesoc bench"}
    if limit:
        entry.update(limit=limit, share=round(value / limit, 3))
    if peer:
        entry.update(peer=peer, ratio=round(ratio, 2))
    return entry


def leave(output, content):
    Path(output).parent.mkdir(parents=True, exist_ok=True)
    Path(output).write_text(json.dumps(content, indent=1) + "\n")
    print(f"Written: {output}")


def number(value):
    return f"{value:,.4g}" if isinstance(value, float) and abs(value) < 1e4 else f"{value:,.0f}"


def compared(entry):
    if "limit" in entry:
        share = f", {100 * entry['share']:.1f} %" if "share" in entry else ""
        share += f" ({100 * entry['gross']:.1f} %)" if "gross" in entry else ""
        return f"limit {number(entry['limit'])}{share}"
    if "peer" in entry:
        return f"{entry['peer']}, {number(entry['ratio'])} times"
    return ""


def split(name):
    """Splits a name at the part that one of the patterns AXES matches, such as "5 vehicles".
    Returns (the pattern, the rest of the name) and the matched part. If no pattern matches, returns
    (None, name) and None."""
    for axis in AXES:
        found = re.search(f",? ({axis})", name)
        if found:
            return (axis, name.replace(found[0], "", 1)), found[1]
    return (None, name), None


def tables(rows):
    """Returns the lines of the tables for rows of (name, value, unit, compared)."""
    # series: the cells of figures that can share a row; its keys are (pattern, rest of the name,
    # unit). plain: for each figure, the cells of its series, and its line in the table of single
    # figures.
    series, plain = {}, []
    for name, value, unit, limit in rows:
        key, column = split(name)
        cells = series.setdefault((*key, unit), {})
        cells[column] = value + (" of " + limit[6:] if limit.startswith("limit") else "")
        plain.append((cells, f"| {name} | {value} {unit} | {limit} |"))
    lines, shapes = [], {}
    for (_, what, unit), cells in series.items():
        if 2 <= len(cells) <= 6:
            row = f"| {what}, {unit} | {' | '.join(cells.values())} |"
            shapes.setdefault(tuple(cells), []).append(row)
    single = [line for cells, line in plain if not 2 <= len(cells) <= 6]
    if single:
        lines += ["| what | measured | limit or comparison |", "|---|---|---|", *single]
    for columns, those in shapes.items():
        lines += [""] * bool(lines) + [f"| what | {' | '.join(columns)} |",
                                       "|---" * (len(columns) + 1) + "|", *those]
    return lines


def main(words):
    if len(words) < 2:
        sys.exit(__doc__)
    git = lambda *a: subprocess.run(["git", *a], capture_output=True, text=True).stdout.strip()
    changed = " and changes to it" if git("status", "--porcelain", "--untracked-files=no") else ""
    commit = git("rev-parse", "--short", "HEAD") or "unknown"
    lines = [*HEAD.split("\n"), f"Measured on {datetime.date.today()} at commit {commit}{changed}."]
    for path in filter(os.path.exists, words[1:]):
        entries = measured.read(path)["entries"]
        name = os.path.splitext(os.path.basename(path))[0]
        rows = [(e["name"], number(e["value"]), e["unit"], compared(e)) for e in entries]
        note = [NOTES[name], ""] if name in NOTES else []
        lines += ["", f"## {TITLES.get(name, name)}", *note, *tables(rows)]
    with open(words[0], "w") as page:
        page.write("\n".join(lines) + "\n")


if __name__ == "__main__":
    main(sys.argv[1:])
