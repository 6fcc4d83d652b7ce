# SPDX-License-Identifier: MIT
"""regmap: turns the register description of a block (*.regs.json) into what each side includes.

<block>_regs.vh (Verilog localparams), <block>_regs.h (C90 macros), <block>_regs_pkg.vhd (VHDL
package), <block>_regs.md (page for people); or, with --clocked, <block>_clocked.v (the block behind
bus_crossing.v). Format of the description: docs/bus.md.
"""
import argparse
import json
import re
import sys
from pathlib import Path

ACCESSES = "ro", "rw", "w1c", "ws"
WORDS_PER_SLOT = 16
SCHEMA = json.loads(Path(__file__).with_name("regs.schema.json").read_text())
REGISTER = {"width": 32, "page": -1, "fields": []}  # page: a byte address behind an adapter
CLOCKED = """\
// Generated from {name}.regs.json: do not edit. {name} in a clock of its own (docs/hw-mapping.md).

`default_nettype none

module {name}_clocked{parameter} (
    `include "slot_ports.vh"
    output wire        irq_o,
    input  wire        clock_i{ports}
);
    wire        rst, valid, write, ready, error, irq;
    wire [3:0]  addr;
    wire [31:0] wdata, rdata;
    bus_crossing u_crossing (
        `include "slot_connect.vh"
        .irq_o(irq_o),
        .core_clk_i(clock_i), .core_rst_o(rst), .core_valid_o(valid), .core_write_o(write),
        .core_addr_o(addr), .core_wdata_o(wdata), .core_ready_i(ready), .core_rdata_i(rdata),
        .core_error_i(error), .core_irq_i(irq)
    );
    {name} {value}u_core (
        .clk_i(clock_i), .rst_i(rst), .bus_valid_i(valid), .bus_write_i(write), .bus_addr_i(addr),
        .bus_wdata_i(wdata), .bus_ready_o(ready), .bus_rdata_o(rdata), .bus_error_o(error),
        .irq_o(irq){pins}
    );
endmodule
"""


class Wrong(Exception):
    """An error in the input, with the words for the user."""


def check(holds, text):
    if not holds:
        raise Wrong(text)


def fit(value, part, where):
    """Checks a part of a description by its part of the schema."""
    part = SCHEMA["$defs"].get(part.get("$ref", "").rpartition("/")[2], part)
    kind = part["type"]
    if kind == "object":
        check(isinstance(value, dict), f"{where} is no object with names and values")
        for name, inner in part["properties"].items():
            check(name in value or name not in part["required"], f"{where} has no '{name}'")
            if name in value:
                fit(value[name], inner, name if part is SCHEMA else f"{where}.{name}")
    elif kind == "array":
        check(isinstance(value, list), f"{where} is no list")
        for i, each in enumerate(value):
            fit(each, part["items"], f"{where}[{i}]")
    else:
        holds = type(value) is {"string": str, "integer": int, "boolean": bool}[kind] and (
            re.fullmatch(part.get("pattern", ".*"), str(value), re.A | re.S) if kind == "string" else
            part.get("minimum", 0) <= value <= part.get("maximum", 1))
        check(holds, f"{where} is {json.dumps(value)[:40]}: it is to be {part['description']}")


def range_of(lsb, width):
    return str(lsb) if width == 1 else f"{lsb + width - 1}..{lsb}"


def registers_of(block):
    """Returns a block's registers, for a slot after the three words that every slot begins with."""
    registers = [{**REGISTER, **r} for r in block["registers"]]
    if "type" not in block:
        return registers
    events = [{"name": e["name"], "lsb": e["bit"], "width": 1, "doc": e["doc"]}
              for e in block.get("events", [])]
    ident = [{"name": "VERSION", "lsb": 0, "width": 16, "doc": "major and minor, 8 bits each",
              "reset": block["version"]},
             {"name": "TYPE", "lsb": 16, "width": 16, "doc": "type id", "reset": block["type"]}]
    common = (("ID", "ro", "type and version of the slot", ident),
              ("EVENT", "w1c", "sticky events; write 1 to clear", events),
              ("MASK", "rw", "1: the event drives the interrupt line", events))
    return [{**REGISTER, "word": word, "name": name, "access": access, "doc": doc, "fields": fields}
            for word, (name, access, doc, fields) in enumerate(common)] + registers


def constants_of(block):
    constants = list(block.get("constants", []))
    if "type" in block:
        constants.append({"name": "ID_VALUE", "doc": "what word ID reads",
                          "value": int(block["type"], 16) << 16 | int(block["version"], 16)})
    return constants


class Block:
    """A block's description, checked."""

    def __init__(self, description):
        fit(description, SCHEMA, "the description")
        check(("type" in description) == ("version" in description),
              "a slot has a type and a version")
        self.description = description
        self.name, self.doc = description["block"], description["doc"]
        self.prefix = self.name.upper()
        self.is_slot = "type" in description  # has ID, EVENT and MASK in words 0..2
        self.registers = registers_of(description)
        self.constants = constants_of(description)
        self.names = set()  # as the generated files spell them
        for c in self.constants:
            self.add_name(c["name"], c["name"])
        taken = set()
        for r in self.registers:
            self.check_register(r, taken)
            self.check_fields(r)

    @classmethod
    def read(cls, path):
        try:
            return cls(json.loads(Path(path).read_text("utf-8")))
        except (json.JSONDecodeError, OSError) as e:
            raise Wrong(str(e)) from None
        except (ValueError, RecursionError):
            raise Wrong("it is no JSON in UTF-8, or its numbers or brackets are too long") from None

    def add_name(self, spelled, name):
        check(spelled not in self.names, f"{name} is there twice")
        self.names.add(spelled)

    def check_register(self, r, taken):
        name, word, page = r["name"], r["word"], r["page"]
        self.add_name(name, name)
        check(0 <= word < WORDS_PER_SLOT, f"{name}: word {word} is not in 0..15")
        check((word, page) not in taken and (page < 0 or (word, -1) not in taken),
              f"{name}: word {word} is taken")
        taken.add((word, page))
        check(page < 0 or (word >= 8 and page % 32 == 0),
              f"{name}: only words 8..15 have a page, a multiple of 32")
        check(0 < r["width"] <= 32, f"{name}: its width is 1..32 bits")
        check(r["access"] in ACCESSES,
              f"{name}: access '{r['access']}' is not one of {' '.join(ACCESSES)}")

    def check_fields(self, r):
        used = 0
        for f in r["fields"]:
            name, lsb, width = f"{r['name']}.{f['name']}", f["lsb"], f["width"]
            check(lsb >= 0 < width and lsb + width <= 32,
                  f"{name}: bits {lsb + width - 1}..{lsb} do not fit a word")
            self.add_name(f"{r['name']}_{f['name']}_LSB", name)
            check(not used & mask_of(f), f"{name}: overlaps another field")
            used |= mask_of(f)


def mask_of(field):
    return ((1 << field["width"]) - 1) << field["lsb"]


def verilog(b):
    s = f"// Generated from {b.name}.regs.json: do not edit.\n// verilator lint_off UNUSEDPARAM\n"
    for c in b.constants:
        s += f"localparam [31:0] {b.prefix}_{c['name']} = 32'h{c['value']:08X}; // {c['doc']}\n"
    for r in b.registers:
        name = f"{b.prefix}_{r['name']}"
        s += f"localparam [3:0] {name} = 4'd{r['word']}; // {r['access']}: {r['doc']}\n"
        for f in r["fields"]:
            s += (f"localparam integer {name}_{f['name']}_LSB = {f['lsb']}, "
                  f"{name}_{f['name']}_WIDTH = {f['width']};\n")
    return s + "// verilator lint_on UNUSEDPARAM\n"


def table(b):
    """Returns registers and fields as initialisers of Hw_Register (sw/hw/registers)."""
    entries = []
    for r in b.registers:
        rows = [(r["name"], 0, r["width"])]
        rows += [(f"{r['name']}.{f['name']}", f["lsb"], f["width"]) for f in r["fields"]]
        entries += [f'    {{{{{len(name)}, "{name}"}}, Hw_{r["access"]}, {r["word"]}, {lsb}, '
                    f'{width}, {r["page"]}}}' for name, lsb, width in rows]
    return f"\n#define {b.prefix}_TABLE \\\n" + ", \\\n".join(entries) + "\n"


def c_header(b):
    s = f"/* Generated from {b.name}.regs.json: do not edit.\n * {b.doc} */\n#pragma once\n\n"
    for c in b.constants:
        s += f"#define {b.prefix}_{c['name']} 0x{c['value']:X}U /* {c['doc']} */\n"
    for r in b.registers:
        name = f"{b.prefix}_{r['name']}"
        s += f"\n#define {name} {r['word']}U /* {r['access']}: {r['doc']} */\n"
        if r["page"] >= 0:
            s += f"#define {name}_PAGE 0x{r['page']:X}U\n"
        for f in r["fields"]:
            s += (f"#define {name}_{f['name']}_LSB {f['lsb']}U /* {f['doc']} */\n"
                  f"#define {name}_{f['name']}_MASK 0x{mask_of(f):X}U\n")
    return s + (table(b) if b.is_slot else "")


def vhdl(b):
    s = (f"-- Generated from {b.name}.regs.json: do not edit.\n"
         f"package {b.name}_regs_pkg is\n")
    for c in b.constants:
        if c["value"] <= 0x7FFFFFFF:
            s += f"  constant {b.prefix}_{c['name']} : natural := {c['value']}; -- {c['doc']}\n"
    for r in b.registers:
        name = f"{b.prefix}_{r['name']}"
        s += f"  constant {name} : natural := {r['word']}; -- {r['access']}: {r['doc']}\n"
        for f in r["fields"]:
            s += (f"  constant {name}_{f['name']}_LSB : natural := {f['lsb']};\n"
                  f"  constant {name}_{f['name']}_WIDTH : natural := {f['width']};\n")
    return s + "end package;\n"


def markdown(b):
    s = f"# `{b.name}`\n\n{b.doc}\n"
    if b.constants:
        s += "\n| constant | value | meaning |\n|---|---|---|\n"
    for c in b.constants:
        s += f"| {c['name']} | {c['value']} (0x{c['value']:X}) | {c['doc']} |\n"
    if b.registers:
        s += "\n| word | register | access | bits | meaning |\n|---|---|---|---|---|\n"
    for r in b.registers:
        page = f", PAGE 0x{r['page']:X}" if r["page"] >= 0 else ""
        bits = f"{r['width'] - 1}..0" if r["width"] < 32 else ""
        s += f"| {r['word']}{page} | **{r['name']}** | {r['access']} | {bits} | {r['doc']} |\n"
        for f in r["fields"]:
            s += f"| | {f['name']} | | {range_of(f['lsb'], f['width'])} | {f['doc']} |\n"
    return s + ("\nAccess: ro read only; rw read and write; w1c write 1 to clear; ws write acts, "
                "reads as 0.\n")


def clocked(name, description, has_clk_hz):
    """Returns a module with a slot's ports around the block, which has a clock of its own."""
    check(not description.get("memory_port"),
          "a core with a memory port has the chip's clock, which the port has; one of its own for "
          "a part of the core: hdl/cdc/async_fifo.v, as ip/camera does")
    ports = pins = ""
    for p in description.get("pins", []):
        way = "output" if p["name"].endswith("o") else "input "
        width = p.get("width", 1)
        ports += f",\n    {way} wire {'' if width == 1 else f'[{width - 1}:0] '}{p['name']}"
        pins += f",\n        .{p['name']}({p['name']})"
    parameter = " #(\n    parameter CLK_HZ = 100000000 // of clock_i\n)" if has_clk_hz else ""
    value = "#(.CLK_HZ(CLK_HZ)) " if has_clk_hz else ""
    return CLOCKED.format(name=name, ports=ports, pins=pins, parameter=parameter, value=value)


def save(path, text):
    """Writes a text; an equal one stays as old as it is, so that nothing is built again for it."""
    path = Path(path)
    if not path.is_file() or path.read_bytes() != text.encode():
        path.write_bytes(text.encode())


def main():
    parser = argparse.ArgumentParser(
        description="Generates the Verilog, C, VHDL and Markdown view of a block's registers.")
    parser.add_argument("description", help="the block's *.regs.json")
    parser.add_argument("--output-dir", default=".", help="where the four files go")
    parser.add_argument("--clocked", action="store_true", help="instead of them <block>_clocked.v")
    parser.add_argument("--clk-hz", action="store_true",
                        help="whose module has the parameter CLK_HZ")
    asked = parser.parse_args()
    try:
        block = Block.read(asked.description)
        base = f"{asked.output_dir}/{block.name}"
        if asked.clocked:
            save(base + "_clocked.v", clocked(block.name, block.description, asked.clk_hz))
            return
        save(base + "_regs.vh", verilog(block))
        save(base + "_regs.h", c_header(block))
        save(base + "_regs_pkg.vhd", vhdl(block))
        save(base + "_regs.md", markdown(block))
    except (Wrong, OSError) as e:
        sys.exit(f"{asked.description}: error: {e}")


if __name__ == "__main__":
    main()
