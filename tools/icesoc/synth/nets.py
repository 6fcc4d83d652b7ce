# SPDX-License-Identifier: MIT
"""nets: lists clocks, resets and the nets with the highest fan-out of a Spartan-6 netlist, and
where each signal is declared in the sources."""
import functools
import re

from icesoc.synth import netlist
from icesoc.util import ghdl

FOR_OWNER = "(for) "


def name_or(n, owners, bit):
    """Returns the name of a net in the source. If the source has no name for the net, returns
    "(for) " and the signal to which its driver is assigned (owners.py)."""
    if bit not in n.driver and bit in n.names:
        # the name in the top module; the other names belong to inputs of instances
        return str(n.names[bit][-1])
    name = n.name_of(bit)
    return name if name or bit not in n.driver else FOR_OWNER + owners[n.driver[bit]]


def without_index(signal):
    """Returns a signal without its index: "u_modem.state" for "u_modem.state[3]"."""
    return signal.rpartition("[")[0] if signal.endswith("]") else signal


def nets_of(n, owners, by_clock, count=20):
    """Returns the nets with the highest fan-out, the clocks and the resets, each as a list of
    {name, kind, ends, flipFlops, ns}, most ends first. The list of nets contains no clocks. kind:
    synchronous or asynchronous for a reset, otherwise the type of the cell that drives the net. ns:
    longest path that ends at a flip-flop of a clock, at speed grade -3."""
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
    """Returns file and line of the declaration of a signal such as "u_modem.state[3]"; "" if
    unknown. For a core in VHDL, it is the line that GHDL reports. GHDL also invents names for
    intermediate values (n71_o)."""
    whole = without_index(signal.removeprefix(FOR_OWNER))
    name = whole.rpartition(".")[2]
    # An attribute src such as "./hdl/soc.v:62.26-69.2|./hdl/modem/modem.v:97.88-97.94" lists the
    # locations of instances, then the location of the declaration. The declaration is recognised
    # because it is as wide as the name.
    places = re.findall(r"([^|:]+):(\d+)\.(\d+)-(\d+)\.(\d+)", n.sources.get(whole, ""))
    for file, line, begin, last, end in places:
        if line == last and int(end) - int(begin) == len(name):
            lines = lines_of(file)
            in_vhdl = (ghdl.place_of_signal(lines, int(line), name)
                       if ghdl.is_converted(lines) else "")
            return in_vhdl or f"{ghdl.relative(file)}:{line}"
    return ""
