# SPDX-License-Identifier: MIT
"""hdl: reads the interface of a Verilog module or a VHDL entity, with its comments, from its file.

A file begins with the SPDX line and a comment `name: purpose`. A comment above ports is the title
of a group; a comment after a port or parameter is its meaning.
"""
import dataclasses
import re
from pathlib import Path

from icesoc.util.rooms import PLATFORM

PARAMETER = re.compile(r"parameter\s+(?:signed\s+|integer\s+)?(\[[^]]*\]\s*)?(\w+)\s*=\s*([^,/]+?)"
                       r"\s*,?\s*(?://\s*(.*))?$")
PORT = re.compile(r"(input|output|inout)\s+(?:wire|reg)?\s*(signed\s+)?"
                  r"(\[[^]]*\](?:\[[^]]*\])?)?\s*"
                  r"(\w+)\s*,?\s*(?://\s*(.*))?$")
INCLUDE = re.compile(r'`include\s+"([^"]+)"')
GENERIC = re.compile(r"(\w+)\s*:\s*(\w+)(?:\s+range\s+[^:;]+)?\s*(?::=\s*([^;]+?))?\s*;?\s*"
                     r"(?:--\s*(.*))?$")
VHDL_PORT = re.compile(r"(\w+)\s*:\s*(in|out|inout)\s+([\w() +*/-]+?)\s*(?::=[^;]+)?;?\s*"
                       r"(?:--\s*(.*))?$")


@dataclasses.dataclass
class Parameter:
    """A parameter or generic."""
    name: str
    default: str
    meaning: str


@dataclasses.dataclass
class Port:
    """A port. `clock` is the name of its clock, or "asynchronous"."""
    name: str
    direction: str  # input, output or inout
    width: str  # as written, such as [31:0]; empty for one bit
    meaning: str
    group: str
    clock: str = ""


@dataclasses.dataclass
class Entity:
    """A module or entity, as its file describes it."""
    name: str
    path: Path
    summary: str
    text: str  # remaining text of the first comment
    parameters: list
    ports: list


def first_comment(lines, mark):
    """Returns the first comment of a file without its marks and the SPDX line."""
    text = []
    for line in lines:
        if not line.startswith(mark):
            if text or not line.isspace():
                break
            continue
        content = line[len(mark):].rstrip("\n")
        if "SPDX-License-Identifier" not in content:
            text.append(content[1:] if content.startswith(" ") else content)
    return "\n".join(text).strip("\n")


def section(text, begin):
    """Returns the text between the parenthesis at `begin` and the matching one, and the index of
    the end. Parentheses in comments do not count."""
    depth, at = 0, begin
    while at < len(text):
        if text.startswith(("//", "--"), at):
            at = text.index("\n", at)
        elif text[at] == "(":
            depth += 1
        elif text[at] == ")":
            depth -= 1
            if depth == 0:
                return text[begin + 1:at], at + 1
        at += 1
    raise ValueError("expected ')' at the end of a port list, got the end of the file")


def included(name, root):
    """Returns the text of an include file of the platform."""
    for folder in PLATFORM:
        for path in sorted((root / folder).rglob(name)):
            return path.read_text()
    return ""


def expand(text, root):
    """Replaces each `include line of a port list by the lines of the included file, without the
    comment at its head."""
    lines = []
    for line in text.splitlines():
        match = INCLUDE.search(line)
        if match:
            body = included(match[1], root)
            lines += body.partition("\n\n")[2].splitlines()
        else:
            lines.append(line)
    return lines


def declarations(lines, mark, pattern):
    """Yields (group, match) for each line that contains a declaration. A line with only a comment
    begins a new group and is its title."""
    group = ""
    for line in lines:
        stripped = line.strip()
        if stripped.startswith(mark):
            group = stripped[len(mark):].strip()
            continue
        match = pattern.search(stripped)
        if match:
            yield group, match


def name_clocks(ports):
    """Sets the clock of each port: the module's only clock or, if it has several, the clock in the
    port's group."""
    clocks = [p for p in ports if p.direction == "input" and re.search(r"(^|_)clk_i$", p.name)]
    of_group = {p.group: p.name for p in clocks}
    for port in ports:
        if port in clocks:
            port.clock = "clock"
        elif re.search(r"\bpins?\b|asynchronous", port.group) or "_async" in port.name:
            port.clock = "asynchronous"
        elif len(clocks) == 1:
            port.clock = clocks[0].name
        else:
            port.clock = of_group.get(port.group, "asynchronous" if clocks else "")


def read_verilog(path, root):
    """Returns the module in a Verilog file, or None if the file declares none."""
    text = path.read_text()
    match = re.search(r"^module\s+(\w+)\s*", text, re.M)
    if not match:
        return None
    at, parameters = match.end(), []
    if text.startswith("#", at):
        body, at = section(text, text.index("(", at))
        parameters = [Parameter(m[2], m[3].strip(), m[4] or "") for _, m in
                      declarations(body.splitlines(), "//", PARAMETER)]
    body, _ = section(text, text.index("(", at))
    ports = [Port(m[4], m[1], m[3] or "", m[5] or "", group)
             for group, m in declarations(expand(body, root), "//", PORT)]
    return finished(match[1], path, text, "//", parameters, ports)


def read_vhdl(path):
    """Returns the entity in a VHDL file, or None if the file declares none."""
    text = path.read_text()
    match = re.search(r"^entity\s+(\w+)\s+is", text, re.M | re.I)
    if not match:
        return None
    end = re.search(r"^end\b", text[match.end():], re.M | re.I)
    body = text[match.end():match.end() + end.start()] if end else ""
    parameters, ports = [], []
    generic = re.search(r"\bgeneric\s*\(", body, re.I)
    if generic:
        inner, _ = section(body, generic.end() - 1)
        parameters = [Parameter(m[1], (m[3] or "").strip(), m[4] or "") for _, m in
                      declarations(inner.splitlines(), "--", GENERIC)]
    port = re.search(r"\bport\s*\(", body, re.I)
    if port:
        inner, _ = section(body, port.end() - 1)
        words = {"in": "input", "out": "output", "inout": "inout"}
        ports = [Port(m[1], words[m[2]], m[3].strip() if "(" in m[3] else "", m[4] or "", group)
                 for group, m in declarations(inner.splitlines(), "--", VHDL_PORT)]
    return finished(match[1], path, text, "--", parameters, ports)


def finished(name, path, text, mark, parameters, ports):
    """Returns the entity, completed with its summary and the clocks of its ports."""
    comment = first_comment(text.splitlines(keepends=True), mark)
    summary, _, rest = comment.partition("\n\n")
    summary = re.sub(rf"^{name}:\s*", "", " ".join(summary.split()))
    name_clocks(ports)
    return Entity(name, path, summary, rest, parameters, ports)


def read(path, root):
    """Returns the module or entity in a file, or None. `root` is the tree, in which include files
    are found."""
    return read_vhdl(path) if path.suffix == ".vhd" else read_verilog(path, root)
