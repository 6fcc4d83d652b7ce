# SPDX-License-Identifier: MIT
"""foreign_axis: writes the files of a core with an AXI-Stream in and one out, for new_foreign.py
(BUS=axis).

The core gets the operation `process`: its argument is the input sequence, its result the output.
Wrapper, servant and proxies are generated from its Slice interface; axis_filter moves the words.
"""
import re

from icesoc.cores.foreign_files import ADAPTER, head, overrides, pin_name, vector

SIGNALS = ("tdata", "tvalid", "tready", "tkeep", "tstrb", "tlast", "tuser", "tid", "tdest")
ROLES = [f"{stream}_{signal}" for stream in "sm" for signal in SIGNALS]
NEEDED = ["s_tdata", "s_tvalid", "m_tdata", "m_tvalid", "m_tready"]
ELEMENTS = {8: "byte", 16: "short", 32: "int", 64: "long"}
BYTES = 1024  # largest packet in each direction, bytes


def role(name, port):
    """Returns s_ and the signal of the input stream, m_ and the signal of the output stream, or
    None."""
    found = re.search(f"({'|'.join(SIGNALS)})(_[io])?$", name.lower()) or re.fullmatch(
        "[sm](?:_axis)?_(data|valid|ready|rdy|keep|strb|last)", name.lower())
    if not found:
        return None
    signal = "t" + found.group(1).removeprefix("t").replace("rdy", "ready")
    goes_in = (port["direction"] == "input") != (signal == "tready")
    return ("s_" if goes_in else "m_") + signal


def problem(top, ports, roles):
    """Returns the error in the module's streams, or None."""
    widths = [len(p["bits"]) for n, p in ports.items() if roles[n] in ("s_tdata", "m_tdata")]
    if widths[0] != widths[1] or widths[0] not in ELEMENTS:
        return f"tdata of {top} has {widths[0]} and {widths[1]} bits: it must be 8, 16, 32 or 64 in both directions"
    wide = [n for n, p in ports.items() if roles[n] == "setting" and len(p["bits"]) > 32]
    return f"PORTS: a setting has 32 bits at most, '{wide[0]}' has more" if wide else None


def camel(name):
    return "".join(w.capitalize() for w in name.split("_"))


def setting(name):
    """Returns the operation that sets a port, without its `set`, in snake_case."""
    return re.sub(r"^i_|_i$", "", name.lower())


class Core:
    """A third-party core with two streams: their widths, and the roles of its ports."""

    def __init__(self, name, top, params, ports, roles):
        self.name, self.top, self.params, self.ports, self.roles = name, top, params, ports, roles
        self.type_name = camel(name)
        self.by_role = {r: n for n, r in roles.items()}
        self.width = len(ports[self.by_role["s_tdata"]]["bits"])
        self.bits = 8 if {"s_tkeep", "m_tkeep"} & set(self.by_role) else self.width  # width of an
                                                                                     # element
        self.most = BYTES * 8 // self.bits
        self.settings = [n for n in ports if roles[n] == "setting"]
        self.pins = [(pin_name(n, p), p) for n, p in ports.items() if not roles[n]]

    @property
    def element(self):
        return ELEMENTS[self.bits]


def interface(core):
    metadata = "".join(f', "hw:pin:{n}:{len(p["bits"])}"' for n, p in core.pins)
    operations = "".join(f"""        /** Its input {n}. */
        idempotent void set{camel(setting(n))}(int value);
""" for n in core.settings)
    packet = core.type_name + "Packet"
    return f"""// SPDX-License-Identifier: MIT
//
// The third-party core {core.top}, from AXI-Stream to AXI-Stream.
module Cores {{
    sequence<{core.element}> {packet};
    [":hw"{metadata}] interface {core.type_name} {{
{operations}        /** Sends a packet through the core, and answers what comes out.
            Refused: an empty one, and an answer longer than {core.most}. */
        ["hw:long:1000", "hw:max:{core.most}"] {packet} process(["hw:max:{core.most}"] {packet} packet);
    }};
}};
"""


def connection(core, name, port):
    """Returns the connection of a port of the core."""
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
    keep, count_bits = core.width // 8, core.most.bit_length()
    shift = (core.bits // 8).bit_length() - 1
    set_wires = [(setting(n), "set_" + setting(n)) for n in core.settings]
    lines = [f"    wire {vector(32)}{value};\n    wire {start};" for value, start in set_wires]
    lines += [f"    assign {w} = {v};" for r, w, v in (
        ("s_tready", "to_ready", "1'b1"), ("m_tkeep", "from_keep", f"{{{keep}{{1'b1}}}}"),
        ("m_tlast", "from_last", "1'b0"))
        if r not in core.by_role]
    set_ports = "".join(f".{start}_start_o({start}), .{start}_value_o({value}),\n        "
                        for value, start in set_wires)
    unused = "".join(f"{value}, {start}, " for value, start in set_wires)
    connections = ",\n        ".join(f".{n}({connection(core, n, p)})"
                                     for n, p in core.ports.items())
    what = f"{core.top}: buffers in DDR3 through its AXI-Streams"
    return f"""{head(core.name, what, core.pins, '    `include "memory_ports.vh"' + chr(10))}    wire        core_rst, start, done, refused;
    wire [31:0] source, target;
    wire {vector(count_bits)}count;
    wire {vector(count_bits + shift)}bytes;
    wire        to_valid, to_ready, to_last, from_valid, from_ready, from_last;
    wire {vector(core.width)}to_data, from_data;
    wire {vector(keep)}to_keep, from_keep;
{"".join(line + chr(10) for line in lines)}
    {core.name}_wrapper u_wrapper (
        {ADAPTER}, .core_rst_o(core_rst),
        {set_ports}.process_start_o(start), .process_packet_base_o(source), .process_packet_count_o(count),
        .process_result_base_o(target), .process_result_count_i(bytes[{count_bits + shift - 1}:{shift}]),
        .process_done_i(done), .process_refused_i(refused));

    axis_filter #(.WIDTH({core.width}), .BYTE_BITS({count_bits + shift}), .ROOM({BYTES}), .LAST({int("m_tlast" in core.by_role)})) u_filter (
        `include "memory_connect.vh"
        .clk_i(clk_i), .rst_i(rst_i), .core_rst_i(core_rst),
        .start_i(start), .source_i(source), .bytes_i({f"{{count, {shift}'d0}}" if shift else "count"}), .target_i(target),
        .done_o(done), .refused_o(refused), .bytes_o(bytes),
        .m_axis_tvalid_o(to_valid), .m_axis_tready_i(to_ready), .m_axis_tdata_o(to_data), .m_axis_tkeep_o(to_keep),
        .m_axis_tlast_o(to_last),
        .s_axis_tvalid_i(from_valid), .s_axis_tready_o(from_ready), .s_axis_tdata_i(from_data), .s_axis_tkeep_i(from_keep),
        .s_axis_tlast_i(from_last));

    {core.top}{overrides(core.params)} u_core (
        {connections});

    wire unused = &{{1'b0, {unused}to_keep, to_last, bytes, 1'b0}};
endmodule
"""


def test(core):
    ice_type = "Ice_" + core.element.capitalize()
    before = [f"core.set{camel(setting(n))}(1);" for n in core.settings]
    before += [f"core.bench_.top().{n} = 0; // a pin" for n, p in core.pins
               if p["direction"] == "input"]
    return f"""// SPDX-License-Identifier: MIT
//
// {core.name}_test: a packet goes through the core, as a program sends it. Pins: core_.bench_.top().<pin>.

#include "V{core.name}_slot.h"
#include "{core.name}_proxy.h"

namespace {{

TEST({core.type_name}, AnswersAPacket) {{
    {core.type_name}Proxy<V{core.name}_slot> core;
    {ice_type} words[64];
    for (int i = 0; i < 64; ++i)
        words[i] = static_cast<{ice_type}>(i);
    Cores_{core.type_name}Packet packet{{64, words}};
{"".join(f"    {line}{chr(10)}" for line in before)}    Cores_{core.type_name}Packet answer{{}};
    ASSERT_NO_THROW(answer = core.process(&packet))
        << "no answer: check the core's reset, settings and pins";
    EXPECT_GT(answer.size, 0);
}}

}} // namespace
"""


def ground(core):
    name = core.name
    return f'''# SPDX-License-Identifier: MIT
"""{name}'s part of a mission: a packet goes through the core."""


def fly(log, proxy, report):
    import Cores  # made by loadSlice

    core = Cores.{core.type_name}Prx.checkedCast(proxy("{name}"))
    packet = {"bytes(range(64))" if core.bits == 8 else "list(range(64))"}
    answer = log.call("ground -> UAV", "{name}.process(64)", lambda: core.process(packet))
    log.say("{name}: %d came out of %d: %s" % (len(answer), len(packet), list(answer[:16])))
'''


def texts(name, top, params, ports, roles):
    """Returns the files by their names: interface, module, test, mission."""
    core = Core(name, top, params, ports, roles)
    return {f"{name}.ice": interface(core), f"{name}.v": module(core),
            f"{name}_test.cpp": test(core),
            "ground.py": ground(core)}
