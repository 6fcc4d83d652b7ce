# SPDX-License-Identifier: MIT
"""utilisation: reports how much of the FPGA the chip and its parts use, compared with limits and
with the paper."""
import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import sys

from icesoc.synth import baseline
from icesoc.synth import batch
from icesoc.synth import cores
from icesoc.synth import equivalence
from icesoc.synth import published
from icesoc.synth import report
from icesoc.synth import sources
from icesoc.synth import synthesis
from icesoc.synth.report import Report, Row
from icesoc.util import measured
from icesoc.util.errors import Stop, reason_of
from icesoc.util.files import write
from icesoc.util.lock import only_one
from icesoc.util.rooms import RTL
from icesoc.util.tree import tree_state, write_state

# FPGA families; figures, limits and the page are about the first one
FAMILIES = ("xc6s", "xc7", "ecp5")
WHOLE_CHIP = "soc"
STATE_OF = " ".join((*RTL, "slice", "synth", "tools"))
PAGE = pathlib.Path(__file__).with_name("page.html")


def rtl_of(o):
    """Returns the library of all modules. If several have the same name, the first one counts:
    modules of the platform precede cores and generated modules."""
    if not o.generated.is_dir():
        raise Stop(f"{o.generated} not found; run ./icesoc build first")
    inner = sorted(folder for room in ("hdl", "ip") for folder in (o.source / room).iterdir()
                   if folder.is_dir())
    folders = [o.source / "synth", o.source / "hdl", o.source / "bus", *inner, o.generated]
    # The build passes the files of all cores. Their include files are in the same folders.
    files = [pathlib.Path(name) for name in o.files.split(";") if name]
    files = [sources.relative_to(file, pathlib.Path()) for file in files if file.exists()]
    verilog = [file for file in files if re.fullmatch(r"\.s?v", file.suffix, re.I)]
    parents = [file.parent for file in files]
    return sources.Library(folders, dict.fromkeys(folders + parents), verilog)


def synthesise(plan, library, options, o):
    """Returns the runs of the requested designs for each family. Results of all other designs are
    only taken from the cache."""
    runs = [synthesis.Run(design, family, plan.has(design, family)
                          and (not o.design or design.name in o.design))
            for family in o.family for design in plan.designs]
    batch.carry_out(runs, library, options)
    for run in runs:
        if run.wanted and run.error:
            print(f"utilisation: {run.design.name} for {run.family}: {run.error}", file=sys.stderr)
    return runs


def rows_of(plan, runs, library, accepted, yosys):
    rows = []
    for design in plan.designs:
        main, *others = (run for run in runs if run.design is design)
        row = Row(design, main, others, library.hash_of(design.top))
        row.state = baseline.state_of(main, row.sources, accepted["designs"].get(design.name))
        row.failures, row.notes = baseline.judge(row, accepted, yosys, plan.chip["mhz"])
        rows.append(row)
    return rows


def tell_cores(library, options, o, accepted, runs):
    """Prints the cost of some cores in the chip, without checking limits. With `runs`, uses the
    chip that was synthesised, which is then the only requested design. Without `runs`, uses the
    accepted chip. A core that the chip lacks is reported. Returns 1 if the synthesis failed."""
    run = next((run for run in runs if run.wanted), None)
    if run and run.error:
        return 1
    nothing = dict.fromkeys(baseline.KEYS, 0) | {"costs": {}}
    chip = run.figures if run else accepted["designs"].get(WHOLE_CHIP, nothing)
    map = cores.read_map(o.generated / "map.regs.json")
    if not map:
        raise Stop(f"{o.generated} has no map.regs.json; run ./icesoc build first")
    try:
        slot = cores.slot_cost(library, options, map, True)
        print(cores.core_table(chip["costs"], map, slot, o.core,
                               "the list" if run else "synth/baseline.json").plain(), end="")
        print(f"The chip: {chip['lut']} LUT, {chip['ff']} FF, {chip['ram']:g} block RAMs, "
              f"{chip['dsp']} DSP")
    except cores.NotInChip as missing:
        if run:
            raise
        print(missing)
    return 0


def cores_of(rows, library, options, o):
    """Returns one row per core of the chip; None if the chip was not synthesised."""
    map = cores.read_map(o.generated / "map.regs.json")
    for row in rows:
        if row.design.name == WHOLE_CHIP and row.figures and map:
            slot = cores.slot_cost(library, options, map, row.main.wanted)
            return cores.core_table(row.figures["costs"], map, slot, [], "")
    return None


def write_reports(r, o, libraries):
    write(o.output / "report.json", json.dumps(report.entries(r), indent=1) + "\n")
    write(o.output / "report.html", report.html(r, PAGE, libraries))
    print(f"Page: {o.output / 'report.html'}")


def edif(plan, library, options, o):
    print(f"{o.edif} as EDIF ...", file=sys.stderr)
    design = next(design for design in plan.designs if design.name == o.edif)
    synthesis.write_edif(design, library, options, o.output / "ise")
    print(f"{o.output / 'ise' / o.edif}.edf and its Verilog in {o.output / 'ise/verilog'}; "
          "see docs/utilisation.md.")
    return 0


def netlist(plan, library, options, o):
    design = next(design for design in plan.designs if design.name == o.netlist)
    design.parameters.update(o.set)
    synthesis.write_for_simulation(design, o.family[-1], library, options, o.to, models_of(o))
    files = " ".join(str(file.absolute()) for file in library.all_files_of(design.top))
    write(o.to.with_suffix(".d"), f"{o.to.absolute()}: {files}\n")
    return 0


def models_of(o):
    return sorted((o.source / "synth/primitives").glob("*.v"))


def equivalent(plan, library, options, o):
    table, failed = equivalence.table_of(plan, library, options, models_of(o), o)
    print(table.plain(), end="")
    return int(failed > 0)


def run(o, libraries):
    library = rtl_of(o)
    plan = sources.read_plan(library, o.source)
    for name in o.design + [name for name in (o.edif, o.netlist) if name]:
        names = [design.name for design in plan.designs]
        if name not in names:
            raise Stop(f"unknown design {name}; expected one of {', '.join(sorted(names))}")
    accepted = baseline.read_baseline(o.source / "synth/baseline.json")
    options = synthesis.Options(o.source / "synth/yosys", o.output / "cache", o.yosys, o.jobs,
                                {name: a["lut"] for name, a in accepted["designs"].items()})
    if o.list:
        print(*(design.name for design in plan.designs))
        return 0
    if o.edif:
        return edif(plan, library, options, o)
    if o.netlist:
        return netlist(plan, library, options, o)
    if o.equivalent:
        return equivalent(plan, library, options, o)
    if o.core:
        for design in plan.designs:
            design.orders = 0  # only the median of the clock needs further mappings
        runs = synthesise(plan, library, options, o) if o.design else []
        return tell_cores(library, options, o, accepted, runs)
    yosys = synthesis.version_of(o.yosys)
    # git reads the tree's state and the history in parallel
    with concurrent.futures.ThreadPoolExecutor() as pool:
        tree = pool.submit(tree_state, o.source, STATE_OF)
        past = pool.submit(baseline.history, o.source)
        rows = rows_of(plan, synthesise(plan, library, options, o), library, accepted, yosys)
    r = Report(plan, library, rows, accepted, yosys, past.result(),
               baseline.current_commit(o.source))
    if o.accept:
        baseline.accept(r, o.source / "synth/baseline.json")
        return 0
    r.cores = cores_of(rows, library, options, o)
    report.show(r)
    write_reports(r, o, libraries)
    write_state(o.output, tree.result())
    return 1 if r.failures else 0


def options_of(words):
    parser = argparse.ArgumentParser(prog="utilisation", description=__doc__.partition(": ")[2])
    folder = pathlib.Path
    parser.add_argument("--build", type=folder, default="build/main",
                        help="build folder, with the libraries of pages (%(default)s)")
    parser.add_argument("--source", type=folder, default=".", help="the project's folder")
    parser.add_argument("--generated", type=folder, default="build/main/gen",
                        help="folder of generated Verilog (%(default)s)")
    parser.add_argument("--files", default="", metavar="FILE;...",
                        help="Verilog files of all cores, separated by semicolons")
    parser.add_argument("--output", type=folder, default="build/synth",
                        help="folder of the reports (%(default)s)")
    parser.add_argument("--design", action="append", default=[],
                        help="design to synthesise (may be repeated; default: all)")
    parser.add_argument("--family", action="append", default=[], choices=FAMILIES,
                        help="further FPGA family, in addition to xc6s (may be repeated)")
    parser.add_argument("--yosys", default="yosys", help="path of Yosys (%(default)s)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(),
                        help="number of parallel synthesis runs (%(default)s)")
    parser.add_argument("--accept", action="store_true",
                        help="write the figures into synth/baseline.json")
    parser.add_argument("--core", action="append", default=[],
                        help="only print the cost of this core in the accepted chip (may be "
                             "repeated), or with --design soc, in the current chip")
    parser.add_argument("--compare", type=folder, metavar="REPORT.JSON",
                        help="only print how the last report differs from REPORT.JSON")
    parser.add_argument("--reports", action="store_true",
                        help="only compare the estimates with published reports")
    parser.add_argument("--edif", metavar="DESIGN",
                        help="only write this design as EDIF for ISE, into the folder ise")
    parser.add_argument("--list", action="store_true", help="only print the designs' names")
    parser.add_argument("--equivalent", action="store_true",
                        help="only prove that netlists are equivalent to their RTL; for large "
                             "designs, list the tests to run on their netlists")
    parser.add_argument("--junit", type=folder,
                        help="with --equivalent: JUnit file with the results of the listed tests")
    parser.add_argument("--seconds", type=int, default=300,
                        help="time limit of each proof of --equivalent, s (%(default)s)")
    parser.add_argument("--netlist", metavar="DESIGN",
                        help="only write this design's netlist as Verilog for a simulator")
    parser.add_argument("--set", metavar="NAME=VALUE", action="append", default=[],
                        type=lambda text: text.split("=", 1),
                        help="parameter of --netlist's top module (may be repeated)")
    parser.add_argument("--to", type=folder, default="build/synth/netlist.v",
                        help="output file of --netlist (%(default)s)")
    o = parser.parse_args(words)
    o.family = [family for family in FAMILIES if family in [FAMILIES[0], *o.family]]
    return o


def main(words):
    o = options_of(words)
    try:
        if o.reports:
            print(published.text(published.read(o.source)), end="")
            return 0
        if o.compare:
            before, after = map(measured.read, (o.compare, o.output / "report.json"))
            print(report.differences(before, after), end="")
            return 0
        # If another run is synthesising a design, this run waits, and then finds the result in the
        # cache.
        with only_one(o.output, "utilisation"):
            return run(o, o.build / "page")
    except (Stop, OSError) as error:
        print(f"utilisation: {reason_of(error)}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
