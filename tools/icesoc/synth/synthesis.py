# SPDX-License-Identifier: MIT
"""synthesis: runs a synthesis with Yosys, caches the result under the hash of its sources, and
computes the figures of the run. batch.py runs several.

The cache stores the figures as JSON: {"lut", "ff", ...: counts; "cells": counts by Yosys cell type;
"costs": {path: {signal: Cost}}; and the figures of slices.py, timing.py, nets.py}. "clocks"
lists the highest clock frequency of each order of the design's ports, lowest first; "mhz" is the
median of this list, which is compared with the budget.
"""
import dataclasses
import functools
import json
import os
import pathlib
import re
import shutil
import sys

from icesoc.synth import nets
from icesoc.synth import netlist
from icesoc.synth import owners
from icesoc.synth import slices
from icesoc.synth import timing
from icesoc.synth.sources import Design, read
from icesoc.util.errors import Stop
from icesoc.util.files import digest, write
from icesoc.util.process import collect as command

# Hash of the modules that compute the figures of a netlist. If one of them changes, cached figures
# are computed again.
TOOL = digest(pathlib.Path(module.__file__).read_text() for module in (
    nets, netlist, owners, slices, timing, sys.modules[__name__]))


@dataclasses.dataclass
class Run:
    design: Design
    family: str  # name of the script for the family: "xc6s", "xc7" or "ecp5"
    wanted: bool = True  # False: results are only taken from the cache
    netlist: pathlib.Path = None  # path of the netlist written by Yosys
    figures: dict = None
    error: str = ""  # reason why the figures are missing
    known: bool = False  # True: the design was synthesised here with other sources
    begun: float = 0  # time of the start, by time.monotonic()
    spent: float = None  # duration, s; 0: cached

    @property
    def orders(self):
        return self.design.orders if self.family == "xc6s" else 0


@dataclasses.dataclass
class Options:
    scripts: pathlib.Path  # *.ys
    cache: pathlib.Path
    yosys: str = "yosys"
    jobs: int = 1
    luts: dict = dataclasses.field(default_factory=dict)  # design -> number of LUTs, if known


@functools.cache
def version_of(yosys):
    return command([yosys, "-V"])[1].partition("\n")[0]


def netlist_of_order(file, order):
    return pathlib.Path(f"{file}.{order}")


NO_MEMORY = "select -assert-none t:$mem*"
DECLARES_MEMORY = re.compile(r"\b(?:reg|logic|bit)\b[^;]*?\w\s*\[[^];]*\]\s*[;,=]")


def script_of(run, library, options, output, more="", memory=False):
    """Returns the Yosys script of a run. `more`: a further library of cells that the sources
    instantiate. `memory`: the design has a memory although the sources declare none. For a design
    with limits, the script contains all modules of Yosys' libraries, because fewer modules would
    change the mapping at random."""
    includes = "".join(f" -I{folder}" for folder in library.include_folders)
    files, listed = library.files_of(run.design.top), [m.file for m in library.modules.values()]
    # SystemVerilog has additional keywords, so its files are read separately. Packages come before
    # the modules that use them.
    system = sorted((f for f in files if f.suffix.lower() == ".sv"), key=listed.index)
    sources = "".join(f' "{file}"' for file in files if file not in system)
    if system:
        sources += "\nread_verilog @INCLUDES@" * bool(sources) + " -sv" + "".join(
            f' "{file}"' for file in system)
    parameters = "".join(f"chparam -set {name} {value} {run.design.top}\n"
                         for name, value in sorted(run.design.parameters.items()))
    script = (options.scripts / f"{run.family}.ys").read_text()
    cells, mapping = ((options.scripts / f"xilinx_{name}.ys").read_text()
                      for name in ("cells", "map"))
    if run.design.limits:
        command_line = re.search(r"synth_xilinx .*-run ", script)
        cells = f"{command_line[0]}begin:prepare" if command_line else ""
    if not memory and not any(DECLARES_MEMORY.search(read(file)) for file in files):
        script = script.replace("@NO_MEMORY@", NO_MEMORY).replace("-run map_memory:",
                                                                  "-run map_ffram:")
    orders = ""
    # the design is elaborated a second time, because a copy of the first elaboration would change
    # the first mapping
    if run.orders:
        orders = f"design -reset\n{script.partition('@MAP@')[0]}design -save unmapped\n"
    for order in range(1, run.orders + 1):
        permuted = mapping.replace("@ORDER@", f"permute,-S,{order};strash;")
        orders += (f"design -load unmapped\n{permuted}select A:top\n"
                   f"json -o {netlist_of_order(run.netlist, order)}\nselect -clear\n")
    # "ORDERS" is replaced first, because its text contains some of the other placeholders.
    for place, text in (("MAP", mapping.replace("@ORDER@", "")), ("ORDERS", orders),
                        ("NO_MEMORY", ""), ("CELLS", cells), ("MORE", more), ("SOURCES", sources),
                        ("INCLUDES", includes), ("PARAMETERS", parameters),
                        ("TOP", run.design.top), ("OUTPUT", output)):
        script = script.replace(f"@{place}@", str(text))
    return script


def yosys_by(script, output, options):
    """Runs a script that writes `output` with Yosys. `output` is written completely or not at
    all."""
    part, log = pathlib.Path(f"{output}.part"), output.with_suffix(".log")
    write(output.with_suffix(".ys"), script(part))
    status, said = command([options.yosys, "-q", "-s", output.with_suffix(".ys")])
    write(log, said)
    if status:
        errors = [line for line in said.splitlines() if "ERROR" in line] or said.splitlines()[-1:]
        if re.search(r"\.sv:\d+: ERROR: syntax error", errors[0], re.I):
            errors.append("SystemVerilog that this Yosys does not read: tests and flights have it "
                          "as it is; a netlist needs what sv2v makes of it "
                          "(docs/guides/foreign-core.md)")
        raise Stop("\n".join([*errors, f"whole log: {log}"]))
    if output.exists() and output.read_bytes() == part.read_bytes():
        part.unlink()  # the old file is kept, so that files made from it remain valid
    else:
        part.replace(output)


def synthesise(run, library, options):
    more, memory = "", False
    while True:
        try:
            yosys_by(lambda part: script_of(run, library, options, part, more, memory),
                     run.netlist, options)
            return
        except Stop as stop:
            if "referenced in module" in str(stop) and not more:
                more = "+/xilinx/cells_xtra.v"
            elif "Assertion failed" in str(stop) and not memory:
                memory = True
            else:
                raise


def figures_of(n, spartan6, files_along):
    """Returns the figures of one netlist. Timing and nets are only computed for Spartan-6."""
    owner = owners.owners_of(n, files_along)
    types = [cell.type for cell in n.cells]
    costs = owners.costs_of(n, owner)
    total = sum((cost for signals in costs.values() for cost in signals.values()), owners.Cost())
    figures = {"cells": {type: types.count(type) for type in sorted(set(types))},
               "lut": total.lut, "ff": total.ff, "carry": total.carry, "ram": total.ram,
               "dsp": total.dsp, "lutRam": sum(netlist.MEMORY_LUTS.get(t, 0) for t in types),
               "shift": sum(map(netlist.is_shift_register, types)),
               # Ports that leave the chip, without the ports of the memory controller.
               "pins": sum(len(p.bits) for p in n.ports if not p.name.startswith("mcb_")),
               "costs": costs, "timing": {"paths": [], "ends": [], "pads": []},
               "nets": {"fanouts": [], "clocks": [], "resets": []}, "places": {}, "mhz": 0,
               **slices.slices_of(n)}
    if spartan6:
        figures["timing"], by_clock = timing.timing_of(n, owner)
        figures["timing"]["pads"] = timing.pads_of(n, owner)
        figures["nets"] = nets.nets_of(n, owner, by_clock)
        figures["places"] = places_of(n, figures)
        if figures["timing"]["paths"]:
            figures["mhz"] = 1000 / (figures["timing"]["paths"][0]["ns"] * timing.SLOW_GRADE)
    return figures


def places_of(n, figures):
    """Returns the file and line of each signal that the report names."""
    named = {f"{path}.{signal}" if path else signal
             for path, signals in figures["costs"].items() for signal in signals}
    for path in figures["timing"]["paths"]:
        named |= {path["from"], path["to"], *(step[1] for step in path["steps"])}
    named |= {net["name"] for list in figures["nets"].values() for net in list}
    return {nets.without_index(signal): at for signal in sorted(named)
            if (at := nets.place_of(n, signal))}


def together(orders):
    """Returns the figures of a design that was mapped several times, with its ports in different
    orders. The counts are those of the mapping with the median number of LUTs. Clock and longest
    paths are those of the mapping with the median clock; "slowest" has the longest paths of the
    slowest mapping, and "pads" the longest path of each pad in any mapping."""
    if len(orders) == 1:
        return orders[0] | {"luts": [orders[0]["lut"]], "clocks": [orders[0]["mhz"]]}
    by_lut = sorted(orders, key=lambda figures: figures["lut"])
    by_clock = sorted(orders, key=lambda figures: figures["mhz"])
    middle, setting, slowest = by_lut[len(orders) // 2], by_clock[len(orders) // 2], by_clock[0]
    pads = {}  # (kind, port) -> the longest path over all mappings
    for path in (path for figures in orders for path in figures["timing"]["pads"]):
        key = path["kind"], path["port"]
        pads[key] = max(path, pads.get(key, path), key=lambda p: p["ns"])
    return middle | {
        "timing": setting["timing"] | {"slowest": slowest["timing"]["paths"],
                                       "pads": list(pads.values())},
        "sites": sorted(figures["sites"] for figures in orders)[len(orders) // 2],
        "nets": setting["nets"], "mhz": setting["mhz"],
        "places": slowest["places"] | setting["places"] | middle["places"],
        "luts": [f["lut"] for f in by_lut], "clocks": [f["mhz"] for f in by_clock]}


def read_figures(text):
    figures = json.loads(text)
    for signals in figures["costs"].values():
        for signal, cost in signals.items():
            signals[signal] = owners.Cost(*cost)
    return figures


def place(run, library, options, version):
    """Sets run.netlist to the path at which Yosys writes the netlist of these sources."""
    # cleared first, so that the hash does not depend on the path of the output
    run.netlist = pathlib.Path()
    sources = digest([library.hash_of(run.design.top), version,
                      script_of(run, library, options, "")])
    run.netlist = options.cache / f"{run.design.name}.{run.family}.{sources}.json"


def carry_out_one(run, library, options, version):
    """Carries out one run. Returns whether the synthesis succeeded."""
    top = run.design.top
    place(run, library, options, version)
    stem, kept = f"{run.design.name}.{run.family}.", run.netlist.with_suffix(f".{TOOL}.figures")
    is_new = not run.netlist.exists()
    run.known = is_new and any(options.cache.glob(f"{stem}*.json"))
    if is_new and not run.wanted:
        run.error = "not synthesised since its sources changed"
        return False
    if not is_new and kept.exists():
        run.figures = read_figures(kept.read_text())
        return False
    if is_new:
        synthesise(run, library, options)
    files = [run.netlist] + [netlist_of_order(run.netlist, n + 1) for n in range(run.orders)]
    run.figures = together([figures_of(netlist.read_netlist(file), run.family == "xc6s",
                                       lambda path: library.files_along(top, path))
                            for file in files])
    write(kept, json.dumps(run.figures))
    return is_new


# Yosys' models of a family's primitives.
SIMULATION = {"xc6s": "+/xilinx/cells_sim.v", "ecp5": "+/ecp5/cells_sim.v"}


def filled(script, words):
    for name, value in words.items():
        script = script.replace(f"@{name}@", str(value))
    return script


def mapped(design, family, library, options):
    """Returns a run of the design whose netlist exists. This is a run with all orders, whose first
    netlist is used, or a run without orders, which is carried out if necessary."""
    options.cache.mkdir(parents=True, exist_ok=True)
    version = version_of(options.yosys)
    for orders in (design.orders, 0):
        run = Run(dataclasses.replace(design, orders=orders), family)
        place(run, library, options, version)
        if run.netlist.exists():
            return run
    synthesise(run, library, options)
    return run


def write_for_simulation(design, family, library, options, file, models):
    """Writes the netlist from which the figures of a design are computed as Verilog. All its
    primitives have models."""
    run = mapped(design, family, library, options)
    words = {"NETLIST": file.with_suffix(".json"), "TOP": design.top,
             "SIMULATION": SIMULATION[run.family], "MODELS": " ".join(map(str, models))}
    file.parent.mkdir(parents=True, exist_ok=True)
    write(file.with_suffix(".json"), netlist.with_models(run.netlist))
    scripts = (options.scripts / "simulate.ys").read_text()
    yosys_by(lambda part: filled(scripts, {**words, "OUTPUT": part}), file, options)


def write_edif(design, library, options, folder):
    """Writes a design as EDIF into FOLDER/<name>.edf with the script edif.ys, and as Verilog into
    FOLDER/verilog."""
    verilog = folder / "verilog"
    shutil.rmtree(verilog, ignore_errors=True)
    verilog.mkdir(parents=True)
    headers = {file.name: file for include in reversed(library.include_folders)
               # if two folders contain a file of the same name, the file in the first folder is
               # used
               for file in include.glob("*.vh")}
    for file in [*headers.values(), *library.files_of(design.top)]:
        shutil.copy(file, verilog)
    run = Run(design, "edif", netlist=folder / f"{design.name}.edf")
    synthesise(run, library, options)
    os.replace(f"{run.netlist}.part.json", folder / f"{design.name}.json")
