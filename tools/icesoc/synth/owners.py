# SPDX-License-Identifier: MIT
"""owners: finds the owner of each cell of a flat netlist, and the cost of each owner. An owner is a
signal of the source, with its instance path.

The owner of a flip-flop is its register. The owner of logic is the named wire that the logic
drives. If optimisation has removed the name, it is the owner of the cells that the logic drives
most often.
"""
import re
import typing

from icesoc.synth import netlist
from icesoc.synth.netlist import BLOCK_RAMS, LUT_INPUTS, MEMORY_LUTS

COMBINATIONAL = {*LUT_INPUTS, "CARRY4", "MUXF7", "MUXF8", "CCU2C", "PFUMX", "L6MUX21"}
DECODER = "u_platform.u_bus_decoder"


class Cost(typing.NamedTuple):
    lut: int = 0     # number of look-up tables, including those used as memory
    memory: int = 0  # number of LUTs used as memory or shift register; `lut` includes them
    ff: int = 0      # number of flip-flops and latches
    carry: int = 0   # number of carry chain segments of 4 bits
    ram: float = 0   # number of block RAMs of 16 or 18 Kbit; half a block RAM counts as 0.5
    dsp: int = 0

    def __add__(self, other):
        return Cost(*(a + b for a, b in zip(self, other)))


def cost_of(cell):
    type = cell.type
    memory = MEMORY_LUTS.get(type, 0) + netlist.is_shift_register(type)
    return Cost(lut=memory + (type in LUT_INPUTS) + 2 * (type == "CCU2C"), memory=memory,
                ff=int(netlist.is_register(type)), carry=int(type in ("CARRY4", "CCU2C")),
                ram=BLOCK_RAMS.get(type, 0), dsp=int(netlist.is_multiplier(type)))


def costs_of(n, owners):
    """Returns {instance path: {signal: Cost}}; the path of the top is ""."""
    costs = {}
    for cell, owner in zip(n.cells, owners):
        cost = cost_of(cell)
        if any(cost):
            path, _, signal = owner.rpartition(".")
            signals = costs.setdefault(path, {})
            signals[signal] = signals.get(signal, Cost()) + cost
    return costs


def owners_of(n, files_along):
    """Returns the owner of each cell: a signal with its path, such as "u_modem.u_at.state"; "" if
    no cell near it has a name. `files_along(path)` returns the names of the files of the modules
    along an instance path."""
    finder = Finder(n, files_along)
    owners = [finder.owner_of(cell) for cell in range(len(n.cells))]
    give_slot_reads(n, owners)
    return owners


class Finder:
    def __init__(self, n, files_along):
        self.n, self.files_along = n, files_along
        self.files = {}
        # cell -> owner; None while the owner is being determined, so that a loop ends
        self.owners = {}

    def owner_of(self, index):
        if index not in self.owners:
            self.owners[index] = None
            self.owners[index] = self.find(self.n.cells[index])
        return self.owners[index]

    def find(self, cell):
        if cell.named and cell.type not in COMBINATIONAL:
            # a memory cell such as "u_fifo.words.0.1" belongs to the memory "u_fifo.words"
            return re.sub(r"(\.\d+)+$", "", cell.name)
        driven = [bit for pin in cell.pins if pin.output for bit in pin.bits]
        for bit in driven:
            if bit in self.n.names:
                return self.name_for(cell, self.n.names[bit])
        votes = {}
        for bit in driven:
            for reader in self.n.readers.get(bit, ()):
                owner = self.owner_of(reader)
                if owner:
                    votes[owner] = votes.get(owner, 0) + 1
        return max(sorted(votes), key=votes.get, default="")

    def name_for(self, cell, names):
        """Returns the best of several names of one net: a name in the module that contains the
        cell."""
        for name in names:
            path = name.name.rpartition(".")[0]
            if path not in self.files:
                self.files[path] = self.files_along(path)
            if self.files[path] == cell.sources:
                return name.name
        return names[0].name


def give_slot_reads(n, owners):
    """Assigns logic that reads registers to the block in the slot. Optimisation merges this logic
    with the multiplexer of the bus decoder and removes its names, so all of it is first assigned to
    the decoder. Logic whose inputs come from only one block and the decoder is then assigned to
    that block."""
    behind = {}

    def block_of(cell):
        return re.match(r"(u_platform\.)?[^.]*", owners[cell])[0]

    def is_inside(cell):
        return n.cells[cell].type in COMBINATIONAL and block_of(cell) == DECODER

    def blocks_behind(cell):
        if cell in behind:
            return behind[cell]
        blocks = behind[cell] = set()
        for pin in n.cells[cell].pins:
            for bit in pin.bits:
                if pin.output or bit not in n.driver:
                    continue
                driver = n.driver[bit]
                if is_inside(driver):
                    blocks |= blocks_behind(driver)
                elif owners[driver] and block_of(driver) != DECODER:
                    blocks.add(block_of(driver))
        return blocks

    for cell in range(len(n.cells)):
        if is_inside(cell):
            blocks_behind(cell)
    for cell, blocks in behind.items():
        if len(blocks) == 1:
            owners[cell] = f"{min(blocks)}.bus_rdata_o"
