#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""new_foreign: puts a third-party core in Verilog into a slot (docs/recipes.md).

    new_foreign.py NAME TOP wishbone|axil|memory FOLDER FILE...

Reads the ports of the module TOP with Yosys and writes into FOLDER, which must not exist: NAME.v, which connects TOP to
the slot; its registers; a test; CMakeLists.txt. Ports that are neither bus, clock, reset nor interrupt become pins.
"""
import json
import os
import re
import subprocess
import sys
import tempfile

CLOCKS = {"clk", "aclk", "clock"}
RESETS = {"rst", "reset", "arst", "rstn", "resetn", "aresetn", "nrst"}
INTERRUPTS = {"int", "inta", "irq", "interrupt"}
AXI = ["awvalid", "awready", "awaddr", "awprot", "wvalid", "wready", "wdata", "wstrb", "bvalid", "bready", "bresp",
       "arvalid", "arready", "araddr", "arprot", "rvalid", "rready", "rdata", "rresp"]
WISHBONE = {"input": {"cyc": "cyc", "stb": "stb", "we": "we", "adr": "adr", "addr": "adr", "sel": "sel", "dat": "wdata",
                      "data": "wdata"},
            "output": {"ack": "ack", "err": "err", "rty": "rty", "stall": "stall", "dat": "rdata", "data": "rdata"}}
# "memory": chip select, write enable, address of a word, data; what is read is there in the same clock.
MEMORY = {"cs": "stb", "ce": "stb", "we": "we", "address": "adr", "addr": "adr", "write_data": "wdata", "wdata": "wdata",
          "din": "wdata", "read_data": "rdata", "rdata": "rdata", "dout": "rdata"}
NEEDED = {"memory": ["stb", "we", "adr", "wdata", "rdata"], "wishbone": ["cyc", "stb", "we", "wdata", "rdata", "ack"], "axil": [n for n in AXI if not n.endswith("prot")]}
BUSES = {"wishbone": "Wishbone", "axil": "AXI4-Lite", "memory": "select, address and data"}
SLOT = """    input  wire        clk_i,
    input  wire        rst_i,
    // register bus
    input  wire        bus_valid_i,
    input  wire        bus_write_i,
    input  wire [3:0]  bus_addr_i,
    input  wire [31:0] bus_wdata_i,
    output wire        bus_ready_o,
    output wire [31:0] bus_rdata_o,
    output wire        bus_error_o,
    output wire        irq_o"""
ADAPTER = """.clk_i(clk_i), .rst_i(rst_i),
        .bus_valid_i(bus_valid_i), .bus_write_i(bus_write_i), .bus_addr_i(bus_addr_i),
        .bus_wdata_i(bus_wdata_i), .bus_ready_o(bus_ready_o), .bus_rdata_o(bus_rdata_o),
        .bus_error_o(bus_error_o), .irq_o(irq_o), .irq_i(interrupt)"""


def fail(text):
    sys.exit("new-foreign: " + text)


def read_module(top, files):
    """The module `top` as Yosys has it: its ports in order, and the names of its parameters."""
    with tempfile.TemporaryDirectory() as work:
        out = os.path.join(work, "top.json")
        folders = " ".join("-I" + d for d in sorted({os.path.dirname(f) for f in files}))
        run = subprocess.run(["yosys", "-q", "-p", f"read_verilog -defer {folders} {' '.join(files)}; hierarchy -top {top}; "
                              f"proc; write_json {out}"], capture_output=True, text=True)
        if run.returncode:
            fail(f"Yosys does not elaborate {top}:\n{run.stdout}{run.stderr}".rstrip())
        modules = json.load(open(out))["modules"]
    module = next(m for n, m in modules.items() if m["attributes"].get("top") or n == top)
    return module["ports"], module.get("parameter_default_values", {})


def role(name, port, bus):
    """What a port is: clock, reset, interrupt, a signal of the bus, or "" for a pin."""
    tokens = name.lower().split("_")
    if port["direction"] == "input" and CLOCKS & set(tokens):
        return "clock"
    if port["direction"] == "input" and RESETS & set(tokens):
        return "reset"
    if bus == "memory":
        found = [MEMORY[base]] if (base := re.sub(r"^[io]_|_[io]$", "", name.lower())) in MEMORY else []
    elif bus == "axil":
        found = [t for t in tokens if t in AXI]
    else:
        is_bus = "wb" in tokens or len(tokens) <= 2
        found = [WISHBONE[port["direction"]][t] for t in tokens if is_bus and t in WISHBONE[port["direction"]]]
    if found:
        return found[0]
    return "interrupt" if port["direction"] == "output" and INTERRUPTS & set(tokens) else ""


def pin_name(name, port):
    """The port's name as the platform has pins: in small letters, with _i or _o at its end."""
    base = re.sub(r"^[io]_|_[io]$", "", name.lower())
    return base + ("_i" if port["direction"] == "input" else "_o")


def vector(width):
    return f"[{width - 1}:0] " if width > 1 else ""


def address(signal, port):
    """Connection of an address: byte addresses where the port has bits of them, else a register for each address."""
    width, lsb = len(port["bits"]), port.get("offset", 0)
    if lsb == 0 and signal == "adr" and width < 16:
        return f"adr[{width + 1}:2]", 1 << width
    return f"{signal}[{width + lsb - 1}:{lsb}]", 1 << max(0, width + lsb - 2)


def write_verilog(name, top, bus, ports, roles, parameters):
    by_role = {r: (n, p) for n, p in ports.items() if (r := roles[n])}
    registers, connections, extra, interrupts = 8, [], [], []
    adr_bits = 6
    for n, p in ports.items():
        width, r = len(p["bits"]), roles[n]
        if r == "clock":
            to = "clk_i"
        elif r == "reset":
            to = "!rst_i" if re.search(r"((rst|reset)n|_n|nrst)(_i)?$", n.lower()) else "rst_i"
        elif r == "interrupt":
            to = f"interrupt_{len(interrupts)}"
            interrupts.append(to)
        elif r in ("adr", "awaddr", "araddr"):
            to, count = address(r, p)
            registers = min(registers, count)
            adr_bits = max(adr_bits, int(re.search(r"\[(\d+):", to).group(1)) + 1)
        elif r in ("wdata", "sel", "wstrb") and width < {"wdata": 32, "sel": 4, "wstrb": 4}[r]:
            to = f"{r}[{width - 1}:0]"
        elif r == "rdata":
            to = "rdata" if width == 32 else f"rdata[{width - 1}:0]"
            if width < 32:
                extra.append(f"    assign rdata[31:{width}] = {32 - width}'d0;")
        elif r:
            to = r
        else:
            to = pin_name(n, p)
        connections.append(f".{n}({to})")
    widths = {"adr": adr_bits, "sel": 4, "wdata": 32, "rdata": 32, "awaddr": adr_bits, "araddr": adr_bits, "wstrb": 4,
              "bresp": 2, "rresp": 2, "awprot": 3, "arprot": 3}
    answers = {"ack": "stb"} if bus == "memory" else {}
    signals = AXI if bus == "axil" else ["cyc", "stb", "we", "adr", "sel", "wdata", "rdata", "ack", "err", "rty", "stall"]
    wires = "\n".join(f"    wire {vector(widths.get(s, 1))}{s}{'' if s in by_role or not is_answer(s) else ' = ' + answers.get(s, zero(widths, s))};"
                      for s in signals)
    names = {s: ("axi_" + s if bus == "axil" else {"wdata": "wb_dat", "rdata": "wb_dat"}.get(s, "wb_" + s)) for s in signals}
    adapter = ",\n        ".join(f".{names[s]}_{'i' if is_answer(s) else 'o'}({s})" for s in signals)
    pins = [(pin_name(n, p), p) for n, p in ports.items() if not roles[n]]
    pin_ports = "".join(f",\n    {p['direction']:6} wire {vector(len(p['bits']))}{n}" for n, p in pins)
    levels = " #(.ARST_LVL(1'b1))" if "ARST_LVL" in parameters else ""
    pipelined = ", .PIPELINED(1)" if "stall" in by_role else ""
    irq = " || ".join(interrupts) or "1'b0"
    unused = ", ".join(s for s in signals if not is_answer(s))
    adapter_module = "bus_to_axi4lite" if bus == "axil" else "bus_to_wishbone"
    separator = ",\n        "
    text = f"""// SPDX-License-Identifier: MIT
//
// {name}: a slot with the third-party core {top} behind {adapter_module}.

`default_nettype none

module {name} (
{SLOT}{"," + chr(10) + "    // pins" + pin_ports[1:] if pins else ""}
);
    `include "{name}_regs.vh"

{wires}
{"".join(f"    wire {i};{chr(10)}" for i in interrupts)}    wire interrupt = {irq};

    {adapter_module} #(.ID_VALUE({name.upper()}_ID_VALUE), .ADDR_WIDTH({adr_bits}){pipelined}) u_bus (
        {ADAPTER},
        {adapter}
    );

    {top}{levels} u_core (
        {separator.join(connections)}
    );
{chr(10).join(extra)}{chr(10) if extra else ""}    wire unused = &{{1'b0, {unused}, 1'b0}};
endmodule
"""
    return text, registers, pins


def is_answer(signal):
    return signal in ("rdata", "ack", "err", "rty", "stall", "awready", "wready", "bvalid", "bresp", "arready", "rvalid", "rresp")


def zero(widths, signal):
    return f"{widths.get(signal, 1)}'d0"


def description(name, top, bus, registers, pins):
    letters = (name.replace("_", "") + "x").upper()
    lines = [{"word": 3, "name": "PAGE", "access": "rw", "doc": "byte address in the core of word 8"}]
    lines += [{"word": 8 + r, "name": f"REG{r}", "access": "rw", "doc": f"the core's register {r}, at PAGE + {4 * r}"}
              for r in range(registers)]
    return {"block": name, "doc": f"The third-party core {top}, by {BUSES[bus]}.",
            "type": f"0x{ord(letters[0]):02X}{ord(letters[1]):02X}", "version": "0x0100",
            "pins": [{"name": n, "width": len(p["bits"])} for n, p in pins], "registers": lines,
            "events": [{"name": "CORE", "bit": 0, "doc": "the core's interrupt line was high"},
                       {"name": "TIMEOUT", "bit": 1, "doc": "the core did not answer"}]}


def test_of(name):
    suite = "".join(w.capitalize() for w in name.split("_"))
    return f"""// SPDX-License-Identifier: MIT
//
// {name}_test: the core answers behind its adapter. Pins: slot.bench_.top().<pin>.

#include "V{name}_slot.h"
#include "core_slot.h"
extern "C" {{
#include "{name}_regs.h"
}}

namespace {{

TEST({suite}, IsInItsSlotAndAnswers) {{
    CoreSlot<V{name}_slot> slot;
    EXPECT_EQ(slot.bus_.read(0), {name.upper()}_ID_VALUE);
    slot.bus_.write({name.upper()}_PAGE, 0);
    auto answer = slot.bus_.transfer(false, {name.upper()}_REG0, 0);
    EXPECT_FALSE(answer.error);
    EXPECT_EQ(slot.bus_.read(1) & {name.upper()}_EVENT_TIMEOUT_MASK, 0u);
}}

}} // namespace
"""


def main(words):
    if len(words) < 5:
        sys.exit("usage: make new-foreign NAME=my_uart TOP=module BUS=wishbone|axil|memory FILES='a.v b.v'")
    name, top, bus, folder, *files = words
    if bus not in NEEDED:
        fail(f"BUS is wishbone, axil or memory, not '{bus}'")
    if not re.fullmatch(r"[a-z][a-z0-9]+(_[a-z0-9]+)*", name) or name == top:
        fail(f"'{name}': words of small letters and digits, joined by _, and not the module's own name")
    if os.path.exists(folder):
        fail(f"{folder} is there already")
    files = [os.path.abspath(f) for f in files]
    for f in files:
        if not f.endswith(".v") or not os.path.isfile(f):
            fail(f"there is no Verilog file '{f}'")
    ports, parameters = read_module(top, files)
    two_way = [n for n, p in ports.items() if p["direction"] == "inout"]
    if two_way:
        fail(f"{top} has the inout port '{two_way[0]}': tri-states belong to the chip's pads; take a top without")
    roles = {n: role(n, p, bus) for n, p in ports.items()}
    missing = [r for r in NEEDED[bus] + ["clock"] if r not in roles.values()]
    if missing:
        fail(f"{top} has no port for {', '.join(missing)}: {', '.join(ports)}")
    verilog, registers, pins = write_verilog(name, top, bus, ports, roles, parameters)
    os.makedirs(folder)
    for file, text in ((f"{name}.v", verilog), (f"{name}_test.cpp", test_of(name)),
                       (f"{name}.regs.json", json.dumps(description(name, top, bus, registers, pins), indent=2) + "\n"),
                       ("CMakeLists.txt", "# SPDX-License-Identifier: MIT\n"
                        f"icesoc_core({name} REGS {name}.regs.json FLAGS -Wno-lint -Wno-style "
                        + " ".join("-I" + d for d in sorted({os.path.dirname(f) for f in files})) + f"\n  VERILOG {name}.v "
                        + "\n  ".join(files) + ")\n")):
        with open(os.path.join(folder, file), "w") as out:
            out.write(text)
    print(f"{folder}: {' '.join(sorted(os.listdir(folder)))}")
    for n in ports:
        print(f"  {n}: {roles[n] or 'pin ' + pin_name(n, ports[n])}")
    print(f"Next: look at the ports above; name the registers in {name}.regs.json; make ip-test IP={name}")


main(sys.argv[1:])
