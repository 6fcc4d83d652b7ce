# SPDX-License-Identifier: MIT
"""new_foreign: puts a third-party core in Verilog or VHDL into a slot.

    new_foreign.py NAME TOP wishbone|axil|apb|avalon|memory|own|axis FOLDER [CLOCK=Hz]
                   [GHDL=program] [LIBRARY=name|name=file...] [ADDRESS=words|bytes]
                   [PARAM:NAME=value...] [DEFINE:NAME...] [SPELLING=make] [ROLE=port...] FILE...

Reads the ports of the module or entity TOP, and writes these files into FOLDER, which must not
exist: NAME.v, which connects TOP to the slot; a description of the registers, with the names that
TOP uses for their addresses; a test; ground.py, which calls the core in a mission; core.toml. Ports
that do not belong to the bus and are not a clock, reset or interrupt become pins. A core with
AXI-Streams (axis) has an operation instead of registers: foreign_axis.py.

SPELLING  make: messages name make's variables, not the options of ./icesoc
CLOCK     the core has a separate clock with at most this frequency, in Hz
GHDL      program that reads VHDL (ghdl)
LIBRARY   VHDL library of the files; NAME=FILE puts one file, or the files of a pattern, into
          another library
ADDRESS   unit of the core's address: words or bytes
PARAM     parameter or generic of TOP
DEFINE    Verilog macro, NAME or NAME=value
ROLE      role of a port, if its name does not show its role
"""
import fnmatch
import json
import os
import re
import sys
from pathlib import Path

from icesoc.cores import foreign_axis
from icesoc.cores import foreign_bus
from icesoc.util import spelling
from icesoc.util.reserved import REFUSAL, RESERVED
from icesoc.cores.foreign_files import (FLAGS, check_names, fail, folders_of, is_vhdl, kind_of,
                                        macros_of, names_of, packages_first, pin_name,
                                        verilog_params)
from icesoc.cores.foreign_ports import copies_for_verilator, read_module
from icesoc.cores.foreign_roles import NEEDED, roles_of, with_members
from icesoc.util.spelling import option

HEAD = "# SPDX-License-Identifier: MIT\n"
USAGE = ("usage: ./icesoc core foreign my_uart --top MODULE "
         "--bus wishbone|axil|apb|avalon|memory|own|axis --files a.v b.v [--ports write=we ...]")


# Words in the name of an output that may be an interrupt.
ASKED = re.compile("irq|(?<!po)(?<!pr)(?<!h)int(r|errupt)?s?(_?n)?(_?o)?$|(^|_)int(_|$)|ev(en)?t|"
                   "alarm|attention", re.I)


def check_pairs(called, pairs):
    """Ends the program if the name of a parameter or macro is invalid or occurs twice."""
    names = [pair.partition("=")[0] for pair in pairs]
    for name in names:
        if not re.fullmatch(r"[A-Za-z_]\w*", name, re.A):
            fail(f"{called}: expected a name, got '{name}'")
        if names.count(name) > 1:
            fail(f"{called}: {name} is given twice; give it once")


class Request:
    """Arguments of the command line."""

    def __init__(self, words):
        if len(words) < 5:
            sys.exit(USAGE)
        self.name, self.top, self.bus, self.folder, *rest = words
        options = {"CLOCK=": [], "LIBRARY=": [], "ADDRESS=": [], "GHDL=": [], "PARAM:": [],
                   "DEFINE:": [], "SPELLING=": []}
        self.ports, self.files = [], []
        for word in rest:
            start = next((o for o in options if word.startswith(o)), None)
            if start:
                options[start].append(word[len(start):])
            else:
                (self.ports if "=" in word else self.files).append(word)
        self.params, self.defines = options["PARAM:"], options["DEFINE:"]
        spelling.IS_MAKE = "make" in options["SPELLING="]
        check_pairs(option("params"), self.params)
        check_pairs(option("defines"), self.defines)
        self.library = next((o for o in options["LIBRARY="] if "=" not in o), "")
        self.members = [o.split("=", 1) for o in options["LIBRARY="] if "=" in o]
        self.clock, self.address, self.ghdl = (
            next(iter(options[o]), "") for o in ("CLOCK=", "ADDRESS=", "GHDL="))
        self.ghdl = self.ghdl or "ghdl"

    def check(self):
        """Ends the program if the request is impossible."""
        if self.clock and not (re.fullmatch("[0-9]{7,9}", self.clock)
                               and 3000000 <= int(self.clock) <= 100000000):
            fail(f"{option('clock')}: expected 3000000 to 100000000 Hz, the frequency of the "
                 f"core's separate clock, got '{self.clock}'")
        if self.clock and self.bus == "axis":
            fail(f"{option('clock')}: a core with AXI-Streams uses a DDR3 port, which has the "
                 "chip clock")
        if self.address not in ("", "words", "bytes") or self.address and self.bus == "axis":
            fail(f"{option('address')}: expected words or bytes, and a core with registers, got "
                 f"'{self.address}'")
        if self.bus not in NEEDED:
            fail(f"{option('bus')}: expected one of {', '.join(NEEDED)}, got '{self.bus}'")
        if not re.fullmatch(r"[a-z][a-z0-9]*(_[a-z0-9]+)*", self.name):
            fail(f"'{self.name}': expected words of small letters and digits, joined by _")
        if not re.fullmatch(r"[A-Za-z_]\w*", self.top):
            fail(f"{option('top')}: expected the name of a module or an entity, got "
                 f"'{self.top}'")
        if os.path.exists(self.folder):
            fail(f"{self.folder} already exists; choose another name, or remove it first")
        if self.name in RESERVED:
            fail(f"'{self.name}' {REFUSAL}")

    def take_files(self):
        """Splits the files into sources and headers."""
        files = list(dict.fromkeys(os.path.abspath(f) for f in self.files))
        for f in files:
            if " " in f:
                fail(f"'{f}': expected a path without spaces, because makefiles cannot have them; "
                     "rename the file or folder")
            if not kind_of(f) or not os.path.isfile(f):
                fail(f"'{f}': expected a Verilog or VHDL file")
        if (self.library or self.members) and not any(map(is_vhdl, files)):
            fail(f"{option('library')}: expected VHDL files, got Verilog, which has no libraries")
        self.libraries = []
        for library, pattern in self.members:
            found = [f for f in files if fnmatch.fnmatch(f, os.path.abspath(pattern))
                     or fnmatch.fnmatch(os.path.basename(f), pattern)]
            if not found or not re.fullmatch(r"[A-Za-z]\w*", library):
                fail(f"{option('library')}: expected a library and one of the files, got "
                     f"'{library}={pattern}'")
            self.libraries += [f"{library}={f}" for f in found]
            files = [f for f in files if f not in found]
        self.headers = [f for f in files if kind_of(f) == "header"]
        self.files = packages_first([f for f in files if f not in self.headers])
        if not self.files or len({is_vhdl(f) for f in self.files}) > 1:
            fail(f"{option('files')}: expected only Verilog or only VHDL files, and at least one "
                 "in the library of the top module")
        self.is_vhdl, self.is_synthesised = is_vhdl(self.files[0]), True
        if not self.is_vhdl:
            self.params = verilog_params(self.params)
        self.top = check_names(self.name, self.top, self.files)


def read_core(asked):
    """Returns TOP's ports, the parameters of its instance, and {file: text} for files that
    Verilator does not accept unchanged."""
    ports, is_synthesised = read_module(asked.top, asked.files, asked.headers, asked.params,
                                        asked.defines, ghdl=asked.ghdl, library=asked.library,
                                        libraries=asked.libraries)
    if odd := [n for n in ports if not re.fullmatch(r"\w+", n)]:
        fail(f"{asked.top} has the port '{odd[0]}', an escaped name; write a module around it with "
             "plain names of ports")
    if two_way := [n for n, p in ports.items() if p["direction"] == "inout"]:
        fail(f"{asked.top} has the inout port '{two_way[0]}': a core inside the chip cannot have "
             "tri-state ports; choose a top module without such ports")
    ports = with_members(ports, asked.bus, asked.ports)
    if asked.is_vhdl:
        return ports, [], {}
    asked.is_synthesised = is_synthesised
    return ports, asked.params, copies_for_verilator(asked.top, asked.files, asked.headers,
                                                     asked.defines)


def slot_texts(asked, ports, params):
    """Returns the files of the slot by name, the keys that core.toml has for the registers or the
    interface, the meaning of each port, and the last line of the report."""
    roles, latency = roles_of(asked.top, asked.bus, ports, asked.ports)
    if wide := [n for n, p in ports.items() if not roles[n] and len(p["bits"]) > 32]:
        left_out = [f"{'open' if ports[n]['direction'] == 'output' else 'low'}={n}" for n in wide]
        fail(f"'{wide[0]}' of {asked.top} has {len(ports[wide[0]]['bits'])} bits, but a pin has "
             f"at most 32: {option('ports', left_out)} leaves such ports unconnected")
    said = {n: roles[n] or "pin " + pin_name(n, p) for n, p in ports.items()}
    for n, p in ports.items():
        if not roles[n] and p["direction"] == "output" and ASKED.search(n):
            said[n] += f"; if it is an interrupt: {option('ports', f'interrupt={n}')}"
    if asked.bus == "axis":
        if wrong := foreign_axis.problem(asked.top, ports, roles):
            fail(wrong)
        operations = "operation: process" + "".join(
            f", set{foreign_axis.camel(foreign_axis.setting(n))}"
            for n in ports if roles[n] == "setting")
        return foreign_axis.texts(asked.name, asked.top, params, ports,
                                  roles), {"interface": f"{asked.name}.ice"}, said, operations
    core = foreign_bus.Core(asked.name, asked.top, asked.bus, ports, roles, latency, params,
                            int(asked.clock or 0), asked.address,
                            macros_of([*asked.files, *asked.headers]))
    for n in ports:
        if roles[n] in foreign_bus.ADDRESSES:
            said[n] += ", " + core.unit
    texts, registers = foreign_bus.texts(core, names_of(asked.top, asked.files, core))
    return texts, {"registers": f"{asked.name}.regs.json", "window": True,
                   "pins": core.pin_table()}, said, registers


def from_here(text, folder):
    """Replaces absolute names of files near the core's folder by relative ones, because a
    repository may be moved."""
    room = re.escape(os.path.dirname(os.path.abspath(folder)))
    return re.sub(rf'(?<=["I=]){room}(?=/)', "@FOLDER@/..", text)


def toml(value):
    """Returns a value in TOML's notation."""
    if isinstance(value, list):
        return "[" + "".join(f"\n    {toml(v)}," for v in value) + ("\n]" if value else "]")
    if isinstance(value, dict):
        return "{" + ", ".join(f"{k} = {toml(v)}" for k, v in value.items()) + "}"
    return json.dumps(value, ensure_ascii=False)


def manifest_of(asked, interface, pins, copies):
    """Returns the text of core.toml. `copies`: files that are replaced by a copy in the slot's
    folder."""
    facts = dict(interface)
    if asked.clock:
        facts["clock_hz"] = int(asked.clock)
    facts["verilog"] = [f"{asked.name}.v"]
    facts["flags"] = ["-Wno-lint", "-Wno-style"]
    entity = {}
    if asked.is_vhdl:
        entity = {"files": asked.files, "foreign": True}
        if asked.library:
            entity["library"] = asked.library
        if asked.libraries:
            entity["libraries"] = asked.libraries
        if asked.params:
            entity["generics"] = asked.params
    else:
        files = [copies.get(f, f) for f in asked.files]
        facts["verilog"] += [*files, *asked.headers]
        facts["flags"] = [*FLAGS, *("-I" + (d or "@FOLDER@") for d in folders_of(
            [*files, *copies, *asked.headers]))]
    if pins:
        facts["pins"] = pins
    text = HEAD + "".join(f"{key} = {toml(value)}\n" for key, value in facts.items())
    if entity:
        text += f"\n[entities.{asked.top}]\n" + "".join(
            f"{key} = {toml(value)}\n" for key, value in entity.items())
    return text


def main(words):
    asked = Request(words)
    asked.check()
    asked.take_files()
    ports, params, copied = read_core(asked)
    texts, interface, said, last = slot_texts(asked, ports, params)
    # the copies are in the slot's folder
    copies = {f: "copy_" + os.path.basename(f) for f in copied}
    texts.update({copies[f]: text for f, text in copied.items()})
    pins = interface.pop("pins", [])
    texts["core.toml"] = from_here(manifest_of(asked, interface, pins, copies), asked.folder)
    folder = Path(asked.folder)
    folder.mkdir(parents=True)
    for file, text in texts.items():
        (folder / file).write_text(text)
    print(f"{folder}: {' '.join(sorted(texts))}")
    if copies:
        print("  copies, changed in macros, paths of data, names or byte order marks: "
              f"{' '.join(map(os.path.basename, copies))}")
    for port, what in said.items():
        print(f"  {port}: {what}")
    print(f"  {last}")
    if not asked.is_synthesised:
        print("  Yosys cannot read this SystemVerilog. Tests and flights use it unchanged. For "
              "synthesis and the real chip, convert it with sv2v (github.com/zachjs/sv2v, not in "
              f"Debian), and name the result with {option('files')}:")
        print(f"  sv2v --top={asked.top} {' '.join('-I ' + d for d in folders_of(asked.headers))} "
              f"{' '.join('-D ' + d for d in asked.defines)} {' '.join(asked.files)} "
              f">{asked.top}.v")
    print("Check the list above.")


if __name__ == "__main__":
    main(sys.argv[1:])
