# SPDX-License-Identifier: MIT
"""coverage: compares the coverage of each file with its minimum (gate). Verilator counts points of
the RTL (lines, branches, toggles, covers), GHDL lines of VHDL, gcov lines of C and C++.

Usage, in the tree: coverage.py LIMITS.toml FOLDER
FOLDER contains rtl.dat, host.info and vhdl.info, each if it exists. Writes the measurements
(icesoc.util.measured) into FOLDER/summary.json, with an entry for the lines of each file, which
also has the other counts of the file.
Exit status 1: a file is below its gate.
"""
import collections
import json
import os
import pathlib
import re
import sys
import tomllib

from icesoc.regress.lights import below_gate
from icesoc.util.errors import Stop, reason_of
from icesoc.util.files import write


class Share:
    def __init__(self):
        self.total = self.covered = 0

    def add(self, hit):
        self.total += 1
        self.covered += hit

    @property
    def percent(self):
        return 100 * self.covered / self.total if self.total else 100.0


class File:
    def __init__(self):
        # kind ("lines", "toggles" or "points") -> covered share
        self.shares = collections.defaultdict(Share)
        # name of a cover point (`name: cover property` in the RTL) -> how often it was reached
        self.counts = collections.Counter()
        # each uncovered toggle, line or point, as text that begins with the line number
        self.missed = []
        # reason -> number of points that are not counted for this reason
        self.explained = collections.Counter()


def inside(path, root):
    """Returns the path from the root of the tree, or "" for third-party and generated files."""
    real = os.path.realpath(path)
    below = os.path.relpath(real, root)
    return "" if below.startswith(("..", "build/", "tests/")) else below


class Explanations:
    """Points that cannot be reached, with the reasons; they are not counted."""

    def __init__(self, rules):
        self.rules = [(r.get("file", ""), re.compile(r["points"]), r["why"], collections.Counter())
                      for r in rules]

    def of(self, file, point, covered):
        """Returns the reason why a point does not count, or ""."""
        for below, points, why, seen in self.rules:
            if file.startswith(below) and points.fullmatch(point):
                seen[covered] += 1
                if not covered:
                    return why
        return ""

    def stale(self):
        """Returns a text for each rule that has become useless, because its points are covered or
        no longer exist."""
        return [f"{below}: {points.pattern} ({'reached' if seen[True] else 'no such point'})"
                for below, points, _, seen in self.rules if not seen[False]]


def read_verilator(path, root, files, explanations):
    """Reads verilated.dat, lines such as C '\\1key\\2value\\1key\\2value...' count. If a module
    exists in several models or with several parameters, a point is covered if any of them covers
    it."""
    counts, places = collections.Counter(), {}
    for line in open(path, errors="replace"):
        if not line.startswith("C '"):
            continue
        text, _, count = line[3:].rpartition("' ")
        fields = dict(pair.partition("\2")[::2] for pair in text.split("\1")[1:])
        if fields["f"] not in places:
            places[fields["f"]] = inside(fields["f"], root)
        if file := places[fields["f"]]:
            page = fields["page"]
            kind = "toggles" if page.startswith("v_toggle") else \
                "points" if page.startswith("v_user") else "lines"
            key = file, fields["l"], fields.get("n", ""), page[:8], fields["o"], kind
            counts[key] += int(count)
    for (name, line, _, _, point, kind), total in sorted(counts.items()):
        file = files[name]
        if why := explanations.of(name, point, total > 0):
            file.explained[why] += 1
            continue
        if kind == "points":
            file.counts[point] += total
        file.shares[kind].add(total > 0)
        if not total:
            file.missed.append(f"{line}: {point}")


def read_info(path, root, files, _):
    """Reads the lines SF:file and DA:line,count of a .info file of lcov."""
    file = ""
    for text in open(path, errors="replace"):
        if text.startswith("SF:"):
            file = inside(text[3:].strip(), root)
        elif text.startswith("DA:") and file:
            line, count = text[3:].split(",")[:2]
            files[file].shares["lines"].add(count.strip() != "0")
            if count.strip() == "0":
                files[file].missed.append(line)


def report(files, gates, out):
    """Prints one line per file and writes the summary; returns the files below their gates."""
    rows, below, total = [], [], collections.defaultdict(Share)
    for name, file in sorted(files.items()):
        above = [path for path in gates if name.startswith(path)]
        gate = gates[max(above, key=len)] if above else {}
        lines, toggles, points = (file.shares[kind] for kind in ("lines", "toggles", "points"))
        for kind, share in file.shares.items():
            total[kind].total += share.total
            total[kind].covered += share.covered
        row = {"name": name, "value": lines.percent, "unit": "% of lines, at least",
               "limit": gate.get("lines", 0), "lines": lines.total, "toggles": toggles.percent,
               "toggle_points": toggles.total, "toggle_gate": gate.get("toggles", 0),
               "points": file.counts, "point_percent": points.percent,
               "point_gate": gate.get("points", 100), "why": gate.get("why", ""),
               "missed": file.missed, "explained": file.explained}
        rows.append(row)
        of_toggles = f"{toggles.percent:6.1f} % of {toggles.total:5} toggles"
        of_points = f"{points.covered} of {points.total} points"
        print(f"{name:<44} {lines.percent:6.1f} % of {lines.total:5} lines "
              f"{of_toggles if toggles.total else '':>22}{of_points if points.total else '':>16}"
              f"{row['why'] and '  (' + row['why'] + ')'}")
        if below_gate(row):
            below.append(
                f"below its gate: {name}: lines {lines.percent:.1f} (gate {row['limit']:.0f}), "
                f"toggles {toggles.percent:.1f} (gate {row['toggle_gate']:.0f}), points "
                f"{points.percent:.1f} (gate {row['point_gate']:.0f}); never: "
                f"{'; '.join(file.missed[:8])}")
    lines, toggles, points = (total[kind] for kind in ("lines", "toggles", "points"))
    write(out, json.dumps({"total": lines.percent, "toggles": toggles.percent,
                           "points": points.covered, "points_total": points.total,
                           "entries": rows}, indent=1, sort_keys=True) + "\n")
    print(f"\n{lines.percent:.1f} % of {lines.total} lines, {toggles.percent:.1f} % of "
          f"{toggles.total} toggle points, {points.covered} of {points.total} cover points; {out}")
    return below


def main(path_of_limits, folder):
    root, files = os.path.realpath("."), collections.defaultdict(File)
    try:
        limits = tomllib.loads(pathlib.Path(path_of_limits).read_text())
        explanations = Explanations(limits.get("unreachable", []))
        gates = limits["coverage"]
        for name in ("rtl.dat", "host.info", "vhdl.info"):
            if (path := pathlib.Path(folder, name)).exists():
                read = read_info if path.suffix == ".info" else read_verilator
                read(path, root, files, explanations)
        if not files:
            raise Stop("nothing was measured; run the tests with COVERAGE_DIR set to this folder")
        below = report(files, gates, f"{folder}/summary.json")
        below += [f"{path_of_limits}: no file belongs to the gate {path}" for path in gates
                  if not any(name.startswith(path) for name in files)]
        below += [f"{path_of_limits}: explanation without effect: {rule}"
                  for rule in explanations.stale()]
    except (OSError, ValueError, KeyError, Stop) as error:
        print(f"coverage: {reason_of(error)}", file=sys.stderr)
        return 2
    for line in below:
        print(f"coverage: {line}", file=sys.stderr)
    return 1 if below else 0


sys.exit(main(*sys.argv[1:]) if len(sys.argv) == 3 else __doc__)
