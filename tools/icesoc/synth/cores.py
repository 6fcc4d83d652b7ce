# SPDX-License-Identifier: MIT
"""cores: computes the cost of each core in the chip. The cost has five parts: the core itself, its
registers, its slot in the bus decoder, its memory port, and its share of the memory arbiter."""
import re

from icesoc.regs.model import Block
from icesoc.synth import report
from icesoc.synth.owners import Cost
from icesoc.synth.batch import carry_out
from icesoc.synth.synthesis import Run
from icesoc.synth.sources import Design
from icesoc.util.errors import Stop

FIRST_SLOT = 2  # lower slots belong to the platform


class NotInChip(Stop):
    """The chip lacks the requested core."""


def read_map(file):
    """Returns the numbers in the chip's address map by name, such as SLOT_FIR; {} if the file does
    not exist."""
    if not file.exists():
        return {}
    return {c.name: c.value for c in Block.read(file, is_built=True).constants}


def slot_cost(library, options, map, wanted):
    """Returns the cost of one slot in the decoder: the cost of the bus decoder with the chip's
    number of slots, minus its cost with one slot fewer. If `wanted` is False, both costs are only
    taken from the cache, and the result is zero if one is missing."""
    runs = [Run(Design(f"bus_decoder{slots}", "bus_decoder", parameters={"SLOTS": slots}), "xc6s",
                wanted) for slots in (map["SLOT_COUNT"], map["SLOT_COUNT"] - 1)]
    carry_out(runs, library, options)
    for run in runs:
        if run.error and wanted:
            raise Stop(f"{run.design.name}: {run.error}")
    if any(run.error for run in runs):
        return Cost()
    more, fewer = (run.figures for run in runs)
    return Cost(lut=more["lut"] - fewer["lut"], ff=more["ff"] - fewer["ff"])


def core_table(costs, map, slot, names, where):
    """Returns a table with a row for each core that is in the address map and in the chip, or only
    for the cores `names`. The core with the most LUTs is first. A row has the sums of LUTs,
    flip-flops, block RAM and DSP, then LUTs / flip-flops of each part of the core. The cost of the
    memory arbiter, apart from its ports, is divided by the number of ports. Raises NotInChip if the
    chip lacks a name. `where`: text that names the source of the chip's figures."""
    def cost_of(pattern):
        return sum((cost for path, signals in costs.items() if re.fullmatch(pattern, path)
                    for cost in signals.values()), Cost())

    def row(name):
        whole = cost_of(rf"u_{name}(\..*)?")
        registers = cost_of(rf"u_{name}\.(u_core\.)?u_(wrapper|registers|bus|crossing)(\..*)?")
        port = shared = Cost()
        number = map.get(f"NPI_PORT_{name.upper()}")
        if number is not None:
            port = cost_of(rf"u_platform\.u_memory\.u_arbiter\.g_port\[{number}\].*")
            shared = cost_of(r"u_platform\.u_memory(?!\.u_arbiter\.g_port\[).*")
            ports = map["NPI_PORT_COUNT"]
            shared = Cost(lut=shared.lut // ports, ff=shared.ff // ports)
        itself = Cost(lut=whole.lut - registers.lut, ff=whole.ff - registers.ff)
        sum_ = whole + slot + port + shared
        return [name, sum_.lut, sum_.ff, f"{sum_.ram:g}", sum_.dsp,
                *(f"{c.lut} / {c.ff}" if any(c) else "" for c in (itself, registers, slot, port,
                                                                 shared))]

    slots = sorted((number, constant[5:].lower()) for constant, number in map.items()
                   if constant.startswith("SLOT_") and constant != "SLOT_COUNT"
                   and number >= FIRST_SLOT)
    cores = [name for _, name in slots if any(cost_of(rf"u_{name}(\..*)?"))]
    for name in names:
        if name not in cores:
            first = (f"./icesoc core synth {name} --chip measures the chip with it" if
                     f"SLOT_{name.upper()}" in map else f"add the line '{name}' to ip/cores.list, "
                     f"then run ./icesoc core synth {name} --chip")
            raise NotInChip(f"{name} is not in the chip of {where}: {first}")
    return report.Table(["core in the chip", "LUT", "FF", "RAM16", "DSP", "itself", "registers",
                         f"slot {map['SLOT_COUNT']}", "memory port", "arbiter"],
                        sorted((row(name) for name in cores if not names or name in names),
                              key=lambda cells: -cells[1]))
