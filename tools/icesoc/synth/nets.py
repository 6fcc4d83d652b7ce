# SPDX-License-Identifier: MIT
"""nets: lists clocks, resets and the nets with the highest fan-out of a Spartan-6 netlist, and
where each signal is declared in the sources."""
import functools
import re

from icesoc.synth import netlist
from icesoc.util import ghdl

FOR_OWNER = "(for) "


def name_or(n, owners, bit):
    """Returns the name of a net in the source, or "(for) " and the name of its load."""
    if bit not in n.driver and bit in n.names:
        return str(n.names[bit][-1])  # the name in the top module, not of an instance's input
    name = n.name_of(bit)
    return name if name or bit not in n.driver else FOR_OWNER + owners[n.driver[bit]]


def without_index(signal):
    """Of "u_modem.state[3]" that is "u_modem.state"."""
    return signal.rpartition("[")[0] if signal.endswith("]") else signal


def nets_of(n, owners, by_clock, count=20):
    """Returns lists of {name, kind, ends, flipFlops, ns}, most ends first, without clocks. kind:
    synchronous or asynchronous for a reset; otherwise the type of the cell that drives the net. ns:
    longest path to a flip-flop of a clock, speed grade -3."""
    pins, clocked, clocks, resets = {}, set(), {}, {}
    for cell in n.cells:
        register = netlist.is_register(cell.type)
        for pin in cell.pins:
            is_clock = netlist.is_clock(pin.port)
            kind = {"R": "synchronous", "S": "synchronous", "CLR": "asynchronous",
                    "PRE": "asynchronous"}.get(pin.port) if register else None
            for bit in pin.bits:
                if pin.output or bit < 0:
                    continue
                pins[bit] = pins.get(bit, 0) + 1
                if is_clock:
                    clocked.add(bit)
                    clocks[bit] = clocks.get(bit, 0) + register
                if kind:
                    resets[bit, kind] = resets.get((bit, kind), 0) + 1

    def net(bit, kind="", flip_flops=0, ns=0):
        return {"name": name_or(n, owners, bit), "kind": kind or n.driver_type(bit) or "port",
                "ends": pins[bit], "flipFlops": flip_flops, "ns": ns}

    lists = {"fanouts": [net(bit) for bit in pins if bit not in clocked],
             "clocks": [net(bit, "", clocks[bit], by_clock.get(bit, 0)) for bit in clocked],
             "resets": [net(bit, kind, number) for (bit, kind), number in resets.items()
                        if bit not in clocked]}
    return {name: sorted(nets, key=lambda net: (-net["ends"], net["name"]))[:count]
            for name, nets in lists.items()}


@functools.lru_cache(64)
def lines_of(file):
    try:
        with open(file, errors="replace") as lines:
            return lines.read().splitlines()
    except OSError:
        return []


def place_of(n, signal):
    """Returns file and line of the declaration of a signal ("u_modem.state[3]"); "" if unknown. For
    a core in VHDL it is the line that GHDL gives; GHDL also invents names for intermediate values
    (n71_o)."""
    whole = without_index(signal.removeprefix(FOR_OWNER))
    name = whole.rpartition(".")[2]
    # "./hdl/soc.v:62.26-69.2|./hdl/modem/modem.v:97.88-97.94": locations of instances, then of the
    # declaration, which is as wide as the name.
    places = re.findall(r"([^|:]+):(\d+)\.(\d+)-(\d+)\.(\d+)", n.sources.get(whole, ""))
    for file, line, begin, last, end in places:
        if line == last and int(end) - int(begin) == len(name):
            lines = lines_of(file)
            in_vhdl = (ghdl.place_of_signal(lines, int(line), name)
                       if ghdl.is_converted(lines) else "")
            return in_vhdl or f"{ghdl.relative(file)}:{line}"
    return ""
