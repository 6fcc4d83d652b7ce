# SPDX-License-Identifier: MIT
"""foreign_ports: reads the ports of a third-party core with Yosys, Verilator and GHDL, for
new_foreign.py. It prints progress messages if a tool takes longer than ten seconds."""
import json
import os
import re
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree
from pathlib import Path

from icesoc import TREE
from icesoc.cores.foreign_files import (FLAGS, declared, end_of, fail, filled, folders_of, has_mark,
                                        is_vhdl, overrides, text_of)
from icesoc.util.spelling import option

REPORT = 10  # s between progress messages about a tool that is still running
LIMIT = 60   # s; if Yosys needs longer, Verilator reads the files instead

# Messages of Verilator and Yosys, and what to do about them.
HINTS = {
    r"[Ii]nclude file:? (?:`)?([^\s']+)": lambda top, name: (
        f"{option('files')} may also name headers: `include looks for {name} in their folders "
        "(a timescale.v may be empty)"),
    r"(?:Module `\\|unknown type `|containing module: ')(\w+)": lambda top, name: (
        f"{option('files')} lacks the file with module '{name}'"),
    r"object for defparam `(\w+)|no generic \"(\w+)\"": lambda top, name: (
        f"{option('params')}: {top} has no '{name}'"),
    r"find resource library \"(\w+)\"": lambda top, name: (
        f"add {option('library', name)} if all files are in that library, or "
        f"{option('library', name + '=FILE')} for some of them")}


def run_tool(program, verb, top, command, is_needed=True, limit=None):
    """Runs a tool that reads the core. Returns True if the tool accepts the core, None if it has
    not ended after `limit` seconds. If the tool rejects the core, returns False, or, with
    `is_needed`, fails with the tool's message and advice."""
    begin = time.monotonic()
    with subprocess.Popen(list(map(str, command)), stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, errors="replace") as process:
        while True:
            try:
                output = process.communicate(timeout=min(REPORT, limit or REPORT))[0].rstrip()
                break
            except subprocess.TimeoutExpired:
                spent = time.monotonic() - begin
                if limit and spent >= limit:
                    process.kill()
                    return None
                print(f"core foreign: waiting for {program} to {verb} {top}: {spent:.0f} s",
                      file=sys.stderr, flush=True)
    if process.returncode and is_needed:
        lines = output.splitlines()
        hints = [hint(top, *filter(None, m.groups())) for words, hint in HINTS.items()
                 if (m := re.search(words, output))]
        fail("\n".join([f"{program} does not {verb} {top}:", *lines[:12],
                        *(["..."] if len(lines) > 12 else []), *hints]))
    return process.returncode == 0


def lint_of(top, files, defines):
    """Returns Verilator's command for a core; the caller appends the action and the files."""
    return ["verilator", *FLAGS, "--top-module", top, *("-I" + d for d in folders_of(files)),
            *("-D" + d for d in defines)]


def ports_by_verilator(top, words, is_needed=True):
    """Returns the ports of TOP in the form in which Yosys lists them. For a packed structure,
    "members" lists (name, bits), most significant member first. Returns None if Verilator fails and
    the result is not needed."""
    with tempfile.TemporaryDirectory() as work:
        file = os.path.join(work, "top.xml")
        if not run_tool("Verilator", "elaborate", top,
                        [*words, "--xml-only", "--xml-output", file, "--Mdir", work], is_needed):
            return None
        tree = xml.etree.ElementTree.parse(file)
    types = {t.get("id"): t for t in tree.find("netlist/typetable")}

    def width(number):
        t = types[number]
        if t.tag == "structdtype":
            return sum(width(member.get("sub_dtype_id")) for member in t)
        ends = [int(c.get("name").split("h")[1], 16) for c in t.findall("range/const")]
        if t.get("left"):
            ends = [int(t.get("left")), int(t.get("right"))]
        size = abs(ends[0] - ends[1]) + 1 if ends else 1
        return size * (width(t.get("sub_dtype_id")) if t.get("sub_dtype_id") else 1)

    def members(number):
        t = types[number]
        while t.tag == "refdtype":
            t = types[t.get("sub_dtype_id")]
        if t.tag != "structdtype":
            return []
        return [(".".join(filter(None, (member.get("name"), name))), bits) for member in t
                for name, bits in members(member.get("sub_dtype_id"))
                or [("", width(member.get("sub_dtype_id")))]]

    module = next(m for m in tree.iter("module") if m.get("topModule"))
    ports = {}
    for v in module.findall("var"):
        if v.get("dir"):
            number = v.get("dtype_id")
            ports[v.get("name")] = {"direction": v.get("dir"), "bits": [0] * width(number),
                                    "offset": int(types[number].get("right") or 0)}
            if found := members(number):
                ports[v.get("name")]["members"] = found
    return ports


def check_interfaces(top, files):
    """Rejects a top module with a SystemVerilog interface as a port, because the slot's wrapper is
    in Verilog."""
    names = [name for name, *_ in declared(files, "interface") if name != "class"]
    for file in files:
        text = re.sub(r"/\*.*?\*/|//[^\n]*", "", text_of(file), flags=re.S)
        header = re.search(rf"\bmodule\s+{top}\b(.*?;.*?|.*?)\)\s*;", text, re.S)
        for kind in ["interface", *names] if header else []:
            port = re.search(rf"[(,]\s*({kind}(?:\s*\.\s*\w+)?)\s+(\w+)\s*(?=[,)\[])",
                             header[1] + ")")
            if port:
                kind = "the_interface" if kind == "interface" else kind
                fail(f"{file}: {top} has the port '{port[2]}', a SystemVerilog interface "
                     f"({port[1]}), and a slot connects plain ports and packed structures only. "
                     "Write a module with the signals of the interface as ports, add its file to "
                     f"{option('files')}, and name it with {option('top')}:\n"
                     f"  module {top}_plain (input logic clk, input logic sel, ..., output logic "
                     "[31:0] rdata);\n"
                     f"    {kind} {port[2]} (...);             // an instance of the interface\n"
                     f"    assign {port[2]}.sel = sel;            // each input\n"
                     f"    assign rdata = {port[2]}.rdata;        // each output\n"
                     f"    {top} u_core (.{port[2]}({port[2]}));\n"
                     "  endmodule")


def without_initial(text):
    """Returns Verilog without its `initial` blocks. They have no influence on ports, but Yosys
    unrolls their loops, which takes minutes for a memory of 64 KiB. Line numbers do not change. A
    block with an `ifdef inside is kept."""
    tokens = [m for m in re.finditer(
        r'//[^\n]*|/\*.*?\*/|`define(?:\\\r?\n|[^\n])*|"(?:\\.|[^"\\])*"|[`$]?[A-Za-z_][\w$]*'
        r"|\\\S+|\S", text, re.S) if not m[0].startswith(("//", "/*", "`define"))]

    def word(at):
        return tokens[at][0] if at < len(tokens) else ""

    def after_brackets(at):
        depth = 0
        while at < len(tokens):
            depth += (word(at) == "(") - (word(at) == ")")
            at += 1
            if depth <= 0:
                break
        return at

    def after_block(at, pairs):
        depth = 0
        while at < len(tokens):
            depth += (word(at) in pairs) - (word(at) in pairs.values())
            at += 1
            if depth == 0:
                break
        return at + 2 if word(at) == ":" else at

    def after_statement(at):
        while word(at) in ("for", "foreach", "while", "repeat", "forever", "@", "#"):
            at += 1
            at = after_brackets(at) if word(at) == "(" else at + (word(at - 1) in "@#")
        if word(at) == "if":
            at = after_statement(after_brackets(at + 1))
            return after_statement(at + 1) if word(at) == "else" else at
        if word(at) in ("begin", "fork"):
            return after_block(at, {"begin": "end", "fork": "join"})
        if word(at).startswith("case"):
            return after_block(at, {"case": "endcase", "casex": "endcase", "casez": "endcase"})
        while at < len(tokens) and word(at) != ";":
            at = after_brackets(at) if word(at) == "(" else at + 1
        return at + 1

    at, kept, end = 0, [], 0
    while at < len(tokens):
        if word(at) != "initial":
            at += 1
            continue
        first, at = tokens[at].start(), after_statement(at + 1)
        last = tokens[min(at, len(tokens)) - 1].end()
        words = re.findall(r"`(?:ifn?def|els\w+|endif)", text[first:last])
        if not words or words[0].startswith("`if") and words[-1] == "`endif":
            kept += [text[end:first], "\n" * text.count("\n", first, last)]
            end = last
    return "".join([*kept, text[end:]])


def copies_in(folder, files, change):
    """Returns the list of files, in which a changed copy in `folder` replaces each file that the
    function `change` alters. A file with a byte order mark is also replaced by a copy, without the
    mark."""
    copies = []
    for number, file in enumerate(files):
        text = text_of(file)
        if has_mark(file) or change(text) != text:
            copies.append(os.path.join(folder, f"{change.__name__}_{number}_"
                                               f"{os.path.basename(file)}"))
            Path(copies[-1]).write_text(change(text))
        else:
            copies.append(file)
    return copies


def read_module(top, files, headers=(), params=(), defines=(), is_whole=True, ghdl="ghdl",
                library="", libraries=()):
    """Returns the ports of the module `top` in order, and whether Yosys can read the module
    (otherwise only Verilator can). A port that resets registers asynchronously has the key "reset",
    its active level. `headers`: files in the folders that `include searches. `params`: NAME=value
    of parameters or generics. `defines`: NAME or NAME=value of macros. `is_whole`: the files
    contain all modules of the design. `ghdl`: the program that reads VHDL. `library`: the name of
    the files' VHDL library. `libraries`: other libraries, NAME=FILE for each of their files."""
    with tempfile.TemporaryDirectory() as work:
        out = os.path.join(work, top + ".v")
        if is_vhdl(files[0]):
            run_tool("GHDL", "convert", top,
                     [TREE / "cmake/vhdl_to_verilog.sh", "--foreign", "--library",
                      library or "work", *(word for each in libraries for word in ("--in", each)),
                      *(word for p in params for word in ("--generic", p)),
                      ghdl, work, top, out, *files])
            run_tool("Yosys", "read", top, [TREE / "cmake/no_latches.sh", work, top, out])
            files, params = [out], ()  # GHDL has already applied the generics
        elif any(end_of(f) == ".sv" for f in files):
            check_interfaces(top, files)
        lint = [*lint_of(top, [*files, *headers], defines), *("-G" + p for p in params), *files]
        modules = modules_by_yosys(top, files, headers, params, defines, is_whole, work)
        if modules is None:
            return ports_by_verilator(top, lint), False
    module = next(m for n, m in modules.items() if m["attributes"].get("top") or n == top)
    for cell in module["cells"].values():
        for port in module["ports"].values():
            if (cell["connections"].get("ARST") == port["bits"]
                    and "ARST_POLARITY" in cell["parameters"]):
                port["reset"] = cell["parameters"]["ARST_POLARITY"][-1]
    if any(re.search(r"\bstruct\b", text_of(f)) for f in files if end_of(f) == ".sv"):
        for name, port in (ports_by_verilator(top, lint, False) or {}).items():
            module["ports"][name].update({k: v for k, v in port.items() if k == "members"})
    return module["ports"], True


def modules_by_yosys(top, files, headers, params, defines, is_whole, work):
    """Returns the modules of a core as elaborated by Yosys. Returns None if Yosys rejects
    SystemVerilog, or takes longer than the limit. Verilator must then read the core."""
    folders = ["-I" + d for d in folders_of([*files, *headers])] + ["-D" + d for d in defines]
    check = "hierarchy -check" if is_whole else "hierarchy"
    elaborate = [f"{check} -top {top}"]
    # the parameters are set by an instance of TOP, because -chparam accepts neither texts nor
    # negative numbers
    if params:
        instance = os.path.join(work, "instance.v")
        Path(instance).write_text(f"module icesoc_top; {top}{overrides(params)} u (); endmodule")
        elaborate = [f"read_verilog -sv {instance}", f"{check} -top icesoc_top",
                     "delete icesoc_top", "hierarchy -auto-top"]
    result = os.path.join(work, "modules.json")

    def elaborates(sources, is_needed):
        reads = [f"read_verilog -defer {'-sv' if end_of(f) == '.sv' else ''} {' '.join(folders)} "
                 f"{f}" for f in sources]
        script = "; ".join([*reads, *elaborate, "proc", "flatten", "opt_expr",
                            f"write_json {result}"])
        return run_tool("Yosys", "elaborate", top, ["yosys", "-q", "-p", script], is_needed, LIMIT)

    is_system = any(end_of(f) == ".sv" for f in files)
    short, whole = (copies_in(work, files, change) for change in (without_initial, str))
    accepted = elaborates(short, short == whole and not is_system)
    # runs again on the complete files, so that Yosys's message is about them
    if accepted is False and short != whole:
        accepted = elaborates(whole, not is_system)
    if accepted is None:
        print(f"core foreign: Yosys has not elaborated {top} in {LIMIT} s, so Verilator reads its "
              "ports. Tests and flights work, but synthesis takes long or does not end. Build "
              "large memories without a reset and without loops over all their words",
              file=sys.stderr, flush=True)
    return json.loads(text_of(result))["modules"] if accepted else None


def copies_for_verilator(top, files, headers, defines):
    """Returns {file: text} for the files that Verilator does not accept unchanged. The text has
    macros and absolute paths of data (see filled). If Verilator rejects these texts, they are
    marked as Verilog 2005, so that keywords of SystemVerilog are allowed as names."""
    lint = lint_of(top, [*files, *headers], defines)
    copies = {f: t for f in files if (t := filled(f, defines)) != text_of(f) or has_mark(f)}
    if run_tool("Verilator", "read", top, [*lint, "--lint-only", *files], False):
        return copies
    with tempfile.TemporaryDirectory() as work:
        older, names = {}, {}
        for f in files:
            if end_of(f) == ".v" and declared([f], "module"):
                older[f] = (f'`ifdef VERILATOR\n`begin_keywords "1364-2005"\n`endif\n'
                            f"{filled(f, defines)}\n"
                            "`ifdef VERILATOR\n`end_keywords\n`endif\n")
                names[f] = os.path.join(work, os.path.basename(f))
                with open(names[f], "w") as out:
                    out.write(older[f])
        if run_tool("Verilator", "read", top,
                    [*lint, "--lint-only", *(names.get(f, f) for f in files)], False):
            return {**copies, **older}
    return run_tool("Verilator", "read", top, [*lint, "--lint-only", *files])  # fails
