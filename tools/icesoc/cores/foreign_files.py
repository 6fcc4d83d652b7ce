# SPDX-License-Identifier: MIT
"""foreign_files: finds modules, names of registers and macros in the files of a third-party core,
for new_foreign.py, and provides code common to all wrappers."""
import codecs
import functools
import os
import re
import sys
from pathlib import Path

from icesoc import TREE
from icesoc.util.spelling import option
from icesoc.util import templates
from icesoc.util.rooms import PLATFORM

KINDS = {".vhd": "vhdl", ".vhdl": "vhdl", ".v": "verilog", ".sv": "verilog",
         ".vh": "header", ".svh": "header", ".h": "header", ".inc": "header"}
# Options that make Verilator accept third-party code of any style.
FLAGS = ["-Wno-fatal", "-Wno-lint", "-Wno-style",
         *("-Wno-" + w for w in "TIMESCALEMOD SELRANGE COMBDLY INITIALDLY".split()),
         "-Werror-MODDUP", "--no-timing"]


def fail(text):
    sys.exit("core foreign: " + text)


def end_of(file):
    return os.path.splitext(file)[1].lower()


def kind_of(file):
    """Returns "vhdl", "verilog", "header" or None, by the suffix of the file."""
    return KINDS.get(end_of(file))


def is_vhdl(file):
    return kind_of(file) == "vhdl"


def text_of(file):
    """Returns the text of a file, without the byte order mark that some editors write."""
    with open(file, errors="replace", encoding="utf-8-sig") as f:
        return f.read()


def has_mark(file):
    """Returns whether a file begins with a byte order mark. Yosys 0.23 skips the first module of
    such a file without a message."""
    with open(file, "rb") as f:
        return f.read(3) == codecs.BOM_UTF8


def check_number(name, value):
    """Ends the program if a Verilog number has a digit that its base does not have, or a value that
    does not fit its size. Tools disagree about such numbers, and some print no message."""
    m = re.fullmatch(r"([-+]?)(\d*)'?([sS]?)([bodhBODH]?)([\w?]+)", value)
    if not m or not (m[4] or m[5].replace("_", "").isdigit()):
        return  # a text or a number with a fraction needs no check
    base = {"b": 2, "o": 8, "h": 16}.get(m[4].lower(), 10)
    digits = (m[5] if m[4] else m[2] + m[5]).replace("_", "").lower()
    bits = int(m[2]) if m[4] and m[2] else 32
    known = re.sub("[xz?]", "0", digits)
    try:
        number = int(known, base)
    except ValueError:
        fail(f"{option('params')}: {name}: expected digits of base {base}, got '{value}'")
    if number > 2**(bits - 1) if m[1] == "-" and not m[4] else number >= 2**bits:
        fail(f"{option('params')}: {name}: expected a number of at most {bits} bits, got '{value}'")


def verilog_params(params):
    """Returns parameters with values in Verilog's notation. Each is NAME=value as a user types it:
    a number such as -3 or 8'hFF, a number in C's notation such as 0xFF, or a text with or without
    quotes.
    """
    found = []
    for param in params:
        name, _, value = param.partition("=")
        if m := re.fullmatch(r"0[xX]([0-9a-fA-F]+[0-9a-fA-F_]*)", value):
            value = f"{max(32, 4 * len(m[1].replace('_', '')))}'h{m[1]}"
        elif re.fullmatch(r"[A-Za-z_][\w .-]*", value):
            value = f'"{value}"'
        elif not re.fullmatch(r"[-+]?\d[\d_]*(\.\d+)?([eE][-+]?\d+)?"
                              r"|\d*'[sS]?[bodhBODH][0-9a-fA-FxXzZ_?]+"
                              r'|"[^"\\\n]*"', value):
            fail(f"{option('params')}: {name}: expected a number such as -3, 8'hFF or "
                 f"0xFF, or a text, got '{value}'")
        check_number(name, value)
        found.append(f"{name}={value}")
    return found


def folders_of(files):
    return sorted({os.path.dirname(f) for f in files} - {""})


def declared(files, kind):
    """Returns the modules, entities or packages of the files: (name, file, line)."""
    def lines_of(comment: re.Match[str]) -> str:
        return "\n" * comment.group().count("\n")

    found = []
    for f in files:
        text = re.sub(r"/\*.*?\*/|//[^\n]*", lines_of, text_of(f), flags=re.S)
        found += [(m.group(1), f, text.count("\n", 0, m.start(1)) + 1)
                  for m in re.finditer(rf"^[ \t]*{kind}\s+(?:automatic\s+)?(\w+)", text,
                                       re.M | re.I)]
    return found


def only_once(modules, what_to_do):
    """Returns the file of each module. A module in two files is an error; its message ends with
    `what_to_do`."""
    first = {}
    for name, file, line in modules:
        other, at = first.setdefault(name, (file, line))
        if other != file:
            fail(f"{file}:{line}: module '{name}' is also in {other}:{at}: {what_to_do}")
    return first


def check_names(slot, top, files):
    """Checks that each module is in only one file, and that no module has the name of the slot or
    of a module of this project, because names must be unique in a chip. Returns TOP, spelled as in
    its declaration."""
    kind = "entity" if is_vhdl(files[0]) else "module"
    there = declared(files, kind)
    names = [n for n, *_ in there]
    if kind == "entity":  # names in VHDL are case-insensitive; GHDL writes them as declared
        top = next((n for n in names if n.lower() == top.lower()), top)
    if top not in names:
        fail(f"no {kind} '{top}' in {option('files')}; found {', '.join(names) or 'none'}")
    if slot in names:
        fail(f"'{slot}' is also the name of a {kind} of the core; give the slot another name")
    first = only_once(there, "leave one of the files out") if kind == "module" else {}
    room = str(TREE)
    ours = [os.path.join(d, f) for r in PLATFORM
            for d, _, there in os.walk(os.path.join(room, r)) for f in there
            if f.endswith(".v")]
    for name, file, line in declared(ours, "module"):
        if name == slot:
            fail(f"'{slot}' is the name of this project's module in "
                 f"{os.path.relpath(file, room)}: give the slot another name")
        if name in first and first[name][0] != file:
            fail(f"{first[name][0]}:{first[name][1]}: module '{name}' has the same name as a "
                 f"module of this project ({os.path.relpath(file, room)}:{line}); rename your "
                 "module, also in the modules that instantiate it")
    return top


def packages_first(files):
    """Returns the files in an order in which each SystemVerilog package comes before the files that
    use it."""
    there = {name: f for name, f, _ in declared(files, "package")}
    ordered = []

    def put(file, above=()):
        for name, other in there.items():
            if other not in (*above, file) and re.search(rf"\b{name}::", text_of(file)):
                put(other, (*above, file))
        if file not in ordered:
            ordered.append(file)

    for file in files:
        put(file)
    return ordered


def filled(file, defines):
    """Returns the text of a file with two changes. Paths of existing files, for example in
    $readmemh, become absolute, because a simulation may run in any folder. If the file contains a
    module, the macros `defines` are defined before the text and undefined after it."""
    def path(m):
        there = os.path.join(os.path.dirname(file), m.group(1))
        return f'"{there}"' if os.path.isfile(there) else m.group()
    text = re.sub(r'(?<!`include )"([^"\n/]+\.\w+)"', path, text_of(file))
    if not declared([file], "module"):
        return text
    before = "".join(f"`define {d.replace('=', ' ', 1)}\n" for d in defines)
    return before + text + "".join(f"\n`undef {d.split('=')[0]}\n" for d in defines)


def macros_of(files):
    """Returns the macros that are byte addresses of registers, as {name: value}. These are all
    macros with a sized hexadecimal number as value. The result is empty unless all sizes are
    equal and all values are different multiples of 4."""
    found = re.findall(r"^\s*`define\s+(\w+)\s+(\d+)'h([0-9a-fA-F_]+)\s*(?://.*)?$",
                       "\n".join(map(text_of, files)), re.M)
    values = {n: int(digits, 16) for n, _, digits in found}
    return values if len({size for _, size, _ in found}) == 1 and \
        1 < len(values) == len(set(values.values())) and not any(
            value % 4 for value in values.values()) else {}


def names_of(top, files, core):
    """Returns the names of the core registers by word address. The names come from localparams in
    the file of module `top` that are as wide as the address. Without such constants, they
    come from the macros. If two names such as KEY0 and KEY7 are 7 words apart, the words between
    them get the names KEY1 to KEY6."""
    text = next((t for t in map(text_of, files) if re.search(rf"^\s*module\s+{top}\b", t, re.M)),
                "")
    text = re.sub(r"//.*", "", text)
    base = {"h": 16, "d": 10, "b": 2}
    found = [(n, int(digits, base[b.lower()]))
             for part in re.findall(r"\blocalparam\b([^;]*);", text)
             for n, b, digits in re.findall(
                 rf"(\w+)\s*=\s*{core.word_bits}'([hdb])([0-9a-fA-F_]+)", part, re.I)]
    if len(found) < 2 or len({v for _, v in found}) < len(found):
        found = [(n, v // 4) for n, v in core.macros.items()
                 if core.step == 4 and v < 4 << core.word_bits]
    if len(found) < 2:
        return {}
    prefix = os.path.commonprefix([n for n, _ in found])
    prefix = prefix[:prefix.rfind("_") + 1]
    names = {v: n[len(prefix):].upper() for n, v in found}
    for value, name in list(names.items()):
        word, first = re.fullmatch(r"(.*?)(\d*)", name).groups()
        for last, other in [(v, n) for v, n in names.items() if v > value]:
            is_row = first and re.fullmatch(rf"{word}\d+", other)
            if is_row and int(other[len(word):]) - int(first) == last - value:
                names.update({value + i: f"{word}{int(first) + i}" for i in range(last - value)})
    return {v: ("CORE_" + n if n in ("ID", "EVENT", "MASK", "PAGE") or not n[0].isalpha() else n)
            for v, n in sorted(names.items())}


# ---- pieces of Verilog that the wrapper of every third-party core has ----
def vector(width):
    return f"[{width - 1}:0] " if width > 1 else ""


def pin_name(name, port):
    """Returns the name of a port in the form of the platform pins: in lower case, with _i or _o
    at its end."""
    base = "_".join(re.sub(r"^[io]_|_[io]$", "", part) for part in name.lower().split("."))
    return base + ("_i" if port["direction"] == "input" else "_o")


def connected_ports(ports, connection):
    """Returns the port connections of an instance, and declarations of wires for unused members of
    structures. A packed structure is connected as the concatenation of its members. `connection`:
    function that returns the expression for a port or member, given its name and its
    description."""
    parts, wires = {}, []
    for name, port in ports.items():
        whole, _, member = name.partition(".")
        text = connection(name, port)
        if member and not text:
            text = f"unused_{name.replace('.', '_')}"
            wires.append(f"    wire {vector(len(port['bits']))}{text};")
        parts.setdefault(whole, []).append((member, text))
    return [f".{whole}({{{', '.join(text for _, text in texts)}}})" if texts[0][0]
            else f".{whole}({texts[0][1]})" for whole, texts in parts.items()], wires


def overrides(params):
    """Returns the parameter list of an instance in Verilog."""
    return f" #({', '.join('.{}({})'.format(*p.split('=', 1)) for p in params)})" if params else ""


@functools.cache
def environment():
    return templates.environment(Path(__file__).with_name("templates"), vector=vector,
                                 overrides=overrides)


def folded(text):
    """Returns Verilog in which lines of more than 100 columns are broken after a comma."""
    lines = []
    for line in text.split("\n"):
        indent = " " * (len(line) - len(line.lstrip()) + 4)
        while len(line) > 100 and (at := line.rfind(", ", len(indent), 100)) > 0:
            lines.append(line[:at + 1])
            line = indent + line[at + 2:]
        lines.append(line)
    return "\n".join(lines)


def render(template, **values):
    """Returns the text of a file for the folder of a slot."""
    text = environment().get_template(template).render(**values)
    return folded(text) if template.endswith(".v.j2") else text


# usage: foreign_files.py FILE..., the Verilog files of all cores of a chip
if __name__ == "__main__":
    only_once(declared([f for f in sys.argv[1:] if os.path.isfile(f)], "module"),
              "a chip has one of each: give one of them another name, in a copy, where it is "
              "used as well")
