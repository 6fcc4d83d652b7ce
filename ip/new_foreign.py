#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""new_foreign: puts a third-party core in Verilog or VHDL into a slot (docs/recipes.md).

    new_foreign.py NAME TOP wishbone|axil|apb|memory|own|axis FOLDER [CLOCK=Hz] [LIBRARY=name] [PARAM:NAME=value...] [DEFINE:NAME...]
                   [ROLE=port...] FILE...

Reads the ports of the module or entity TOP and writes into FOLDER, which must not exist: NAME.v, which connects TOP to
the slot; its registers, with the names that TOP has for their addresses; a test; what a mission calls of it;
CMakeLists.txt. ROLE=port says what a port is for, instead of its name. Ports that are neither bus, clock, reset nor
interrupt become pins. CLOCK: the core has a clock of its own, of that frequency at most. VHDL is read by GHDL, which the
environment names; LIBRARY: the VHDL library that its files say they are in; PARAM: a parameter or generic of TOP; DEFINE: a macro
of its Verilog, NAME or NAME=value. A core with AXI-Streams (axis) has an operation instead of registers: foreign_axis.py.
"""
import json
import os
import re
import subprocess
import sys

import foreign_axis
from foreign_files import FLAGS, HERE, check_names, copies_for_verilator, fail, folders_of, is_vhdl, kind_of, names_of, read_module
from foreign_roles import AXI, NEEDED, is_answer, roles_of

BUSES = {"wishbone": "Wishbone", "apb": "APB", "axil": "AXI4-Lite", "memory": "select, address and data", "own": "a bus of its own"}
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


def tie(port, what):
    """A port that is always the same."""
    width = len(port["bits"])
    return {"low": f"{width}'d0", "high": f"{{{width}{{1'b1}}}}", "open": ""}.get(what, f"{width}'d{what}")


def overrides(params):
    """Parameters of an instance."""
    return f" #({', '.join('.{}({})'.format(*p.split('=', 1)) for p in params)})" if params else ""


def pin_name(name, port):
    """The port's name as the platform has pins: in small letters, with _i or _o at its end."""
    base = re.sub(r"^[io]_|_[io]$", "", name.lower())
    return base + ("_i" if port["direction"] == "input" else "_o")


def vector(width):
    return f"[{width - 1}:0] " if width > 1 else ""


def address(signal, port, bus, data_width):
    """Connection of an address, and the bits that count words: byte addresses where the port has bits of them, else a
    word for each address."""
    width, lsb = len(port["bits"]), port.get("offset", 0)
    if signal == "words" or lsb == 0 and signal == "adr" and bus != "apb" and (
            width < 16 or width == 30 or width < 30 and data_width < 32):
        return f"adr[{width + 1}:2]", width
    return f"{'adr' if signal == 'bytes' else signal}[{width + lsb - 1}:{lsb}]", max(0, width + lsb - 2)


def write_verilog(name, top, bus, ports, roles, latency, params, clock):
    by_role = {r: (n, p) for n, p in ports.items() if (r := roles[n])}
    word_bits, connections, extra, interrupts = 0, [], [], []
    data_width = max(len(by_role[r][1]["bits"]) for r in ("wdata", "rdata"))
    adr_bits = 6
    # Without a select, read and write are strobes.
    strobes = {} if {"stb", "strobe"} & set(by_role) else {"we": "stb && we", "re": "stb && !we"}
    for n, p in ports.items():
        width, r = len(p["bits"]), roles[n]
        if r == "clock":
            to = "clk_i"
        elif r in ("reset", "resetn"):
            to = "rst_i" if r == "reset" else "!rst_i"
        elif r in ("stb", "strobe", "re", "we"):  # a bit for each byte: all of them
            to = strobes.get(r, {"strobe": "stb", "re": "!we"}.get(r, r)) if bus == "own" else r
            to = f"{{{width}{{{to}}}}}" if width > 1 else to
        elif r in ("low", "high", "open", "1", "2"):
            to = tie(p, r)
        elif r == "interrupt":
            to = f"interrupt_{len(interrupts)}"
            interrupts.append((width, to))
        elif r in ("adr", "words", "bytes", "awaddr", "araddr"):
            to, word_bits = address(r, p, bus, data_width)
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
    answers = {"ack": "stb"} if bus in ("memory", "own", "apb") else {}
    registers, clocked = [], []
    if latency:
        answers = {"ack": f"answered[{latency - 1}]"}
        registers.append(f"    reg [{latency - 1}:0] answered; // the core answers so many clocks after its strobe")
        clocked.append(f"        answered <= rst_i ? {latency}'d0 : {f'{{answered[{latency - 2}:0], stb}}' if latency > 1 else 'stb'};")
    if "enable" in by_role:
        registers.append("    reg enable; // from the second clock of a transfer on")
        clocked.append("        enable <= stb && !rst_i;")
    if clocked:
        clocked.insert(0, "    always @(posedge clk_i) begin")
        clocked.append("    end")
    signals = AXI if bus == "axil" else ["cyc", "stb", "we", "adr", "sel", "wdata", "rdata", "ack", "err", "rty", "stall"]
    wires = "\n".join(f"    wire {vector(widths.get(s, 1))}{s}{'' if s in by_role or not is_answer(s) else ' = ' + answers.get(s, zero(widths, s))};"
                      for s in signals)
    names = {s: ("axi_" + s if bus == "axil" else {"wdata": "wb_dat", "rdata": "wb_dat"}.get(s, "wb_" + s)) for s in signals}
    adapter = ",\n        ".join(f".{names[s]}_{'i' if is_answer(s) else 'o'}({s})" for s in signals)
    pins = [(pin_name(n, p), p) for n, p in ports.items() if not roles[n]]
    pin_ports = "".join(f",\n    {p['direction']:6} wire {vector(len(p['bits']))}{n}" for n, p in pins)
    pipelined = ", .PIPELINED(1)" if {"stall", "strobe"} & set(by_role) or latency else ""
    if clock:  # the adapter gives a core up before bus_crossing does, after 250 clocks of the chip
        pipelined += f", .TIMEOUT({max(2, 250 * clock // 100000000 - 6)})"
    irq = " || ".join(("|" if w > 1 else "") + i for w, i in interrupts) or "1'b0"
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

{"".join(line + chr(10) for line in registers)}{wires}
{"".join(line + chr(10) for line in clocked)}{"".join(f"    wire {vector(w)}{i};{chr(10)}" for w, i in interrupts)}    wire interrupt = {irq};

    {adapter_module} #(.ID_VALUE({name.upper()}_ID_VALUE), .ADDR_WIDTH({adr_bits}){pipelined}) u_bus (
        {ADAPTER},
        {adapter}
    );

    {top}{overrides(params)} u_core (
        {separator.join(connections)}
    );
{chr(10).join(extra)}{chr(10) if extra else ""}    wire unused = &{{1'b0, {unused}, 1'b0}};
endmodule
"""
    return text, word_bits, adr_bits, data_width, pins


def zero(widths, signal):
    return f"{widths.get(signal, 1)}'d0"


def description(name, top, bus, words, adr_bits, data_width, pins):
    """*.regs.json; `words` are the names of the core's words by their addresses."""
    letters = (name.replace("_", "") + "x").upper()
    width = {} if data_width >= 32 else {"width": data_width}
    registers = [{"word": 3, "name": "PAGE", "access": "rw", "doc": "byte address in the core of word 8", "fields": [
        {"name": "ADDRESS", "lsb": 0, "width": adr_bits, "doc": "a multiple of 32"}]}]
    registers += [{"word": 8 + a % 8, "page": a // 8 * 32, "name": n, "access": "rw", **width,
                   "doc": f"at {4 * a:#x} in the core"} for a, n in words.items()]
    return {"block": name, "doc": f"The third-party core {top}, by {BUSES[bus]}.",
            "type": f"0x{ord(letters[0]):02X}{ord(letters[1]):02X}", "version": "0x0100",
            "pins": [{"name": n, "width": len(p["bits"])} for n, p in pins], "registers": registers,
            "events": [{"name": "CORE", "bit": 0, "doc": "the core's interrupt line was high"},
                       {"name": "TIMEOUT", "bit": 1, "doc": "the core did not answer"}]}


def test_of(name, first):
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
    slot.bus_.write({name.upper()}_PAGE, {name.upper()}_{first}_PAGE);
    auto answer = slot.bus_.transfer(false, {name.upper()}_{first}, 0);
    EXPECT_FALSE(answer.error) << "no answer, or an error: what does the core want at its reset and its pins?";
    EXPECT_EQ(slot.bus_.read(1) & {name.upper()}_EVENT_TIMEOUT_MASK, 0u);
}}

}} // namespace
"""


def ground_of(name, first):
    return f'''# SPDX-License-Identifier: MIT
\"""{name}'s part of a mission: its registers are listed, and one is read.\"""


def fly(log, proxy, report):
    import Hw  # made by loadSlice

    core = Hw.RegistersPrx.checkedCast(proxy("{name}"))
    registers = log.call("ground -> UAV", "{name}.list()", core.list)
    log.say("{name}: " + " ".join(r.name for r in registers))
    value = log.call("ground -> UAV", "{name}.get({first})", lambda: core.get("{first}"))
    log.say("{name}: {first} is 0x%X" % value)
'''


def main(words):
    if len(words) < 5:
        sys.exit("usage: make new-foreign NAME=my_uart TOP=module BUS=wishbone|axil|apb|memory|own|axis FILES='a.v b.v' [PORTS='write=we ...']")
    name, top, bus, folder, *rest = words
    given, files = [w for w in rest if "=" in w], [w for w in rest if "=" not in w and not w.startswith("DEFINE:")]
    params = [w[6:] for w in given if w.startswith("PARAM:")]
    defines = [w[7:] for w in rest if w.startswith("DEFINE:")]
    clock = [w[6:] for w in given if w.startswith("CLOCK=")]
    library = [w[8:] for w in given if w.startswith("LIBRARY=")]
    given = [w for w in given if not w.startswith(("CLOCK=", "LIBRARY=", "PARAM:", "DEFINE:"))]
    if clock and not (clock[0].isdigit() and 3000000 <= int(clock[0]) <= 100000000):
        fail(f"CLOCK={clock[0]}: the frequency of the core's own clock, 3000000 to 100000000 Hz")
    if clock and bus == "axis":
        fail("CLOCK: a core with AXI-Streams reaches DDR3, whose port has the chip's clock")
    if bus not in NEEDED:
        fail(f"BUS is {', '.join(NEEDED)}, not '{bus}'")
    if not re.fullmatch(r"[a-z][a-z0-9]*(_[a-z0-9]+)*", name):
        fail(f"'{name}': words of small letters and digits, joined by _")
    if not re.fullmatch(r"[A-Za-z_]\w*", top):
        fail(f"TOP is the name of a module or an entity, not '{top}'")
    if os.path.exists(folder):
        fail(f"{folder} is there already")
    check = subprocess.run([os.path.join(HERE, "new.sh"), name, "check"], capture_output=True, text=True)
    if check.returncode:
        fail(check.stderr.partition(": ")[2].rstrip())
    if library:
        os.environ["VHDL_LIBRARY"] = library[0]  # for vhdl_to_verilog.sh
    files = [os.path.abspath(f) for f in files]
    for f in files:
        if " " in f:
            fail(f"'{f}' has a space in its name, which makefiles cannot have: rename it, or its folder")
        if not kind_of(f) or not os.path.isfile(f):
            fail(f"there is no Verilog or VHDL file '{f}'")
    if library and not any(map(is_vhdl, files)):
        fail("LIBRARY: the library that VHDL files say they are in; these are Verilog")
    headers = [f for f in files if kind_of(f) == "header"]
    files = [f for f in files if f not in headers]
    if not files or len({is_vhdl(f) for f in files}) > 1:
        fail("FILES are all Verilog or all VHDL, and at least one")
    top = check_names(name, top, files)
    ports, parameters = read_module(top, files, headers, params, defines)
    copies = {} if is_vhdl(files[0]) else copies_for_verilator(top, files, headers, defines)
    # A level that OpenCores' cores have as a parameter.
    levels = [p for p in ["ARST_LVL=1'b1"] if p[:8] in parameters and not any(q.startswith("ARST_LVL=") for q in params)]
    if odd := [n for n in ports if not re.fullmatch(r"\w+", n)]:
        fail(f"{top} has the port '{odd[0]}', an escaped name: put a module with plain names around it")
    two_way = [n for n, p in ports.items() if p["direction"] == "inout"]
    if two_way:
        fail(f"{top} has the inout port '{two_way[0]}': tri-states belong to the chip's pads; take a top without")
    roles, latency = roles_of(top, bus, ports, given)
    if is_vhdl(files[0]):
        generics, params = params, []
    source = f"REGS {name}.regs.json" + (f" CLOCK {clock[0]}" if clock else "")
    if bus == "axis":
        if wrong := foreign_axis.problem(top, ports, roles):
            fail(wrong)
        source, answers = f"ICE {name}.ice", "operation: process" + "".join(
            f", set{foreign_axis.camel(foreign_axis.setting(n))}" for n in ports if roles[n] == "setting")
        texts = foreign_axis.texts(name, top, overrides(params), ports, roles, pin_name, vector, SLOT)
    else:
        verilog, word_bits, adr_bits, data_width, pins = write_verilog(name, top, bus, ports, roles, latency, params + levels, int(clock[0]) if clock else 0)
        words = names_of(top, files, word_bits) or {a: f"REG{a}" for a in range(min(8, 1 << word_bits))}
        first, answers = next(iter(words.values())), "registers: " + " ".join(words.values())
        registers = description(name, top, bus, words, adr_bits, data_width, pins)
        texts = {f"{name}.v": verilog, f"{name}_test.cpp": test_of(name, first),
                 f"{name}.regs.json": json.dumps(registers, indent=2) + "\n", "ground.py": ground_of(name, first)}
    if is_vhdl(files[0]):
        build = (f"icesoc_vhdl(NAME {top}{' LIBRARY ' + library[0] if library else ''}{' GENERICS ' + ' '.join(generics) if generics else ''} SOURCES\n  " + "\n  ".join(files) + ")\n"
                 f"icesoc_core({name} {source} FLAGS -Wno-lint -Wno-style DEPENDS {top}_verilog\n"
                 f"  VERILOG {name}.v ${{GEN_DIR}}/{top}.v)\n")
    else:
        for f, text in copies.items():  # beside the slot, in the place of the file
            texts["copy_" + os.path.basename(f)] = text
            files = ["copy_" + os.path.basename(f) if g == f else g for g in files]
        build = (f"icesoc_core({name} {source} FLAGS {' '.join(FLAGS)} "
                 + " ".join("-I" + d for d in folders_of([*files, *copies, *headers])) + f"\n  VERILOG {name}.v "
                 + "\n  ".join([*files, *headers]) + ")\n")
    texts["CMakeLists.txt"] = "# SPDX-License-Identifier: MIT\n" + build
    os.makedirs(folder)
    for file, text in texts.items():
        with open(os.path.join(folder, file), "w") as out:
            out.write(text)
    print(f"{folder}: {' '.join(sorted(os.listdir(folder)))}")
    if copies:
        print(f"  copies with macros, paths of data, and words of SystemVerilog as names: {' '.join(map(os.path.basename, copies))}")
    for n in ports:
        print(f"  {n}: {roles[n] or 'pin ' + pin_name(n, ports[n])}")
    print(f"  {answers}")
    print(f"Next: look at what is above; make ip-test IP={name}; a line {name} in ip/cores.list; "
          f"make run CORES={name}")


if __name__ == "__main__":
    main(sys.argv[1:])
