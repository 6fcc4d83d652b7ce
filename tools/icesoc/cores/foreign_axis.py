# SPDX-License-Identifier: MIT
"""foreign_axis: writes the files of a core with one AXI-Stream input and one AXI-Stream output, for
new_foreign.py (BUS=axis).

The core gets the operation `process`: its argument is the input sequence, its result the output
sequence. Wrapper, servant and proxies are generated from the Slice interface of the core;
axis_filter moves the words.
"""
import re

from icesoc.cores.foreign_files import connected_ports, pin_name, render
from icesoc.util.spelling import option

SIGNALS = ("tdata", "tvalid", "tready", "tkeep", "tstrb", "tlast", "tuser", "tid", "tdest")
ROLES = [f"{stream}_{signal}" for stream in "sm" for signal in SIGNALS]
NEEDED = ["s_tdata", "s_tvalid", "m_tdata", "m_tvalid", "m_tready"]
ELEMENTS = {8: "byte", 16: "short", 32: "int", 64: "long"}
BYTES = 1024  # largest packet in each direction, bytes


def role(name, port):
    """Returns the role of a port: "s_" and the name of a signal of the input stream, or "m_" and
    the name of a signal of the output stream; None for any other port."""
    found = re.search(f"({'|'.join(SIGNALS)})(_[io])?$", name.lower()) or re.fullmatch(
        "[sm](?:_axis)?_(data|valid|ready|rdy|keep|strb|last)", name.lower())
    if not found:
        return None
    signal = "t" + found.group(1).removeprefix("t").replace("rdy", "ready")
    goes_in = (port["direction"] == "input") != (signal == "tready")
    return ("s_" if goes_in else "m_") + signal


def problem(top, ports, roles):
    """Returns an error message if the module's streams or settings do not fit the slot, otherwise
    an empty value."""
    widths = [len(p["bits"]) for n, p in ports.items() if roles[n] in ("s_tdata", "m_tdata")]
    if widths[0] != widths[1] or widths[0] not in ELEMENTS:
        return (f"tdata of {top} has {widths[0]} and {widths[1]} bits: expected 8, 16, 32 or 64 in "
                "both directions")
    wide = [n for n, p in ports.items() if roles[n] == "setting" and len(p["bits"]) > 32]
    return wide and f"{option('ports')}: a setting has 32 bits at most, '{wide[0]}' has more"


def camel(name):
    return "".join(w.capitalize() for w in name.split("_"))


def setting(name):
    """Returns the name of a setting in snake_case: the name of its port without i_ or _i. The
    operation that sets it is named `set` plus this name in CamelCase."""
    return re.sub(r"^i_|_i$", "", name.lower())


class Core:
    """A third-party core with two streams: their widths, and the roles of its ports."""

    def __init__(self, name, top, params, ports, roles):
        self.name, self.top, self.params, self.ports, self.roles = name, top, params, ports, roles
        self.type_name = camel(name)
        self.by_role = {r: n for n, r in roles.items()}
        self.width = len(ports[self.by_role["s_tdata"]]["bits"])
        # bits; width of an element
        self.bits = 8 if {"s_tkeep", "m_tkeep"} & set(self.by_role) else self.width
        self.most = BYTES * 8 // self.bits
        self.settings = [n for n in ports if roles[n] == "setting"]
        self.pins = [(pin_name(n, p), p) for n, p in ports.items() if not roles[n]]

    @property
    def element(self):
        return ELEMENTS[self.bits]


def connection(core, name, port):
    """Returns the expression that is connected to a port of the core."""
    role, bits = core.roles[name], len(port["bits"])
    if role == "setting":
        return f"{setting(name)}[{bits - 1}:0]" if bits > 1 else f"{setting(name)}[0]"
    if role in ("s_tstrb", "s_tkeep"):
        return "to_keep"
    fixed = {"clock": "clk_i", "reset": "core_rst", "resetn": "!core_rst"}
    if role in fixed or not role:
        return fixed.get(role) or pin_name(name, port)
    stream, _, signal = role.partition("_t")
    if signal in ("data", "valid", "ready", "keep", "last"):
        return {"s": "to_", "m": "from_"}[stream] + signal
    return f"{{{bits}{{1'b{int(role == 'high')}}}}}" if port["direction"] == "input" else ""


def module(core):
    """Returns the slot's Verilog: wrapper, axis_filter, core."""
    keep = core.width // 8
    connections, unused = connected_ports(core.ports,
                                          lambda name, port: connection(core, name, port))
    return render(
        "axis.v.j2", name=core.name, what=f"{core.top}: buffers in DDR3 through its AXI-Streams",
        pins=core.pins, has_memory=True, core=core, room=BYTES, count_bits=core.most.bit_length(),
        shift=(core.bits // 8).bit_length() - 1,
        settings=[(setting(n), "set_" + setting(n)) for n in core.settings],
        constants=[(wire, value) for role, wire, value in (
            ("s_tready", "to_ready", "1'b1"), ("m_tkeep", "from_keep", f"{{{keep}{{1'b1}}}}"),
            ("m_tlast", "from_last", "1'b0")) if role not in core.by_role],
        connections=connections, unused_wires=unused)


def texts(name, top, params, ports, roles):
    """Returns the files of the slot, by name: interface, module, test, mission."""
    core = Core(name, top, params, ports, roles)
    named = {"name": name, "core": core, "camel": camel, "setting": setting,
             "ice_type": "Ice_" + core.element.capitalize()}
    return {f"{name}.ice": render("axis.ice.j2", **named), f"{name}.v": module(core),
            f"{name}_test.cpp": render("axis_test.cpp.j2", **named),
            "ground.py": render("axis_ground.py.j2", **named)}
