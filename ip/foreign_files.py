# SPDX-License-Identifier: MIT
"""foreign_files: what new_foreign.py reads of a third-party core's files: which modules there are, and TOP's ports."""
import json
import os
import re
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
KINDS = {".vhd": "vhdl", ".vhdl": "vhdl", ".v": "verilog", ".sv": "verilog",
         ".vh": "header", ".svh": "header", ".h": "header", ".inc": "header"}


def fail(text):
    sys.exit("new-foreign: " + text)


def end_of(file):
    return os.path.splitext(file)[1].lower()


def kind_of(file):
    """"vhdl", "verilog", "header" or None, by the end of the file's name."""
    return KINDS.get(end_of(file))


def is_vhdl(file):
    return kind_of(file) == "vhdl"


def text_of(file):
    with open(file, errors="replace") as f:
        return f.read()


def folders_of(files):
    return sorted({os.path.dirname(f) for f in files} - {""})


def declared(files, kind):
    """The modules, entities or packages of the files: (name, file, line)."""
    found = []
    for f in files:
        text = re.sub(r"/\*.*?\*/|//[^\n]*", lambda m: "\n" * m.group().count("\n"), text_of(f), flags=re.S)
        found += [(m.group(1), f, text.count("\n", 0, m.start(1)) + 1)
                  for m in re.finditer(rf"^[ \t]*{kind}\s+(?:automatic\s+)?(\w+)", text, re.M | re.I)]
    return found


def check_names(top, files):
    """Each module is in one file, and none has the name of one of this project's: in the chip there is one of each."""
    kind = "entity" if is_vhdl(files[0]) else "module"
    there = declared(files, kind)
    if top not in (names := [n for n, *_ in there]):
        fail(f"there is no {kind} '{top}' in FILES; there is {', '.join(names) or 'none'}")
    if kind == "entity":
        return
    first = {}
    for name, file, line in there:
        other, at = first.setdefault(name, (file, line))
        if other != file:
            fail(f"{file}:{line}: module '{name}' is in {other}:{at}, too: leave one of the files out")
    room = os.path.dirname(HERE)
    ours = [os.path.join(d, f) for r in ("bus", "hdl") for d, _, there in os.walk(os.path.join(room, r)) for f in there
            if f.endswith(".v")]
    for name, file, line in declared(ours, "module"):
        if name in first and first[name][0] != file:
            fail(f"{first[name][0]}:{first[name][1]}: module '{name}' has the name of this project's "
                 f"{os.path.relpath(file, room)}:{line}: give it another, where it is used, too")
    for name, file, line in declared([f for f in files if end_of(f) == ".sv"], "package"):
        fail(f"{file}:{line}: package '{name}': Yosys does not read it for the report; make Verilog of it by sv2v")


def converted(top, files, work):
    """The entity `top` as one file of Verilog."""
    out = os.path.join(work, top + ".v")
    script = os.path.join(HERE, "../cmake/vhdl_to_verilog.sh")
    run = subprocess.run([script, os.environ.get("GHDL", "ghdl"), work, top, out, *files], capture_output=True, text=True)
    if run.returncode:
        fail(f"GHDL does not convert {top}:\n{run.stdout}{run.stderr}".rstrip())
    return [out]


def read_module(top, files, headers=()):
    """The module `top` as Yosys has it: its ports in order, and the names of its parameters. `headers`: files in whose
    folders `include finds more."""
    with tempfile.TemporaryDirectory() as work:
        if is_vhdl(files[0]):
            files = converted(top, files, work)
        out = os.path.join(work, "top.json")
        folders = " ".join("-I" + d for d in folders_of([*files, *headers]))
        reads = [f"read_verilog -defer {'-sv' if end_of(f) == '.sv' else ''} {folders} {f}" for f in files]
        script = "; ".join([*reads, f"hierarchy -top {top}", "proc", f"write_json {out}"])
        run = subprocess.run(["yosys", "-q", "-p", script], capture_output=True, text=True)
        if run.returncode:
            hint = "\nFILES may name headers, too: `include finds what is in their folders" if "include file" in run.stderr else ""
            fail(f"Yosys does not elaborate {top}:\n{run.stdout}{run.stderr}".rstrip() + hint)
        modules = json.loads(text_of(out))["modules"]
    module = next(m for n, m in modules.items() if m["attributes"].get("top") or n == top)
    return module["ports"], module.get("parameter_default_values", {})


def names_of(top, files, bits):
    """Names of the core's words by their addresses: the constants of the file with `top` that are as wide as its
    address. KEY0 and KEY7 at a distance of 7 stand for those between, too."""
    text = next((t for t in map(text_of, files) if re.search(rf"^\s*module\s+{top}\b", t, re.M)), "")
    text = re.sub(r"//.*", "", text)
    base = {"h": 16, "d": 10, "b": 2}
    found = [(n, int(digits, base[b.lower()])) for part in re.findall(r"\blocalparam\b([^;]*);", text)
             for n, b, digits in re.findall(rf"(\w+)\s*=\s*{bits}'([hdb])([0-9a-fA-F_]+)", part, re.I)]
    if len(found) < 2 or len({v for _, v in found}) < len(found):
        return {}
    prefix = os.path.commonprefix([n for n, _ in found])
    prefix = prefix[:prefix.rfind("_") + 1]
    names = {v: n[len(prefix):].upper() for n, v in found}
    for value, name in list(names.items()):
        word, first = re.fullmatch(r"(.*?)(\d*)", name).groups()
        for last, other in [(v, n) for v, n in names.items() if v > value]:
            if first and re.fullmatch(rf"{word}\d+", other) and int(other[len(word):]) - int(first) == last - value:
                names.update({value + i: f"{word}{int(first) + i}" for i in range(last - value)})
    return {v: ("CORE_" + n if n in ("ID", "EVENT", "MASK", "PAGE") or not n[0].isalpha() else n)
            for v, n in sorted(names.items())}
