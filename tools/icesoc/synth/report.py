# SPDX-License-Identifier: MIT
"""report: prints the figures as text on the terminal, and writes them as JSON for machines and as
one HTML page that needs no network. It also writes the differences between two reports as
Markdown."""
import dataclasses
import itertools

from icesoc.synth import baseline
from icesoc.synth import slices
from icesoc.synth import timing
from icesoc.synth.baseline import MEASURED, clock_text, short_version
from icesoc.synth.owners import Cost
from icesoc.synth.synthesis import Run
from icesoc.synth.sources import Design, Library, Plan
from icesoc.web.page import filled, page_parts, script_safe


@dataclasses.dataclass
class Row:
    """The runs of a design by family."""
    design: Design
    main: Run  # Spartan-6
    others: list = dataclasses.field(default_factory=list)
    sources: str = ""  # hash of the sources
    state: str = MEASURED
    failures: list = dataclasses.field(default_factory=list)
    notes: list = dataclasses.field(default_factory=list)

    @property
    def figures(self):
        return self.main.figures


@dataclasses.dataclass
class Report:
    plan: Plan
    library: Library
    rows: list
    baseline: dict
    yosys: str
    commits: list
    commit: str
    cores: "Table" = None  # the cost of each core in the chip, if known

    @property
    def failures(self):
        return [failure for row in self.rows for failure in row.failures]


class Table:
    """A table, written as plain text with aligned columns or as Markdown. The first column is
    left-aligned, the others right-aligned."""

    def __init__(self, head, rows=()):
        self.rows = [[str(cell) for cell in row] for row in [head, *rows]]

    def plain(self):
        columns = itertools.zip_longest(*self.rows, fillvalue="")
        widths = [max(map(len, column)) for column in columns]
        return "".join("  ".join([row[0].ljust(widths[0]),
                                  *(cell.rjust(width) for cell, width in zip(row[1:], widths[1:]))])
                       .rstrip() + "\n" for row in self.rows)

    def markdown(self):
        lines = [f"| {' | '.join(row)} |" for row in self.rows]
        lines.insert(1, "|---|" + "---:|" * (len(self.rows[0]) - 1))
        return "\n".join(lines) + "\n"


# Text that explains the ranges in the tables.
ERRORS = (f"as mapped, routed: nine of ten of {slices.MAPPED.count} published reports of map, of "
          f"{timing.ROUTED.count} of TRCE, are in this range; their medians are "
          f"{slices.MAPPED.median:.2f} and {timing.ROUTED.median:.2f} of the estimate")


def percent(part, whole):
    return f"{100 * part / whole:.1f} %"


def sites_of_map(f):
    return int(slices.map_sites(f["lut"], f["lutRam"] + f["shift"], f["through"]) + 0.5)


def paper_table(plan, row):
    f = row.figures
    # name, key of the paper's figure, key of the limit, value
    lines = [("flip-flops", "ff", "ff", f["ff"]), ("LUTs of the netlist", "lut", "lut", f["lut"]),
             ("LUTs and route-throughs, before map pairs them", "lut", "", f["lut"] + f["through"]),
             (f"LUT sites, map's average pairing (estimate; as mapped "
              f"{slices.SITES_OF_MAP.of(sites_of_map(f))})", "lut", "", sites_of_map(f)),
             (f"LUT sites, pairs found individually (estimate; as mapped "
              f"{slices.SITES_OF_MAP.of(f['sites'])})", "lut", "sites", f["sites"]),
             (f"slices (estimate; as mapped {slices.MAPPED.of(f['slices'])})", "slices", "slices",
              f["slices"])]
    table = []
    for name, key, limited, value in lines:
        chip, paper, limit = plan.chip[key], plan.paper[key], row.design.limits.get(limited)
        table.append([name, value, percent(value, chip), f"{paper} ({percent(paper, chip)})",
                      f"{value / paper:.2f}", "" if limit is None else limit,
                      "" if limit is None else "ok" if value <= limit else f"{value - limit} over"])
    return Table(["", "here", plan.chip["name"], "paper", "here / paper", "limit", ""], table)


def ranged(value, values, text=str):
    """Returns a figure as text, followed by its range if the design was mapped several times: "863
    (858-865)"."""
    return text(value) + (f" ({text(min(values))}-{text(max(values))})" if len(values) > 1 else "")


def clock_of(f):
    return ranged(f["mhz"], f["clocks"], clock_text) if f["mhz"] else ""


def design_row(plan, row, accepted):
    name, f = row.design.name, row.figures
    if not f:
        return [name, "failed"]

    def change(key):
        return ("new" if not accepted else
                "" if f[key] == accepted[key] else f"{f[key] - accepted[key]:+d}")

    luts = [f["cells"].get(f"LUT{n}", 0) for n in range(1, 7)]
    others = [cell for other in row.others
              for cell in ((other.figures["lut"], other.figures["ff"]) if other.figures
                           else ("failed" if other.wanted else "", ""))]
    return [name, ranged(f["lut"], f["luts"]), change("lut"), percent(f["lut"], plan.chip["lut"]),
            luts[0] + f["cells"].get("INV", 0) + luts[1], *luts[2:], f["lutRam"], f["shift"],
            f["through"], f["ff"], change("ff"), f["sets"], f["carry"], f"{f['ram']:g}", f["dsp"],
            f["pins"], f["slices"], f"{f['low']}-{f['high']}",
            f["timing"]["paths"][0]["levels"] if f["mhz"] else "", clock_of(f),
            timing.ROUTED.of(f["mhz"]) if f["mhz"] else "", *others]


def design_table(plan, rows, accepted):
    head = ("design LUT change chip 1-2 3 4 5 6 RAM SRL thru FF change sets carry RAM16 DSP pins "
            "slices low-high levels MHz routed").split()
    for other in rows[0].others if rows else ():
        head += [f"{other.family} LUT", "FF"]
    return Table(head, [design_row(plan, row, accepted.get(row.design.name)) for row in rows])


def cost_table(library, row, depth=2):
    """Returns a table of the instances of a design. The cost of an instance includes all instances
    below it."""
    paths = {"": Cost()}
    for path, cost in baseline.by_instance(row.figures["costs"]).items():
        names = path.split(".") if path else []
        for n in range(len(names) + 1):
            below = ".".join(names[:n])
            paths[below] = paths.get(below, Cost()) + cost
    lines = []
    for path, cost in sorted(paths.items()):
        level = path.count(".") + 1 if path else 0
        if level <= depth:
            lines.append(["  " * level + (path.rpartition(".")[2] or row.design.top),
                          library.module_at(row.design.top, path), cost.lut, cost.memory, cost.ff,
                          cost.carry])
    return Table(["instance", "module", "LUT", "as RAM", "FF", "carry"], lines)


def path_table(plan, row, count=5):
    """Returns a table of the longest paths. If a design is mapped several times, each time with its
    inputs and outputs in another order, these are the paths of the mapping with the median clock,
    which is the reported one."""
    mhz = plan.chip["mhz"]
    return Table([f"longest paths, estimated, at {clock_text(row.figures['mhz'])} MHz", "to",
                  "levels", "ns (-3)", "ns (-2)", f"of {mhz:g} MHz"],
                 [[p["from"], f"{p['to']} {p['pin']}", p["levels"], f"{p['ns']:.2f}",
                   f"{p['ns'] * timing.SLOW_GRADE:.2f}",
                   percent(p["ns"] * timing.SLOW_GRADE, 1000 / mhz)]
                  for p in row.figures["timing"]["paths"][:count]])


def pads_table(row):
    """Returns a table with the longest path at each pad, slowest first, and the range in which
    the delay of this path may be after routing."""
    return Table(["paths of pads, estimated", "from", "to", "levels", "ns (-3)", "ns (-2)",
                  "routed (-2)"],
                 [[p["kind"], p["from"], f"{p['to']} {p['pin']}", p["levels"], f"{p['ns']:.2f}",
                   f"{p['ns'] * timing.SLOW_GRADE:.2f}",
                   timing.delay_range(p["ns"] * timing.SLOW_GRADE)]
                  for p in sorted(row.figures["timing"]["pads"],
                                  key=lambda p: (p["kind"], -p["ns"]))])


def states_text(rows):
    """Returns the number of designs in each state: "1 measured now, 65 as accepted"."""
    states = [row.state for row in rows]
    return ", ".join(f"{states.count(state)} {state}" for state in baseline.STATES
                     if state in states)


def show(report):
    """Prints the figures of the requested designs on the terminal."""
    wanted = [row for row in report.rows if row.main.wanted]
    for row in wanted:
        if row.design.paper and row.figures:
            tables = [paper_table(report.plan, row), cost_table(report.library, row),
                      path_table(report.plan, row), pads_table(row)]
            print("\n".join([row.design.title, *(table.plain() for table in tables)]))
    if report.cores:
        print(report.cores.plain())
    accepted = report.baseline["designs"]
    print(design_table(report.plan, wanted, accepted).plain(), end="")
    print(ERRORS)
    if len(wanted) < len(report.rows):
        print(f"Designs: {states_text(report.rows)}")
    versions = short_version(report.baseline["yosys"]), short_version(report.yosys)
    if versions[0] not in ("", versions[1]):
        print(f"The accepted figures are from {versions[0]}, these figures from {versions[1]}, so "
              "growth is not judged.")
    for row in report.rows:
        for line in row.notes + [f"FAILED {failure}" for failure in row.failures]:
            print(line)
    fresh = [row.design.name for row in wanted if row.design.name not in accepted]
    if fresh:
        print("No accepted figures yet (`./icesoc synth accept` records them):", *fresh)


def entries(report):
    """Returns the content of report.json: the failures, the state of each design, and the figures
    as entries (icesoc.util.measured)."""
    found = []
    for row in report.rows:
        name, f = row.design.name, row.figures
        if not f:
            continue
        accepted = report.baseline["designs"].get(name)
        budgets = {"lut": baseline.lut_budget(accepted["lut"]),
                   "ff": baseline.ff_budget(accepted["ff"])} if accepted else {}

        def add(key, value, unit, more={}):
            found.append({"name": f"{name} {key}", "value": value, "unit": unit,
                          "command": f"make synth DESIGN={name}", **more})

        estimated = f"slices, estimated; as mapped {slices.MAPPED.of(f['slices'])}"
        for key, unit in (("lut", "LUT"), ("ff", "flip-flops"), ("slices", estimated)):
            limit, more = (budgets | row.design.limits).get(key), {}
            if limit is not None:
                more = {"limit": limit} | ({"share": round(f[key] / limit, 3)} if limit else {})
            if row.design.paper:
                more |= {"peer": report.plan.paper[key],
                         "ratio": round(f[key] / report.plan.paper[key], 3)}
            add(key, f[key], unit, more)
        if row.design.paper:  # the pages repeat this figure
            sites = sites_of_map(f)
            add("sites", sites, f"LUT sites, estimated; as mapped {slices.SITES_OF_MAP.of(sites)}")
        goal = report.plan.chip["mhz"]
        if f["mhz"]:
            add("clock", round(f["mhz"], 1),
                f"MHz, estimated; as routed {timing.ROUTED.of(f['mhz'])}; at least",
                {"limit": goal, "share": round(f["mhz"] / goal, 3)})
        for port, limit in row.design.pads.items():
            ns = round(timing.SLOW_GRADE * timing.slowest_pad(f["timing"]["pads"], port), 2)
            add(f"pad to {port}", ns, f"ns (-2), estimated; as routed {timing.delay_range(ns)}; "
                "at most", {"limit": limit, "share": round(ns / limit, 3)})
        for other in row.others:
            if other.figures:
                add(f"lut {other.family}", other.figures["lut"], "LUT")
                add(f"ff {other.family}", other.figures["ff"], "flip-flops")
    return {"failures": [failure.partition("\n")[0] for failure in report.failures],
            "states": {row.design.name: row.state for row in report.rows}, "entries": found}


def differences(before, after):
    """Returns the differences between two contents of report.json as a table in Markdown. If a
    figure is only in one of them, the table contains the state of the design in the other one, such
    as `changed since`, or "new" or "gone"."""
    designs = {}  # name -> {kind of figure: [before, after]}
    for number, report in enumerate((before, after)):
        for entry in report["entries"]:
            name, kind = entry["name"].split(" ", 1)
            designs.setdefault(name, {}).setdefault(kind, [None, None])[number] = entry["value"]
    lines = []
    for name, figures in sorted(designs.items()):
        line, differs = [name], False
        for kind in ("lut", "ff", "slices", "clock"):
            then, now = figures.get(kind, (None, None))
            differs |= then != now
            if then is not None and now is not None and then != now:
                line.append(f"{then:g} -> {now:g} ({now - then:+g})")
            elif now is not None:
                was = before.get("states", {}).get(name, "new")
                line.append(f"{now:g}" + (f" ({was})" if then is None else ""))
            else:
                line.append("" if then is None else after["states"].get(name, "gone"))
        if differs:
            lines.append(line)
    return Table(["design", "LUT", "FF", "slices", "MHz"], lines).markdown() if lines else \
        "No figure of any design differs.\n"


def page_figures(f):
    """Returns the figures of a design as the page needs them. Signals without cost are left out."""
    costs = {path: {signal: [c.lut, c.ff, c.memory]
                    for signal, c in signals.items() if c.lut or c.ff}
             for path, signals in f["costs"].items()}
    return f | {"lut6": f["cells"].get("LUT6", 0),
                "levels": f["timing"]["paths"][0]["levels"] if f["mhz"] else 0,
                "costs": {path: signals for path, signals in costs.items() if signals}}


def page_design(report, row):
    accepted = report.baseline["designs"].get(row.design.name)
    d = {"name": row.design.name, "title": row.design.title, "file": row.design.file,
         "top": row.design.top, "paper": row.design.paper, "limits": row.design.limits,
         "failures": row.failures, "notes": row.notes, "state": row.state}
    if row.figures:
        d["figures"] = page_figures(row.figures)
        paths = {".".join(names[:n]) for names in (p.split(".") for p in row.figures["costs"] if p)
                 for n in range(1, len(names) + 1)}
        d["modules"] = {path: report.library.module_at(row.design.top, path) for path in paths}
    d["others"] = {o.family: {key: o.figures[key] for key in ("lut", "ff")}
                   for o in row.others if o.figures}
    if accepted:
        d["accepted"] = {key: accepted[key] for key in baseline.KEYS}
        d["budget"] = {"lut": baseline.lut_budget(accepted["lut"]),
                       "ff": baseline.ff_budget(accepted["ff"])}
    return d


def html(report, page, libraries):
    """Returns the page: the file `page` with "@STYLE@", "@SCRIPT@" and "@DATA@" replaced.
    `libraries`: the folder of the pages' libraries from npm."""
    data = {"yosys": short_version(report.yosys), "commit": report.commit,
            "paper": report.plan.paper, "chip": report.plan.chip, "slowGrade": timing.SLOW_GRADE,
            "routed": timing.ROUTED._asdict(),
            "states": states_text(report.rows),
            "cores": report.cores.rows if report.cores else [],
            "table1": next((paper_table(report.plan, row).rows for row in report.rows
                            if row.design.paper and row.figures), []),
            "designs": [page_design(report, row) for row in report.rows],
            "history": report.commits}
    style, script = page_parts(libraries)
    return filled(page.read_text(), {"@STYLE@": style, "@SCRIPT@": script,
                                     "@DATA@": script_safe(data)})
