# SPDX-License-Identifier: MIT
"""ghdl: finds the line of VHDL from which GHDL has generated a given line of Verilog.

GHDL writes the location in the VHDL as a comment before the statements to which it belongs."""
import os
import re


def is_converted(lines):
    return bool(lines) and "by GHDL" in lines[0]


def place_in(line):
    """Returns file:line if a line is such a comment, otherwise None."""
    found = re.fullmatch(r" */\* (\S+\.vhdl?:\d+):\d+ +\*/", line)
    return found[1] if found else None


def place_of_signal(lines, declared, name):
    """Returns the VHDL location of the signal that is declared at a line; lines are counted from 1.
    The location is in the comment before the statement that assigns the signal. For a port, it is
    the location of the signal that drives the port. Returns an empty text if no location is
    found."""
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
    """Returns the VHDL location of a Verilog line; lines are counted from 1. For a declaration, it
    is the location of the signal; for any other line, of the statement. Returns an empty text if no
    location is found."""
    declared = re.match(r" *(?:wire|reg) (?:\[.*?\] )?(\w+);", lines[number - 1])
    if declared and (place := place_of_signal(lines, number, declared[1])):
        return place
    return next(filter(None, map(place_in, lines[number - 1::-1])), "")


def relative(file):
    return os.path.relpath(file) if os.path.isabs(file) else os.path.normpath(file)
