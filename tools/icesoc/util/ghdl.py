# SPDX-License-Identifier: MIT
"""ghdl: finds the place in VHDL of a line of the Verilog that GHDL made of it.

GHDL writes the place into a comment before the statements that it belongs to."""
import os
import re


def is_converted(lines):
    return bool(lines) and "by GHDL" in lines[0]


def place_in(line):
    """Returns file:line of a line that is such a comment, or None."""
    found = re.fullmatch(r" */\* (\S+\.vhdl?:\d+):\d+ +\*/", line)
    return found[1] if found else None


def place_of_signal(lines, declared, name):
    """Returns the place of a signal that is declared at a line, counted from 1. The place is in the
    comment before the statement that assigns the signal; for a port it is the comment of the
    signal that drives the port. Returns an empty text if there is none."""
    above = ""
    for line in lines[declared:]:
        if line == "endmodule":
            break
        if place := place_in(line):
            above = relative(place)
        elif f" {name} = " in line or f" {name} <= " in line:
            copied = re.match(r" *assign \S+ = (\w+); // *\((module output|signal)\)", line)
            if not above and copied and copied[1] != name:
                return place_of_signal(lines, declared, copied[1])
            return above
        elif " always @" not in line and " case (" not in line:
            above = ""
    return ""


def place_of_line(lines, number):
    """Returns the place of a line, counted from 1: of the signal that it declares, or of its
    statement. Empty: not found."""
    declared = re.match(r" *(?:wire|reg) (?:\[.*?\] )?(\w+);", lines[number - 1])
    if declared and (place := place_of_signal(lines, number, declared[1])):
        return place
    return next(filter(None, map(place_in, lines[number - 1::-1])), "")


def relative(file):
    return os.path.relpath(file) if os.path.isabs(file) else os.path.normpath(file)
