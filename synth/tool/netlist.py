# SPDX-License-Identifier: MIT
"""netlist: a flat, mapped netlist as Yosys writes it (write_json), as a graph of cells and bits.

Bits are numbered by Yosys from 2; negative numbers stand for constants.
"""
import dataclasses
import functools
import json
import pathlib
import re
import typing

ZERO, ONE, UNDEFINED = -1, -2, -3

# LUTs that a memory cell takes.
MEMORY_LUTS = {
    "RAM32M": 4, "RAM64M": 4, "RAM32X1D": 2, "RAM64X1D": 2, "RAM16X1D": 2, "RAM128X1D": 4,
    "RAM32X1S": 1, "RAM64X1S": 1, "RAM16X1S": 1, "RAM128X1S": 2, "RAM256X1S": 4, "RAM32X2S": 2,
    "RAM64X2S": 2, "RAM32X4S": 4, "RAM32X8S": 8, "RAM64X1S_1": 1,
    "TRELLIS_DPR16X4": 6,  # four of data and two of the write port
}
LUT_INPUTS = {"INV": 1} | {f"LUT{n}": n for n in range(1, 7)}
LATCHES = {"LDCE", "LDPE", "LDCPE", "LD"}
BLOCK_RAMS = {"RAMB8BWER": 0.5, "RAMB16BWER": 1, "RAMB18E1": 1, "DP16KD": 1, "PDPW16KD": 1,
              "RAMB36E1": 2}


def is_shift_register(type):
    return type.startswith("SRL")


def is_memory(type):
    """LUTs used as memory."""
    return type in MEMORY_LUTS or is_shift_register(type)


def is_register(type):
    """A flip-flop or a latch."""
    return is_flip_flop(type) or type in LATCHES


def is_flip_flop(type):
    return type == "TRELLIS_FF" or (type.startswith("FD") and len(type) <= 6)


def is_multiplier(type):
    return type.startswith("DSP48") or type in ("MULT18X18D", "ALU54B")


def is_clock(port):
    return port == "C" or port.startswith("CLK") or port == "WCLK"


class Pin(typing.NamedTuple):
    port: str
    output: bool
    bits: list


@dataclasses.dataclass(slots=True)
class Cell:
    name: str
    type: str
    pins: list
    named: bool = False  # the name is the design's, not the tool's
    sources: frozenset = frozenset()  # file names of the block it comes from and its instances

    def bits(self, port):
        return next((pin.bits for pin in self.pins if pin.port == port), [])

    def bit(self, port):
        """The only bit of a port, UNDEFINED where there is none."""
        return (self.bits(port) or [UNDEFINED])[0]


class Name(typing.NamedTuple):
    """A name that the source gives a bit: "u_modem.u_at.state", and the index in a vector or -1."""
    name: str
    index: int = -1

    def __str__(self):
        return self.name if self.index < 0 else f"{self.name}[{self.index}]"


class Port(typing.NamedTuple):
    name: str
    input: bool
    output: bool
    bits: list


class Netlist:
    def __init__(self, cells=(), top=""):
        self.top = top
        self.cells, self.ports = [], []
        self.names = {}    # bit -> its Names, first the one that most likely is its driver's
        self.sources = {}  # name -> Yosys' attribute src
        self.driver = {}   # bit -> cell's number
        self.readers = {}  # bit -> cells' numbers
        for cell in cells:
            self.add(cell)

    def add(self, cell):
        for pin in cell.pins:
            for bit in pin.bits:
                if bit < 0:
                    continue
                if pin.output:
                    self.driver[bit] = len(self.cells)
                else:
                    self.readers.setdefault(bit, []).append(len(self.cells))
        self.cells.append(cell)

    def name_of(self, bit):
        """Name with index, "" if the source has no name for the bit."""
        return str(self.names[bit][0]) if bit in self.names else ""

    def driver_type(self, bit):
        """The type of the cell that drives a bit, "" if none does."""
        return self.cells[self.driver[bit]].type if bit in self.driver else ""

    def fanout(self, bit):
        return len(self.readers.get(bit, ()))


@functools.lru_cache(1 << 16)
def rank(name):
    """Orders the names of one bit: the driver's has no name of GHDL's (n123_o), is not an input of
    the block below, and is the deepest, since outputs are passed up."""
    last = name.rpartition(".")[2]
    return (bool(re.match(r"n\d+(_|$)", last)), len(last) > 2 and last.endswith("_i"),
            -name.count("."), len(name), name)


@functools.lru_cache(1 << 16)
def files_of(attribute):
    """"hdl/soc.v:1.2-3.4|/usr/share/yosys/xilinx/ff_map.v:5.6-7.8" -> {"soc.v"}"""
    return frozenset(place.rpartition(":")[0].rpartition("/")[2] for place in attribute.split("|")
                     if place and "/share/yosys/" not in place)


def read_netlist(file):
    modules = json.loads(pathlib.Path(file).read_text()).get("modules", {})
    if len(modules) != 1:
        raise ValueError(f"{file} is not a netlist of one module")
    (top, module), = modules.items()
    constants = {"0": ZERO, "1": ONE}

    def bits_of(bits):
        return [bit if isinstance(bit, int) else constants.get(bit, UNDEFINED) for bit in bits]

    n = Netlist(top=top)
    for name, port in sorted(module["ports"].items()):
        n.ports.append(Port(name, port["direction"] != "output", port["direction"] != "input",
                            bits_of(port["bits"])))
    for name, cell in sorted(module["cells"].items()):
        if cell["type"][0] == "$":  # scopes and the like, no hardware
            continue
        pins = [Pin(port, cell["port_directions"][port] == "output", bits_of(bits))
                for port, bits in sorted(cell["connections"].items())]
        n.add(Cell(name, cell["type"], pins, cell["hide_name"] == 0,
                   files_of(cell["attributes"].get("src", ""))))
    for name, net in sorted(module["netnames"].items()):
        if net["hide_name"] != 0:
            continue
        n.sources[name] = net["attributes"].get("src", "")
        bits = bits_of(net["bits"])
        for i, bit in enumerate(bits):
            if bit >= 0:
                index = i + net.get("offset", 0) if len(bits) > 1 else -1
                n.names.setdefault(bit, []).append(Name(name, index))
    for names in n.names.values():
        names.sort(key=lambda name: rank(name.name))
    return n
