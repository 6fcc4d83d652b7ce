# SPDX-License-Identifier: MIT
"""netlist: represents a flat, mapped netlist from Yosys (write_json) as a graph of cells and bits.

Yosys numbers the bits, starting with 2; negative numbers stand for constants.
"""
import dataclasses
import functools
import json
import pathlib
import re
import typing

ZERO, ONE, UNDEFINED = -1, -2, -3

# Number of LUTs that each kind of memory cell takes.
MEMORY_LUTS = {
    "RAM32M": 4, "RAM64M": 4, "RAM32X1D": 2, "RAM64X1D": 2, "RAM16X1D": 2, "RAM128X1D": 4,
    "RAM32X1S": 1, "RAM64X1S": 1, "RAM16X1S": 1, "RAM128X1S": 2, "RAM256X1S": 4, "RAM32X2S": 2,
    "RAM64X2S": 2, "RAM32X4S": 4, "RAM32X8S": 8, "RAM64X1S_1": 1,
    "TRELLIS_DPR16X4": 6,  # four LUTs of data and two of the write port
}
LUT_INPUTS = {"INV": 1} | {f"LUT{n}": n for n in range(1, 7)}
LATCHES = {"LDCE", "LDPE", "LDCPE", "LD"}
BLOCK_RAMS = {"RAMB8BWER": 0.5, "RAMB16BWER": 1, "RAMB18E1": 1, "DP16KD": 1, "PDPW16KD": 1,
              "RAMB36E1": 2}


def is_shift_register(type):
    return type.startswith("SRL")


def is_memory(type):
    """Returns whether a cell consists of LUTs used as memory."""
    return type in MEMORY_LUTS or is_shift_register(type)


def is_register(type):
    """Returns whether a cell is a flip-flop or a latch."""
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
    named: bool = False  # True: the name is from the design, not from the tool
    # file names of the modules that contain the cell, and of the module that instantiates them
    sources: frozenset = frozenset()

    def bits(self, port):
        return next((pin.bits for pin in self.pins if pin.port == port), [])

    def bit(self, port):
        """Returns the bit of a port with one bit; UNDEFINED if the port is not connected."""
        return (self.bits(port) or [UNDEFINED])[0]


class Name(typing.NamedTuple):
    """A name that the source gives to a bit, such as "u_modem.u_at.state", and the bit's index in
    the vector, or -1 if it is not a vector."""
    name: str
    index: int = -1  # type: ignore[assignment]  # tuple.index is not used

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
        self.names = {}    # bit -> its Names; the first is most likely the name that the driver has
        self.sources = {}  # name -> value of its attribute src, set by Yosys
        self.driver = {}   # bit -> number of the cell that drives it
        self.readers = {}  # bit -> numbers of the cells that read it
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
        """Returns the first name of a bit with its index; "" if the source has no name for the
        bit."""
        return str(self.names[bit][0]) if bit in self.names else ""

    def driver_type(self, bit):
        """Returns the type of the cell that drives a bit; "" if no cell drives it."""
        return self.cells[self.driver[bit]].type if bit in self.driver else ""

    def fanout(self, bit):
        return len(self.readers.get(bit, ()))


@functools.lru_cache(1 << 16)
def rank(name):
    """Returns the sort key of a name of a bit. The most useful name is sorted first: not a name
    made by GHDL (n123_o), not an input of an inner block, and as deep in the hierarchy as possible,
    because outer blocks only pass outputs on."""
    last = name.rpartition(".")[2]
    return (bool(re.match(r"n\d+(_|$)", last)), len(last) > 2 and last.endswith("_i"),
            -name.count("."), len(name), name)


@functools.lru_cache(1 << 16)
def files_of(attribute):
    """Returns the names of the design's files in an attribute src:
    "hdl/soc.v:1.2-3.4|/usr/share/yosys/xilinx/ff_map.v:5.6-7.8" gives {"soc.v"}."""
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
        if cell["type"][0] == "$":  # a cell such as $scopeinfo, which is not hardware
            continue
        pins = [Pin(port, cell["port_directions"][port] == "output", bits_of(bits))
                for port, bits in sorted(cell["connections"].items())]
        n.add(Cell(name, cell["type"], pins, cell["hide_name"] == 0,
                   files_of(cell["attributes"].get("src", ""))))
    for name, net in sorted(module["netnames"].items()):
        if net["hide_name"] != 0 or "$func$" in name:  # a hidden name, or a wire of a function call
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


# Ports of Spartan-6 block RAMs, in the order of the ports in synth/primitives/block_ram.v. "SDP" is
# the RAMB8BWER with words of 36 bits: port A writes and port B reads.
RAM_PORTS = {
    "RAMB16BWER": "CLKA ENA RSTA WEA ADDRA DIA+DIPA DOA+DOPA "
                  "CLKB ENB RSTB WEB ADDRB DIB+DIPB DOB+DOPB",
    "RAMB8BWER": "CLKAWRCLK ENAWREN RSTA WEAWEL ADDRAWRADDR DIADI+DIPADIP DOADO+DOPADOP "
                 "CLKBRDCLK ENBRDEN RSTBRST WEBWEU ADDRBRDADDR DIBDI+DIPBDIP DOBDO+DOPBDOP",
    "SDP": "CLKAWRCLK ENAWREN RSTA WEAWEL+WEBWEU ADDRAWRADDR DIADI+DIBDI+DIPADIP+DIPBDIP - "
           "CLKBRDCLK ENBRDEN RSTBRST - ADDRBRDADDR - DOADO+DOBDO+DOPADOP+DOPBDOP"}
RAM_NAMES = [name.format(port) for port in "ab" for name in (
    "clk_{}_i", "en_{}_i", "rst_{}_i", "we_{}_i", "addr_{}_i", "data_{}_i", "data_{}_o")]
RAM_SIZES = {"clk": 1, "en": 1, "rst": 1, "we": 4, "data": 36}


def with_models(file):
    """Returns the text of a netlist (write_json) for which all cells have models: each block RAM
    becomes a block_ram, and each multiplier of ECP5 becomes a multiplier of Yosys."""
    whole = json.loads(pathlib.Path(file).read_text())
    (module,) = whole["modules"].values()
    free = 1 + max((bit for net in module["netnames"].values() for bit in net["bits"]
                    if isinstance(bit, int)), default=1)
    for net in module["netnames"].values():
        # flip-flops already have the initial value as a parameter
        net["attributes"].pop("init", None)
    for cell in module["cells"].values():
        if cell["type"] in ("RAMB16BWER", "RAMB8BWER"):
            free = make_block_ram(cell, free)
        elif cell["type"] == "DP16KD":
            free = make_block_ram_of_ecp5(cell, free)
        elif cell["type"] == "MULT18X18D":
            make_product(cell)
    return json.dumps(whole)


def make_block_ram(cell, free):
    """Changes the cell into a block_ram. Numbers of bits below `free` are in use; returns the new
    value of `free`."""
    given, log2 = cell["parameters"], 14 if cell["type"] == "RAMB16BWER" else 13
    is_wide, lanes = given.get("RAM_MODE") == "SDP", 4 if log2 == 14 else 2

    def bits(name, size):
        return given.get(name, "").rjust(size, "0")[-size:]

    def word(name, port):
        """Returns the 36 bits of a word as text: first the parity bits, then the data bits, both
        from high to low."""
        if log2 == 14:
            return bits(f"{name}_{port}", 36)
        a, own = bits(f"{name}_A", 18), bits(f"{name}_{port}", 18)
        return own[:2] + a[:2] + own[2:] + a[2:] if is_wide and port == "B" else \
            "00" + own[:2] + "0" * 16 + own[2:]

    def rows(name, count):
        return "".join(bits(f"{name}_{n:02X}", 256) for n in reversed(range(count)))

    made = {"INIT": rows("INIT", 1 << log2 - 8),
            "INIT_P": rows("INITP", 1 << log2 - 11)}
    for port in "AB":
        if int(bits(f"DO{port}_REG", 32), 2) or given.get(f"EN_RSTRAM_{port}", "TRUE") != "TRUE" \
                or (is_wide and int(bits(f"DATA_WIDTH_{port}", 32), 2) != 36):
            raise ValueError(f"block RAM {cell['type']} has a mode without a model")
        made |= {f"WIDTH_{port}": bits(f"DATA_WIDTH_{port}", 32),
                 f"MODE_{port}": given.get(f"WRITE_MODE_{port}", "WRITE_FIRST"),
                 f"PRIORITY_{port}": given.get(f"RST_PRIORITY_{port}", "CE"),
                 f"START_{port}": word("INIT", port), f"RESET_{port}": word("SRVAL", port)}
    connections = {}
    for port, names in zip(RAM_NAMES, RAM_PORTS["SDP" if is_wide else cell["type"]].split()):
        size, joined = RAM_SIZES.get(port.partition("_")[0], log2), []
        # bits that the primitive does not have are cut off, since Yosys may connect more
        for name in names.split("+"):
            room = lanes if name[:3] in ("DIP", "DOP") or name[:2] == "WE" else \
                8 * lanes if size == 36 else size
            joined += cell["connections"].get(name, [])[:room]
        # the port has only two of the four bytes and their parity bits; the bytes between are empty
        if size == 36 and len(joined) == 18:
            joined[16:16] = [None] * 16
        joined = (joined + [None] * size)[:size]
        is_output = port.endswith("_o")
        connections[port] = [bit if isinstance(bit, int) or bit and not is_output else
                             free + n if is_output else "0" for n, bit in enumerate(joined)]
        free += size
    finish_block_ram(cell, made, connections)
    return free


def finish_block_ram(cell, made, connections):
    """Completes the change of a cell into a block_ram. Rows that no address can reach are left out,
    because this makes proofs and simulations faster."""
    used = max([6] + [place + 1 for port in "ab" if int(made[f"WIDTH_{port.upper()}"], 2)
                      for place, bit in enumerate(connections[f"addr_{port}_i"]) if bit != "0"])
    connections |= {port: connections[port][:used] for port in ("addr_a_i", "addr_b_i")}
    made |= {"ADDR_BITS": f"{used:032b}", "INIT": made["INIT"][-(1 << used):],
             "INIT_P": made["INIT_P"][-(1 << used - 3):]}
    cell |= {"type": "block_ram", "parameters": made, "connections": connections,
             "port_directions": {port: "output" if port.endswith("_o") else "input"
                                 for port in connections}}


# Output of a block RAM's port while the port writes a word (Lattice FPGA-TN-02204, ECP5 memory).
ECP5_MODES = {"NORMAL": "NO_CHANGE", "WRITETHROUGH": "WRITE_FIRST",
              "READBEFOREWRITE": "READ_FIRST"}


def make_block_ram_of_ecp5(cell, free):
    """Changes the cell into a block_ram, as make_block_ram does. An ECP5 block RAM has bytes of
    nine bits. A word of 36 bits uses the data pins of both ports. Bits 0 to 3 of the address of
    such a word enable its bytes."""
    given, pins, made, connections = cell["parameters"], cell["connections"], {}, {}
    number = lambda name, low, count: given.get(name, "").replace("x", "0")[::-1][
        low:low + count].ljust(count, "0")  # noqa: E731
    words = [number(f"INITVAL_{n // 16:02X}", n % 16 * 20, 18) for n in range(1024)]
    made["INIT"] = "".join(word[0:8] + word[9:17] for word in words)[::-1]
    made["INIT_P"] = "".join(word[8] + word[17] for word in words)[::-1]

    def pin(name):
        return pins.get(name, ["0"])[0]

    for port in "AB":
        width, own = int(given.get(f"DATA_WIDTH_{port}", "10010"), 2), port.lower()
        address = [pin(f"AD{port}{n}") for n in range(14)]
        enable, bytes = pin(f"WE{port}"), max(1, width // 9)
        resets = pin(f"RST{port}")  # a write is blocked while this signal is high
        if given.get(f"REGMODE_{port}", "NOREG") != "NOREG" or width < 9 or \
                "0" not in (resets, enable) or given.get(f"CLK{port}MUX") == "INV":
            raise ValueError("block RAM DP16KD has a mode without a model")
        lanes = address[:bytes] if width > 9 and enable != "0" else ["1"] * bytes
        if enable != "1" and not {"0", "1", enable}.issuperset(lanes):
            raise ValueError("block RAM DP16KD has two kinds of enables")
        written = [lane if enable == "1" or lane == "0" else enable for lane in lanes]
        names = [f"{p}{n}" for p in ("AB" if width == 36 else port) for n in range(18)][:width]
        places = [8 * (n // 9) + n % 9 if n % 9 < 8 else 32 + n // 9 for n in range(width)]
        data, shown = ["0"] * 36, list(range(free, free + 36))
        for name, place in zip(names, places):
            data[place] = pin(f"DI{name}")
            # if WE is always 1, the port never reads, and its output pins belong to the other port
            if enable != "1":
                shown[place] = pins.get(f"DO{name}", [shown[place]])[0]
        free += 36
        low = {9: 3, 18: 4, 36: 5}[width]
        used = width if pin(f"CE{port}") != "0" else 0
        made |= {f"WIDTH_{port}": f"{used:032b}", f"PRIORITY_{port}": "SR",
                 f"MODE_{port}": ECP5_MODES[given.get(f"WRITEMODE_{port}", "NORMAL")]}
        connections |= {
            f"clk_{own}_i": [pin(f"CLK{port}")], f"en_{own}_i": [pin(f"CE{port}")],
            f"rst_{own}_i": [resets], f"we_{own}_i": (written + ["0"] * 4)[:4],
            f"addr_{own}_i": ["0"] * low + address[low:], f"data_{own}_i": data,
            f"data_{own}_o": shown}
    finish_block_ram(cell, made, connections)
    return free


def make_product(cell):
    """Changes an ECP5 multiplier without registers into a multiplier of Yosys."""
    pins, given = cell["connections"], cell["parameters"]
    signs = {pins.get(f"SIGNED{port}", ["0"])[0] for port in "AB"}
    if signs not in ({"0"}, {"1"}) or any(
            given.get(f"REG_{part}_CLK", "NONE") != "NONE"
            for part in ("INPUTA", "INPUTB", "INPUTC", "PIPELINE", "OUTPUT")):
        raise ValueError("MULT18X18D uses a mode for which there is no model")
    (sign,) = signs
    ports = {"A": ("A", 18), "B": ("B", 18), "Y": ("P", 36)}
    cell |= {
        "type": "$mul",
        "parameters": {f"{port}_SIGNED": f"{sign:>032}" for port in "AB"} |
                      {f"{port}_WIDTH": f"{width:032b}" for port, (_, width) in ports.items()},
        "connections": {port: [pins[f"{name}{n}"][0] for n in range(width)]
                        for port, (name, width) in ports.items()},
        "port_directions": {"A": "input", "B": "input", "Y": "output"}}
