#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""constraints: finds paths and pads of the chip that have no constraint.

Usage: constraints.py SOURCE GENERATED WORK, three folders. chip.v is flattened, with MIG's core as
a cell. Every path from a pad or clock to a clock, a pad or an asynchronous reset needs a PERIOD, an
OFFSET, a FROM:TO, a MAXDELAY or a TIG. Every pad, except the pads of MIG, needs a standard and a
place. Then each statement is removed in turn, and is reported as superfluous if the rest still
covers all paths and pads. The exit status is 1 if anything is reported, or if merge_ucf.py renames
the constraints of MIG in another way than expected.
"""

import codecs
import json
import re
import subprocess
import sys
from fnmatch import fnmatchcase as matches
from functools import lru_cache
from pathlib import Path

SOURCE, GENERATED, WORK = map(Path, sys.argv[1:])
HERE, ISE = Path(__file__).resolve().parent, SOURCE / "synth/ise"
FILES = [ISE / "chip.ucf", GENERATED / "core_pins.ucf", GENERATED / "board.ucf"]
from icesoc.synth.merge_ucf import statements

fnmatchcase = lru_cache(None)(matches)

OF_MIG = "mcb3_"


def pad_name(port, index, width):
    return port if width == 1 else f"{port}<{index}>"


def netlist():
    """Returns the flattened chip from the JSON that Yosys writes."""
    WORK.mkdir(parents=True, exist_ok=True)
    folders = [GENERATED, SOURCE / "bus", SOURCE / "hdl"]
    folders += [f for room in ("hdl", "ip") for f in (SOURCE / room).iterdir() if f.is_dir()]
    libraries = "".join(f" -libdir {folder}" for folder in folders)
    includes = f"-I{GENERATED} -I{SOURCE}/bus -I{SOURCE}/hdl/ddr -I{SOURCE}/hdl/system"
    ran = subprocess.run(["yosys", "-q", "-p", f"""verilog_defaults -add {includes}
        read_verilog {ISE}/chip.v; read_verilog -lib {HERE}/mig.v; hierarchy -top chip {libraries}
        proc; flatten; tribuf; opt_clean; memory -nomap; opt_clean; write_json {WORK}/chip.json"""],
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if ran.returncode:
        sys.exit(ran.stdout)
    return json.loads((WORK / "chip.json").read_text())


def renamed():
    """Returns the lines in which merge_ucf.py reports renamed constraints of a board. The file of
    MIG begins with a byte order mark, and ends with a comment in Latin-1."""
    text = codecs.BOM_UTF8 + (HERE / "mig.ucf").read_bytes() + b"# C:/Users/Jos\xe9\n"
    WORK.mkdir(parents=True, exist_ok=True)
    (WORK / "mig.ucf").write_bytes(text)
    return subprocess.run(
        [sys.executable, "-m", "icesoc.synth.merge_ucf", WORK / "mig.ucf", *FILES], check=True,
        text=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE).stderr


class Paths:
    """The paths of the chip, as pairs (start, end) in `pairs`, and its pads without the pads of
    MIG in `pads`.

    A start or an end is ("pad", name) or ("clock", names of the net). A start may also be ("ram",
    names of its clock), and an end may be ("reset", the clock of the register that is reset)."""

    def __init__(self, module):
        self.names, self.pads = {}, []
        # the start that drives each net, or the nets (or starts) that its logic reads
        self.source, self.comb = {}, {}
        # sinks: pairs (end, net); origins: for each net, its starts as far as they are known
        self.sinks, self.origins = [], {}
        self.add_ports(module["ports"])
        for name, net in module["netnames"].items():
            if len(net["bits"]) == 1:
                self.names.setdefault(net["bits"][0], set()).add(name)
        for cell in module["cells"].values():
            self.add(cell["type"], cell["connections"], cell["port_directions"])
        self.find_origins()
        self.pairs = {(start, end) for end, bit in self.sinks for start in self.known(bit)}

    def clock(self, bit):
        return "clock", tuple(sorted(self.names.get(bit, ["?"]), key=len)[:4])

    def add_ports(self, ports):
        for name, port in ports.items():
            for index, bit in enumerate(port["bits"]):
                pad = pad_name(name, index, len(port["bits"]))
                self.names.setdefault(bit, set()).add(pad)
                if name.startswith(OF_MIG):
                    continue
                self.pads.append(pad)
                if port["direction"] == "output":
                    self.sinks.append((("pad", pad), bit))
                else:
                    self.source[bit] = ("pad", pad)

    def add(self, kind, nets, way):
        ins = [p for p in nets if way[p] == "input"]
        if kind == "mig":
            own = self.clock(nets["c3_clk0"][0])
            for port in nets:
                if port.startswith((OF_MIG, "c3_sys", "c3_clk")) or "_clk" in port:
                    continue
                for bit in nets[port]:
                    if port in ins:
                        self.sinks.append((own, bit))
                    else:
                        self.source[bit] = own
        elif kind.startswith("$mem"):
            own = self.clock((nets["WR_CLK"] or ["?"])[0])
            self.sinks += [(own, bit) for port in ("WR_ADDR", "WR_DATA", "WR_EN")
                           for bit in nets[port]]
            read = list(nets["RD_ADDR"]) + ([("ram", own[1])] if nets["WR_CLK"] else [])
            self.comb.update(dict.fromkeys(nets["RD_DATA"], read))
        elif kind == "$tribuf" or "CLK" not in nets:
            needs = [bit for p in ins for bit in nets[p]]
            for bit in [bit for p in nets if p not in ins for bit in nets[p]]:
                if self.source.get(bit, "?")[0] == "pad":  # the pad is bidirectional
                    self.sinks += [(self.source[bit], need) for need in needs]
                else:
                    self.comb[bit] = needs
        else:
            own = self.clock(nets["CLK"][0])
            for p in ins:
                end = ("reset", own) if p in ("ARST", "ALOAD", "SET", "CLR") else own
                self.sinks += [(end, bit) for bit in nets[p] if p != "CLK"]
            self.source.update(dict.fromkeys(nets["Q"], own))

    def known(self, bit):
        if isinstance(bit, tuple):
            return frozenset([bit])
        if bit in self.source:
            return frozenset([self.source[bit]])
        return self.origins.get(bit) if bit in self.comb else frozenset()

    def find_origins(self):
        visited = set()
        for _, first in self.sinks:
            stack = [first]
            while stack:
                bit = stack[-1]
                todo = []
                if self.known(bit) is None and bit not in visited:
                    todo = [b for b in self.comb[bit] if self.known(b) is None and b not in visited]
                    visited.add(bit)
                stack += todo
                if not todo:
                    stack.pop()
                    if self.known(bit) is None:
                        self.origins[bit] = frozenset().union(
                            *(self.known(b) or () for b in self.comb[bit]))


def names_in(text):
    return re.findall(r'"([^"]+)"', text)


class Constraints:
    def __init__(self, lines):
        self.groups, self.paths, self.tig, self.nets = {}, [], [], []
        self.offsets, self.periods = [], set()
        for line in lines:
            if found := re.match(r'NET "([^"]+)" TNM_NET = "([^"]+)"', line):
                self.groups[found[2]] = ("clock", [found[1]])
            elif found := re.match(r'NET "([^"]+)" TIG', line):
                self.tig.append(found[1])
            elif found := re.match(r'NET "([^"]+)" (.*)', line):
                self.nets.append((found[1], found[2]))
            elif found := re.match(r'TIMEGRP "([^"]+)" = PADS\((.*)\)', line):
                self.groups[found[1]] = ("pad", names_in(found[2]))
            elif found := re.match('TIMEGRP "([^"]+)" OFFSET = IN .* VALID .* BEFORE "([^"]+)"',
                                   line):
                self.offsets.append((found[1], found[2]))
            elif found := re.match(r'TIMESPEC "[^"]+" = PERIOD "([^"]+)"', line):
                self.periods.add(found[1])
            elif found := re.match(r'TIMESPEC "[^"]+" = FROM (\S+) TO (\S+) ', line):
                self.paths.append((found[1].strip('"'), found[2].strip('"')))

    def has(self, group, point):
        if group in ("FFS", "RAMS"):
            return point[0] == {"FFS": "clock", "RAMS": "ram"}[group]
        kind, patterns = self.groups.get(group, ("none", []))
        members = [point[1]] if point[0] == "pad" else point[1]
        return (kind == "pad") == (point[0] == "pad") and any(
            fnmatchcase(m, p) for m in members for p in patterns)

    def has_word(self, pad, word):
        return any(
            fnmatchcase(pad, net) and re.search(rf"\b{word}\b", what) for net, what in self.nets)

    def covers(self, start, end):
        if start[0] == "pad" and any(fnmatchcase(start[1], net) for net in self.tig):
            return True
        if end[0] == "reset":
            if start[0] == "pad":
                return self.has_word(re.sub(r"<(\d+)>", r"_\1", start[1]) + "_IBUF", "MAXDELAY")
            end = end[1]
        if start[0] != "pad" and start[1] == end[1]:
            return any(self.has(group, start) for group in self.periods)
        if start[0] == "pad" and end[0] == "clock":
            if any(self.has(group, start) and clock in end[1] for group, clock in self.offsets):
                return True
        return any(self.has(a, start) and self.has(b, end) for a, b in self.paths)

    def missing(self, pads, pairs):
        found = {f"{tell(start)} to {tell(end)}: no constraint" for start, end in pairs
                 if not self.covers(start, end)}
        if not any(self.groups[group][1] == ["sys_clk_i"] for group in self.periods
                   if group in self.groups):
            found.add("pad sys_clk_i: no PERIOD")
        for pad in pads:
            found |= {f"pad {pad}: no {word}" for word in ("IOSTANDARD", "LOC")
                      if not self.has_word(pad, word) and not (word == "LOC" and pad in unused)}
        return found


def tell(point):
    if point[0] == "reset":
        return f"asynchronous reset of {tell(point[1])}"
    return f"pad {point[1]}" if point[0] == "pad" else f"{point[0]} {point[1][0]}"


expected = re.findall("^#> (.*\n)", (HERE / "mig.ucf").read_text(), re.M)
if renamed() != "".join(expected):
    sys.exit(f"{renamed()}is renamed by merge_ucf.py, but differs from mig.ucf")
paths = Paths(netlist()["modules"]["chip"])
all_pads, all_pairs = paths.pads, paths.pairs
used = {point[1] for pair in all_pairs for point in pair if point[0] == "pad"}
used |= {name for pair in all_pairs for point in pair if point[0] == "clock" for name in point[1]}
unused = {pad for pad in all_pads if pad.startswith("core_pins") and pad not in used}
lines = [line for path in FILES for _, line in statements(path)]
bad = sorted(Constraints(lines).missing(all_pads, all_pairs))
if not bad:
    for index, line in enumerate(lines):
        if re.match(r"TIMESPEC|TIMEGRP|.*(MAXDELAY|TNM_NET|TIG|IOSTANDARD|LOC)\b", line):
            if not Constraints(lines[:index] + lines[index + 1:]).missing(all_pads, all_pairs):
                bad.append(f"without '{line}' nothing is missing")
print("\n".join(bad) if bad else f"{len(all_pairs)} kinds of paths, {len(all_pads)} pads")
sys.exit(1 if bad or not all_pairs else 0)
