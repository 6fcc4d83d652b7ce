# SPDX-License-Identifier: MIT
"""timing: estimates the longest paths of a Spartan-6 netlist, as XST does before placement.

The delays of cells are those that XST 14.7 prints for speed grade -3. The delay of a net depends
only on its fan-out. Grade -2 is slower by the factor SLOW_GRADE. Clock skew and placement are not
known here; ROUTED is the ratio of published clocks to our estimates. Paths between pads and
registers include the buffers that XST inserts (pads_of).
"""
import typing

from icesoc.synth import netlist
from icesoc.synth.netlist import LUT_INPUTS
from icesoc.synth.slices import Range

# Approximate ratio of the delays of grade -2 to the delays of grade -3. In DS162, the delays of
# grade -2 and -3 are 0.26 and 0.21 ns for a LUT, and 0.53 and 0.45 ns from clock to output.
SLOW_GRADE = 1.2

# delays, ns, grade -3
CLOCK_TO_OUT, LUT, SETUP, ENABLE_SETUP, RESET_SETUP = 0.447, 0.205, 0.102, 0.322, 0.430
CARRY_IN, CARRY_BIT, CARRY_OUT, WIDE_MUX = 0.172, 0.019, 0.180, 0.140
RAM_CLOCK, RAM_SETUP, LUT_RAM_CLOCK, LUT_RAM_SETUP = 1.850, 0.400, 0.900, 0.300
MULTIPLIER_CLOCK, MULTIPLIER_SETUP, MULTIPLY, MULTIPLIER_ADD = 4.700, 1.500, 4.560, 2.687
# (fan-out, delay in ns) of a net; delays between these points are interpolated
NET_DELAYS = ((0, 0.0), (1, 0.580), (2, 0.617), (5, 0.715), (16, 1.004), (26, 1.207), (88, 1.799))

# delays of the input and output buffer of LVCMOS, ns
PAD_IN, PAD_OUT = 1.222, 2.571

# Ratio of the published clock after routing to the estimated clock: median, and range that contains
# 90 % of `count` designs. The estimate for each design is fitted to the others (published.py).
ROUTED = Range(median=1.22, low=0.92, high=1.57, count=11)


def delay_range(ns):
    """Returns the range of a delay after routing, as text. Nine of ten published longest paths are
    in such a range."""
    return f"{ns / ROUTED.high:.1f}-{ns / ROUTED.low:.1f}"


def net_delay(fanout):
    pairs = list(zip(NET_DELAYS, NET_DELAYS[1:]))
    (x0, y0), (x1, y1) = next((pair for pair in pairs if fanout <= pair[1][0]), pairs[-1])
    return y0 + (y1 - y0) * (min(fanout, 200) - x0) / (x1 - x0)


def is_block_ram(type):
    return type.startswith("RAMB")


def is_combinational(type):
    return type in LUT_INPUTS or type.startswith("MUXF") or type == "CARRY4"


def is_unclocked(cell):
    """Returns whether a cell is logic, including a multiplier without registers."""
    return is_combinational(cell.type) or (cell.type.startswith("DSP48") and cell.bit("CLK") < 0)


def is_read(address, output):
    """Returns whether the output of a memory depends on this address port: DOA depends on ADDRA,
    DPO on DPRA0.., SPO on A0... No output depends on the write port, or on a port that is not an
    address."""
    if address.startswith("ADDR"):
        return len(output) < 3 or address[-1] == output[2]
    if address.startswith("DPRA"):
        return output == "DPO"
    return address[0] == "A" and output != "DPO"


def is_read_only(port):
    """Returns whether the port is an address that only reads. No path ends at such a port."""
    return port in ("ADDRA", "ADDRB", "ADDRC") or port.startswith("DPRA")


def start_delay(type):
    if is_block_ram(type):
        return RAM_CLOCK
    if type.startswith("DSP48"):
        return MULTIPLIER_CLOCK
    return CLOCK_TO_OUT if netlist.is_register(type) else LUT_RAM_CLOCK


def end_delay(type, port):
    if is_block_ram(type):
        return RAM_SETUP
    if type.startswith("DSP48"):
        return MULTIPLIER_SETUP
    if netlist.is_register(type):
        return {"D": SETUP, "CE": ENABLE_SETUP}.get(port, RESET_SETUP)
    return LUT_RAM_SETUP


def through_delay(cell, pin, i, to, o):
    """Returns the delay of a combinational cell from bit `i` of a pin to bit `o` of an output; None
    if the cell has no such path."""
    if cell.type.startswith("DSP48"):
        return MULTIPLIER_ADD if pin.port == "C" else MULTIPLY
    if cell.type != "CARRY4":
        return WIDE_MUX if cell.type.startswith("MUXF") else LUT
    single = pin.port in ("CI", "CYINIT")
    if not single and i > o:
        return None
    entry = CARRY_BIT * o if single else CARRY_IN + CARRY_BIT * (o - i)
    return entry + (CARRY_OUT if to.port == "O" else CARRY_BIT)


class Arrival(typing.NamedTuple):
    ns: float
    levels: int
    cell: int    # number of the cell that drives the bit
    before: int  # previous bit of the path; None at the start of the path
    delay: float


class Analysis:
    def __init__(self, n, pads=frozenset()):
        """Paths begin at clocked cells or, if `pads` are given, at these bits of input pads."""
        self.n = n
        self.pads = pads
        self.known = {}
        self.nets = {bit: net_delay(len(readers)) for bit, readers in n.readers.items()}

    def at(self, bit):
        """Returns the latest Arrival at a bit; None if no path leads there."""
        if bit not in self.known:
            self.known[bit] = None  # ends a loop
            self.known[bit] = self.arrive(bit)
        return self.known[bit]

    def net(self, bit, reader):
        """Returns the delay of a net. The delay from a LUT to the flip-flop, wide multiplexer or
        carry cell next to it is 0."""
        if reader is None:  # no cell reads the bit: it leads to an output pad
            return net_delay(len(self.n.readers.get(bit, [])) + 1)
        source, to = self.n.driver_type(bit), self.n.cells[reader].type
        if source == "CARRY4" and to == "CARRY4":
            return 0
        joined = netlist.is_flip_flop(to) or to.startswith("MUXF") or to == "CARRY4"
        if joined and is_combinational(source) and self.n.fanout(bit) == 1:
            return 0
        return self.nets.get(bit, 0)

    def arrive(self, bit):
        if bit in self.pads:
            return Arrival(PAD_IN, 0, None, None, PAD_IN)
        if bit not in self.n.driver:
            return None
        index = self.n.driver[bit]
        cell = self.n.cells[index]
        memory, best = netlist.is_memory(cell.type), None
        if not is_unclocked(cell):
            delay = start_delay(cell.type)
            if not self.pads:
                best = Arrival(delay, 0, index, None, delay)
            if not memory:
                return best
        to, o = next((pin, pin.bits.index(bit)) for pin in cell.pins
                     if pin.output and bit in pin.bits)
        for pin in cell.pins:
            if pin.output or (memory and not is_read(pin.port, to.port)):
                continue
            chain = cell.type == "CARRY4" and pin.port in ("CI", "CYINIT")
            for i, source in enumerate(pin.bits):
                before = self.at(source) if source >= 0 else None
                delay = LUT if memory else through_delay(cell, pin, i, to, o)
                if before is None or delay is None:
                    continue
                ns = before.ns + self.net(source, index) + delay
                if best is None or ns > best.ns:
                    best = Arrival(ns, before.levels + (not chain), index, source, delay)
        return best

    def steps(self, bit, reader):
        """Returns the path to a bit, and the bit at which the path begins. The path has one step
        per cell: [cell, net, fan-out, ns of the cell, ns of the net after the cell]."""
        steps = []
        while True:
            arrival = self.at(bit)
            type = "IBUF" if arrival.cell is None else self.n.cells[arrival.cell].type
            steps.insert(0, [type, self.n.name_of(bit),
                             self.n.fanout(bit), arrival.delay, round(self.net(bit, reader), 3)])
            if arrival.before is None:
                return steps, bit
            reader, bit = arrival.cell, arrival.before


def start_name(n, owners, bit):
    """Returns the name of the register or memory that drives a bit. If it has no name, returns the
    name of a cell that it drives."""
    return n.name_of(bit) or (f"(for) {owners[n.driver[bit]]}" if bit in n.driver else "")


def end_name(n, owners, index):
    cell = n.cells[index]
    if cell.named and not netlist.is_flip_flop(cell.type):
        return cell.name
    driven = [pin.bits[0] for pin in cell.pins if pin.output and pin.bits]
    return start_name(n, owners, driven[0]) if driven else owners[index]


def path_ends(cell):
    """Returns (port, bit) for each input at which a path may end."""
    memory = netlist.is_memory(cell.type)
    return [(pin.port, bit) for pin in cell.pins if not pin.output and pin.port != "C"
            and not (memory and is_read_only(pin.port)) for bit in pin.bits if bit >= 0]


def timing_of(n, owners, count=10):
    """Returns ({"paths", "ends"}, {bit of a clock: longest path that ends with this clock, ns}).
    "paths" lists the longest paths between clocked cells, longest first, one for each register at
    which a path ends. "ends" counts the registers and memories by the length of their longest path
    at grade -2, in steps of half a ns."""
    analysis, ends, by_clock = Analysis(n), [], {}
    worst = {}  # register -> (ns, its name, pin, levels, bit, cell)
    for index, cell in enumerate(n.cells):
        if is_unclocked(cell):
            continue
        longest = None
        for port, bit in path_ends(cell):
            arrival = analysis.at(bit)
            if arrival is None:
                continue
            ns = arrival.ns + analysis.net(bit, index) + end_delay(cell.type, port)
            if longest is not None and ns <= longest[0]:
                continue
            longest = (ns, end_name(n, owners, index), port, arrival.levels, bit, index)
        if longest is None:
            continue
        register = longest[1].partition("[")[0]
        if register not in worst or longest[0] > worst[register][0]:
            worst[register] = longest
        for pin in cell.pins:
            if netlist.is_clock(pin.port) and pin.bits:
                by_clock[pin.bits[0]] = max(by_clock.get(pin.bits[0], 0), longest[0])
        bin = int(2 * longest[0] * SLOW_GRADE)
        ends += [0] * (bin + 1 - len(ends))
        ends[bin] += 1
    paths = []
    longest_first = sorted(worst.values(), key=lambda path: (-path[0], path[1]))
    for ns, to, pin, levels, bit, index in longest_first[:count]:
        steps, begin = analysis.steps(bit, index)
        paths.append({"from": start_name(n, owners, begin), "to": to, "pin": pin, "levels": levels,
                      "ns": ns, "steps": steps})
    return {"paths": paths, "ends": ends}, by_clock


PAD_TO_PAD, PAD_TO_REGISTER, REGISTER_TO_PAD = "pad to pad", "pad to register", "register to pad"


def pads_of(n, owners):
    """Returns the longest path from input pads to each output port, from registers to each output
    port, and from each input port to a register. A path has the form of a path of timing_of, with
    its kind. Ports of the memory controller (mcb_*) are not pads. The path of a clock from its pad
    is left out."""
    ports = [port for port in n.ports if not port.name.startswith("mcb_")]
    inputs = {bit: (port.name, i if len(port.bits) > 1 else -1)
              for port in ports if port.input for i, bit in enumerate(port.bits) if bit >= 0}
    from_pads, from_registers = Analysis(n, frozenset(inputs)), Analysis(n)
    worst = {}  # (kind, port) -> (ns, to, pin, bit, reader, analysis)

    def candidate(kind, port, ns, to, pin, bit, reader, analysis):
        if (kind, port) not in worst or ns > worst[kind, port][0]:
            worst[kind, port] = (ns, to, pin, bit, reader, analysis)

    for port in (port for port in ports if port.output):
        for bit in port.bits:
            for kind, analysis in ((PAD_TO_PAD, from_pads), (REGISTER_TO_PAD, from_registers)):
                arrival = analysis.at(bit) if bit >= 0 else None
                if arrival is not None:
                    ns = arrival.ns + net_delay(len(n.readers.get(bit, [])) + 1) + PAD_OUT
                    candidate(kind, port.name, ns, port.name, "O", bit, None, analysis)
    for index, cell in enumerate(n.cells):
        if is_unclocked(cell):
            continue
        for pin, bit in path_ends(cell):
            arrival = from_pads.at(bit)
            if arrival is None or netlist.is_clock(pin):
                continue
            ns = arrival.ns + from_pads.net(bit, index) + end_delay(cell.type, pin)
            begin = bit
            while from_pads.at(begin).before is not None:
                begin = from_pads.at(begin).before
            candidate(PAD_TO_REGISTER, inputs[begin][0], ns, end_name(n, owners, index), pin, bit,
                      index, from_pads)
    paths = []
    for (kind, port), (ns, to, pin, bit, reader, analysis) in sorted(
            worst.items(), key=lambda item: (item[0][0], -item[1][0])):
        steps, begin = analysis.steps(bit, reader)
        start = str(netlist.Name(*inputs[begin])) if analysis is from_pads else \
            start_name(n, owners, begin)
        paths.append({"kind": kind, "port": port, "from": start, "to": to, "pin": pin,
                      "levels": analysis.at(bit).levels, "ns": ns, "steps": steps})
    return paths


def slowest_pad(paths, port):
    """Returns the length of the longest path from a pad to an output port, in ns at grade -3; 0 if
    there is no such path."""
    return max((p["ns"] for p in paths if (p["kind"], p["port"]) == (PAD_TO_PAD, port)), default=0)
