# SPDX-License-Identifier: MIT
"""placement: designs placed and routed on an ECP5 by nextpnr, to compare the estimates with."""
import json
import pathlib
import statistics

from report import Table, percent
from runner import in_parallel
from tool import Stop, run as command

SEEDS = (1, 2, 3, 4, 5)


def report_of(run, seed):
    return pathlib.Path(f"{run.netlist}.placed.{seed}")


def place(nextpnr, run, seed):
    """LFE5U-45F, speed grade 6, the slowest. The memory's ports end within the chip, so there are
    no pads: a block "out of context". Cached results are not placed again."""
    report = report_of(run, seed)
    if report.exists():
        return
    part = pathlib.Path(f"{report}.part")
    status, said = command([nextpnr, "-q", "--45k", "--package", "CABGA381", "--speed", 6,
                            "--out-of-context", "--json", run.netlist, "--top", run.design.top,
                            "--freq", 100, "--timing-allow-fail", "--seed", seed, "--report", part])
    if status:
        raise Stop(f"nextpnr cannot place {run.design.name}: {said}")
    part.replace(report)


def placed(rows, nextpnr, jobs):
    """A row for each run of family "ecp5" that was wanted."""
    runs = [(run, row.figures) for row in rows for run in row.others
            if run.family == "ecp5" and run.wanted and run.figures]
    in_parallel(jobs, lambda work: place(nextpnr, *work),
                [(run, seed) for run, _ in runs for seed in SEEDS])
    lines = []
    for run, figures in runs:
        reports = [json.loads(report_of(run, seed).read_text()) for seed in SEEDS]
        clocks = [min(clock["achieved"] for clock in report["fmax"].values()) for report in reports]
        used = reports[-1]["utilization"]
        luts = used["TRELLIS_COMB"]["used"]
        lines.append([run.design.name, *(f"{mhz:.0f}" for mhz in
                                         (statistics.median(clocks), min(clocks), max(clocks))),
                      f"{figures['mhz']:.0f}", luts, used["TRELLIS_FF"]["used"],
                      percent(luts, used["TRELLIS_COMB"]["available"])])
    return Table(["placed on ECP5", "MHz, median", "least", "most", "Spartan-6, estimated", "LUT4",
                  "FF", "of the chip"], lines)
