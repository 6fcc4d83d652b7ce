# SPDX-License-Identifier: MIT
"""merge_ucf: merges MIG's constraints with other constraints into one file for ngdbuild.

Usage: merge_ucf.py MIG.ucf OTHER.ucf... > all.ucf
MIG writes names as if its core were the top module. Here the core is the instance u_mig of chip.v,
so names inside the core get this prefix. c3_sys_clk and c3_sys_rst_i become the pads sys_clk_i and
sys_rst_i. The index of a bit is written as <n>, as in XST. VCCAUX, locations and I/O standards of
OTHER replace MIG's. Each change is printed on stderr. Exit status 1: a statement is not understood,
or two statements of OTHER contradict each other."""

import os
import re
import sys

from icesoc.util.errors import reason_of

PADS = {"c3_sys_clk": "sys_clk_i", "c3_sys_rst_i": "sys_rst_i"}


def statements(path):
    """Yields (line number, text without comments) of each statement."""
    with open(path, encoding="utf-8-sig", errors="replace") as file:
        text = re.sub(r"#[^\n]*", "", file.read())
    line = 1
    for part in text.split(";"):
        if part.strip():
            start = line + part[:len(part) - len(part.lstrip())].count("\n")
            yield start, " ".join(part.split())
        line += part.count("\n")


def keys(statement):
    """Returns a key for each setting in a statement that may occur only once: VCCAUX, and the
    location and I/O standard of a net."""
    if re.match(r"(?i)CONFIG\s+VCCAUX", statement):
        return ["VCCAUX"]
    net = re.match(r'(?i)NET\s+"?([^"\s]+)"?\s+(.*)', statement)
    if not net:
        return []
    kinds = [part.split("=")[0].strip().upper() for part in net[2].split("|")]
    return [f"{kind} of {net[1]}" for kind in kinds if kind in ("LOC", "IOSTANDARD")]


def renamed(statement, where):
    head = re.match(r'(?i)(NET|INST|PIN)\s+"?([^"\s]+)"?\s+(.*)', statement)
    if not head:
        if not re.match(r"(?i)(CONFIG|TIMESPEC|TIMEGRP|OFFSET)\b", statement):
            sys.exit(f"{where}: '{statement}' is not understood; write it into the board's file "
                     "by hand, and remove it here")
        return statement
    kind, name, rest = head.groups()
    new = PADS.get(name)
    if new is None:
        new = re.sub(r"\[([^]]*)\]", r"<\1>", name)
        if not new.startswith("mcb"):
            new = "u_mig/" + new
    if new != name:
        print(f"{where}: {name} is {new}", file=sys.stderr)
    return f'{kind} "{new}" {rest}'


def main():
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        sys.exit(__doc__)
    mig, others = sys.argv[1], sys.argv[2:]
    said, result = {}, []
    for path in others:
        result.append(f"# {path}")
        for line, statement in statements(path):
            for key in keys(statement):
                if said.setdefault(key, statement) != statement:
                    sys.exit(f"{path}:{line}: duplicate {key}: '{said[key]}', '{statement}'")
            result.append(statement + ";")
    result.append(f"# {mig}")
    for line, statement in statements(mig):
        new = renamed(statement, f"{os.path.basename(mig)}:{line}")
        twice = [key for key in keys(new) if key in said]
        if twice:
            print(f"{os.path.basename(mig)}:{line}: '{new}' is left out: {said[twice[0]]}",
                  file=sys.stderr)
        else:
            result.append(new + ";")
    print("\n".join(result))


if __name__ == "__main__":
    try:
        main()
    except OSError as error:
        sys.exit("merge_ucf: " + reason_of(error))
