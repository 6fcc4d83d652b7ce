# SPDX-License-Identifier: MIT
"""published: compares the estimates with published reports of XST, map and TRCE ("reports" in
synth/designs.json), which shows how accurate the estimates are (docs/utilisation.md).

Every report has figures of map, which calibrate the estimate of slices. If Yosys can read the
sources of the design, the report also has a "netlist": the counts of cells,
the steps of the longest path of the reported clock [type, fan-out, delay of the cell in ns, delay
of its net in ns], and the end of that path.
"""
import math
import statistics

from icesoc.synth import slices
from icesoc.synth import timing
from icesoc.synth.report import Table
from icesoc.synth.slices import Range
from icesoc.synth.sources import DESIGNS, read_designs
from icesoc.util.errors import Stop

# "one", "two": numbers of LUT sites with one function and with two functions
MAP = ("sites", "ff", "slices", "one", "two")
NETLIST = ("lut", "memory", "through", "ff", "path", "end")


def fault_of(report):
    """Returns the reason why the report cannot be read, or ""."""
    for key, kind in (("at", str), ("device", str), ("tool", str), ("files", dict)):
        if not isinstance(report.get(key), kind):
            return f"no {key}"
    for key, fields in (("map", MAP), ("netlist", NETLIST)):
        missing = [field for field in fields if field not in report.get(key, dict.fromkeys(fields))]
        if missing:
            return f"{key} has no {', '.join(missing)}"
    published = [report[key] for key in ("synthesised", "routed") if key in report]
    if not all(isinstance(ns, float) and ns > 0 for ns in published):
        return "clock: expected a time in ns"
    if bool(published) != ("netlist" in report) or "map" not in report:
        return "no map, or a netlist without a published clock or a clock without one"
    return ""


def read(root):
    """Returns the reports in a tree's synth/designs.json."""
    file, found = DESIGNS, read_designs(root)
    if not isinstance(found, dict) or not isinstance(found.get("reports"), list):
        raise Stop(f"{file}: expected a list of reports")
    for number, report in enumerate(found["reports"]):
        if why := fault_of(report) if isinstance(report, dict) else "no object":
            raise Stop(f"{file}: report {number + 1} cannot be read: {why}")
    return found["reports"]


def estimated(report):
    """Returns the estimated delay of the longest path, ns, at the speed grade of the report."""
    path, (type, pin) = report["netlist"]["path"], report["netlist"]["end"]
    ns = sum(cell + net for _, _, cell, net in path) + timing.end_delay(type, pin)
    return ns * (timing.SLOW_GRADE if report["device"].endswith("-2") else 1)


def clock_ratios(reports, kind):
    """Returns the ratio of the published to the estimated clock frequency, for each report of this
    kind ("synthesised" or "routed")."""
    return [estimated(report) / report[kind] for report in reports if kind in report]


def site_ratios(reports):
    """Returns the ratios of published to estimated LUT sites. The published number is from map's
    report; the estimate is computed from Yosys' netlist."""
    return [report["map"]["sites"] / slices.map_sites(n["lut"], n["memory"], n["through"])
            for report in reports if (n := report.get("netlist"))]


def left_out(values, fitted):
    """Returns each value divided by the result of the function `fitted` for all other values."""
    return [value / fitted(values[:i] + values[i + 1:]) for i, value in enumerate(values)]


def nine_of_ten(errors):
    twentieths = statistics.quantiles(errors, n=20, method="inclusive")
    return twentieths[0], twentieths[-1]


def range_of(ratios):
    """Returns the median of the ratios, and the range around it in which nine of ten ratios are
    expected. The range comes from the errors of the ratios; the error of a ratio is the ratio
    divided by the median of all other ratios."""
    median = statistics.median(ratios)
    low, high = nine_of_ten(left_out(ratios, statistics.median))
    return Range(median, median * low, median * high, len(ratios))


def best_share(maps):
    """Returns the share of flip-flops without a LUT, in steps of 0.01, that predicts the slices of
    these reports best."""
    return min((n / 100 for n in range(151)), key=lambda share: sum(
        abs(math.log(slices.occupied(m["sites"], m["ff"], share) / m["slices"])) for m in maps))


def slices_range(maps):
    """Returns the median and the range of the ratios of published to predicted slices. The
    prediction for a report uses the share that fits all other reports best."""
    shares = [best_share(maps[:i] + maps[i + 1:]) for i in range(len(maps))]
    errors = [m["slices"] / slices.occupied(m["sites"], m["ff"], share)
              for m, share in zip(maps, shares)]
    low, high = nine_of_ten(errors)
    return Range(statistics.median(errors), low, high, len(errors))


def paired(m):
    """Returns the share of functions that need no separate LUT site, from a report of map."""
    return m["two"] / (m["one"] + 2 * m["two"])


def text(reports):
    """Returns the comparison as text. It contains the values of the constants in timing.py and
    slices.py."""
    rows = [["design", "device", "sites of map", "estimated", "MHz estimated", "XST", "routed",
             "XST / estimated", "routed / estimated"]]
    for report in (r for r in reports if "netlist" in r):
        n, ns = report["netlist"], estimated(report)
        published = [report.get(kind) for kind in ("synthesised", "routed")]
        rows.append([report["design"], report["device"], report["map"]["sites"],
                     round(slices.map_sites(n["lut"], n["memory"], n["through"])),
                     f"{1000 / ns:.1f}", *(f"{1000 / p:.1f}" if p else "" for p in published),
                     *(f"{ns / p:.2f}" if p else "" for p in published)])
    maps = [report["map"] for report in reports]
    ranges = [(f"clock by {kind}", range_of(clock_ratios(reports, key)))
              for kind, key in (("XST", "synthesised"), ("TRCE", "routed"))]
    ranges += [("sites of LUTs by map", range_of(site_ratios(reports))),
               ("slices by map", slices_range(maps))]
    return Table(rows[0], rows[1:]).plain() + "\n" + Table(
        ["published / estimated", "median", "nine of ten", "designs"],
        [[name, f"{r.median:.2f}", f"{r.low:.2f}-{r.high:.2f}", r.count] for name, r in ranges]
    ).plain() + f"Flip-flops without a LUT: {best_share(maps):.2f}\n"
