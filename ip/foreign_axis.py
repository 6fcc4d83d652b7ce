# SPDX-License-Identifier: MIT
"""foreign_axis: writes the files of a core with an AXI-Stream in and one out, for new_foreign.py (BUS=axis).

The core gets the operation `process`: a sequence goes in, and what comes out is the answer.
Wrapper, servant and proxies are generated from its Slice interface; axis_filter moves the words.
"""
import re

SIGNALS = ("tdata", "tvalid", "tready", "tkeep", "tstrb", "tlast", "tuser", "tid", "tdest")
NEEDED = ["s_tdata", "s_tvalid", "m_tdata", "m_tvalid", "m_tready"]
ELEMENTS = {8: "byte", 16: "short", 32: "int", 64: "long"}
BYTES = 1024  # of a packet, in and out
NPI = [("output", 32, "addr_o"), ("output", 1, "addr_req_o"), ("input", 1, "addr_ack_i"), ("output", 1, "rnw_o"),
       ("output", 4, "size_o"), ("output", 1, "rmw_o"), ("output", 64, "wr_data_o"), ("output", 8, "wr_be_o"),
       ("output", 1, "wr_push_o"), ("input", 1, "wr_empty_i"), ("input", 1, "wr_almost_full_i"), ("output", 1, "wr_flush_o"),
       ("input", 64, "rd_data_i"), ("input", 4, "rd_word_i"), ("output", 1, "rd_pop_o"), ("input", 1, "rd_empty_i"),
       ("output", 1, "rd_flush_o"), ("input", 1, "init_done_i")]


def role(name, port):
    """Returns s_ and the signal of the stream into the core, m_ of the one out of it, or None."""
    found = re.search(f"({'|'.join(SIGNALS)})(_[io])?$", name.lower())
    if not found:
        return None
    goes_in = (port["direction"] == "input") != (found.group(1) == "tready")
    return ("s_" if goes_in else "m_") + found.group(1)


def problem(top, ports, roles):
    """Returns what is wrong with the module's streams, or None."""
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


def texts(name, top, params, ports, roles, pin_name, vector, slot):
    """Returns the files by their names: interface, module, test, mission."""
    type_name = camel(name)
    by_role = {r: n for n, r in roles.items()}
    width = len(ports[by_role["s_tdata"]]["bits"])
    by_bytes = "s_tkeep" in by_role or "m_tkeep" in by_role
    element = 8 if by_bytes else width
    most, keep = BYTES * 8 // element, width // 8
    shift, count_bits = (element // 8).bit_length() - 1, (BYTES * 8 // element).bit_length()
    settings = [n for n in ports if roles[n] == "setting"]
    pins = [(pin_name(n, p), p) for n, p in ports.items() if not roles[n]]
    metadata = "".join(f', "hw:pin:{n}:{len(p["bits"])}"' for n, p in pins)
    operations = "".join(f"""        /** Its input {n}. */
        idempotent void set{camel(setting(n))}(int value);
""" for n in settings)
    ice = f"""// SPDX-License-Identifier: MIT
//
// The third-party core {top}, from AXI-Stream to AXI-Stream.
module Cores {{
    sequence<{ELEMENTS[element]}> {type_name}Packet;
    [":hw"{metadata}] interface {type_name} {{
{operations}        /** Sends a packet through the core, and answers what comes out. Refused: an empty one, and an answer longer than {most}. */
        ["hw:long:1000", "hw:max:{most}"] {type_name}Packet process(["hw:max:{most}"] {type_name}Packet packet);
    }};
}};
"""
    to = {"clock": "clk_i", "reset": "core_rst", "resetn": "!core_rst", "s_tdata": "to_data", "s_tvalid": "to_valid",
          "s_tready": "to_ready", "s_tkeep": "to_keep", "s_tstrb": "to_keep", "s_tlast": "to_last", "m_tdata": "from_data",
          "m_tvalid": "from_valid", "m_tready": "from_ready", "m_tkeep": "from_keep", "m_tlast": "from_last"}
    connections, unused = [], []
    for n, p in ports.items():
        r, bits = roles[n], len(p["bits"])
        if r == "setting":
            signal = f"{setting(n)}[{bits - 1}:0]" if bits > 1 else f"{setting(n)}[0]"
        else:
            signal = to.get(r) or (pin_name(n, p) if not r else f"{{{bits}{{1'b{int(r == 'high')}}}}}" if p["direction"] == "input" else "")
        connections.append(f".{n}({signal})")
    wires = [f"    wire {vector(32)}{setting(n)};" for n in settings]
    wires += [f"    wire set_{setting(n)};" for n in settings]
    unused += [s for n in settings for s in (setting(n), f"set_{setting(n)}")]
    ties = [f"    assign {w} = {v};" for r, w, v in (("s_tready", "to_ready", "1'b1"), ("m_tkeep", "from_keep", f"{{{keep}{{1'b1}}}}"),
                                                 ("m_tlast", "from_last", "1'b0")) if r not in by_role]
    set_ports = "".join(f".set_{setting(n)}_start_o(set_{setting(n)}), .set_{setting(n)}_value_o({setting(n)}),\n        "
                        for n in settings)
    bytes_of = f"{{count, {shift}'d0}}" if shift else "count"
    npi_ports = ",\n".join(f"    {d:6} wire {vector(w)}npi_{n}" for d, w, n in NPI)
    npi = ", ".join(f".npi_{n}(npi_{n})" for _, _, n in NPI).replace(", .npi_wr_data", ",\n        .npi_wr_data").replace(
        ", .npi_wr_almost", ",\n        .npi_wr_almost").replace(", .npi_rd_pop", ",\n        .npi_rd_pop")
    pin_ports = "".join(f",\n    {p['direction']:6} wire {vector(len(p['bits']))}{n}" for n, p in pins)
    separator = ",\n        "
    lines = "\n".join(wires + ties)
    module = f"""// SPDX-License-Identifier: MIT
//
// {name}: a slot with the third-party core {top}: buffers in DDR3 through its AXI-Streams.

`default_nettype none

module {name} (
{slot},
    // memory port
{npi_ports}{"," + chr(10) + "    // pins" + pin_ports[1:] if pins else ""}
);
    wire        core_rst, start, done, refused;
    wire [31:0] source, target;
    wire {vector(count_bits)}count;
    wire {vector(count_bits + shift)}bytes;
    wire        to_valid, to_ready, to_last, from_valid, from_ready, from_last;
    wire {vector(width)}to_data, from_data;
    wire {vector(keep)}to_keep, from_keep;
{lines}{chr(10) if lines else ""}
    {name}_wrapper u_wrapper (
        .clk_i(clk_i), .rst_i(rst_i),
        .bus_valid_i(bus_valid_i), .bus_write_i(bus_write_i), .bus_addr_i(bus_addr_i),
        .bus_wdata_i(bus_wdata_i), .bus_ready_o(bus_ready_o), .bus_rdata_o(bus_rdata_o),
        .bus_error_o(bus_error_o), .irq_o(irq_o), .core_rst_o(core_rst),
        {set_ports}.process_start_o(start), .process_packet_base_o(source), .process_packet_count_o(count),
        .process_result_base_o(target), .process_result_count_i(bytes[{count_bits + shift - 1}:{shift}]),
        .process_done_i(done), .process_refused_i(refused));

    axis_filter #(.WIDTH({width}), .BYTE_BITS({count_bits + shift}), .ROOM({BYTES}), .LAST({int("m_tlast" in by_role)})) u_filter (
        .clk_i(clk_i), .rst_i(rst_i), .core_rst_i(core_rst),
        .start_i(start), .source_i(source), .bytes_i({bytes_of}), .target_i(target),
        .done_o(done), .refused_o(refused), .bytes_o(bytes),
        .m_axis_tvalid_o(to_valid), .m_axis_tready_i(to_ready), .m_axis_tdata_o(to_data), .m_axis_tkeep_o(to_keep),
        .m_axis_tlast_o(to_last),
        .s_axis_tvalid_i(from_valid), .s_axis_tready_o(from_ready), .s_axis_tdata_i(from_data), .s_axis_tkeep_i(from_keep),
        .s_axis_tlast_i(from_last),
        {npi});

    {top}{params} u_core (
        {separator.join(connections)});

    wire unused = &{{1'b0, {"".join(s + ", " for s in unused)}to_keep, to_last, bytes, 1'b0}};
endmodule
"""
    test = f"""// SPDX-License-Identifier: MIT
//
// {name}_test: a packet goes through the core, as a program sends it. Pins: core_.bench_.top().<pin>.

#include "V{name}_slot.h"
#include "{name}_proxy.h"

namespace {{

TEST({type_name}, AnswersAPacket) {{
    {type_name}Proxy<V{name}_slot> core;
    Ice_{ELEMENTS[element].capitalize()} words[64];
    for (int i = 0; i < 64; ++i)
        words[i] = static_cast<Ice_{ELEMENTS[element].capitalize()}>(i);
    Cores_{type_name}Packet packet{{64, words}};
{"".join(f"    core.set{camel(setting(n))}(1);{chr(10)}" for n in settings)}{"".join(f"    core.bench_.top().{n} = 0; // a pin{chr(10)}" for n, p in pins if p["direction"] == "input")}    Cores_{type_name}Packet answer{{}};
    ASSERT_NO_THROW(answer = core.process(&packet)) << "no answer: what does the core want at its reset, its settings and its pins?";
    EXPECT_GT(answer.size, 0);
}}

}} // namespace
"""
    ground = f'''# SPDX-License-Identifier: MIT
"""{name}'s part of a mission: a packet goes through the core."""


def fly(log, proxy, report):
    import Cores  # made by loadSlice

    core = Cores.{type_name}Prx.checkedCast(proxy("{name}"))
    packet = {"bytes(range(64))" if element == 8 else "list(range(64))"}
    answer = log.call("ground -> UAV", "{name}.process(64)", lambda: core.process(packet))
    log.say("{name}: %d came out of %d: %s" % (len(answer), len(packet), list(answer[:16])))
'''
    return {f"{name}.ice": ice, f"{name}.v": module, f"{name}_test.cpp": test, "ground.py": ground}
