#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""manual: writes a program's manual page from the output of its --help.

    manual.py PAGE.1.gz --name NAME --purpose TEXT --version VERSION -- COMMAND --help

A line that begins with two spaces and a dash describes an option. The text of the option follows
after two more spaces, or in the next lines, which are indented further.
"""
import argparse
import gzip
import os
import re
import subprocess
import sys


def roff(text):
    """Escapes a text for the text formatter roff."""
    text = text.replace("\\", "\\e").replace("-", "\\-").replace("'", "\\(aq")
    return "\\&" + text if text.startswith(".") else text


def options(lines):
    """Returns the parts of a help text in order. A string is a paragraph, a list [option, text] an
    option, and a tuple the lines of the examples."""
    parts = []
    for line in lines:
        if parts and isinstance(parts[-1], tuple):  # examples are the last part of a help text
            parts[-1] += (line.strip(), )
            continue
        if line == "examples:":
            parts.append(())
            continue
        option = re.match(r" {1,4}(-.*?)(?: {2,}(\S.*))?$", line)
        deeper = re.match(r" {5,}(\S.*)$", line)
        if option:
            parts.append([option[1], option[2] or ""])
        elif deeper and parts and isinstance(parts[-1], list):
            parts[-1][1] = (parts[-1][1] + " " + deeper[1]).strip()
        elif line.strip() and parts and isinstance(parts[-1], str) and parts[-1]:
            parts[-1] += " " + line.strip()
        else:
            parts.append(line.strip())
    return [part for part in parts if part]


def page(name, section, purpose, version, text, program):
    """Returns the manual page of a program. `name`: installed name of the program. `text`: output
    of the program's --help. `program`: name of the program in this output, which the page replaces
    by `name`."""
    text = re.sub(rf"\S*\b{re.escape(program)}\b", name, text)
    usage = re.search(r"^usage: *(.*(?:\n +\S.*)*)\n", text, re.M | re.I)
    rest = text.replace(usage[0], "", 1) if usage else text
    synopsis = " ".join(usage[1].split()) if usage else name + " [OPTIONS]"
    lines = [f'.TH {name.upper()} {section} "" "IceSoC {version}" IceSoC', ".SH NAME",
             f"{roff(name)} \\- {roff(purpose)}", ".SH SYNOPSIS", roff(synopsis),
             ".SH DESCRIPTION"]
    for part in options(rest.splitlines()):
        if isinstance(part, list):
            if ".SH OPTIONS" not in lines and ".SH POSITIONALS" not in lines:
                lines.append(".SH OPTIONS")
            lines += [".TP", f".B {roff(part[0])}", roff(part[1])]
        elif isinstance(part, tuple):
            lines += [".SH EXAMPLES", ".nf", *map(roff, filter(None, part)), ".fi"]
        elif re.fullmatch(r"[Oo]ptions:|positionals:|positional arguments:", part, re.I):
            lines.append(f".SH {part.rstrip(':').upper()}")
        else:
            lines += [".PP", roff(part)]
    lines += [".SH SEE ALSO", "The documentation of IceSoC, in /usr/share/doc of its packages."]
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    for option in ("--name", "--purpose", "--version"):
        parser.add_argument(option, required=True)
    parser.add_argument("page")
    parser.add_argument("command", nargs="+")
    args = parser.parse_args()
    said = subprocess.run(args.command, capture_output=True, text=True,
                          env={**os.environ, "COLUMNS": "100", "LC_ALL": "C.UTF-8"})
    if said.returncode or not said.stdout.strip():
        sys.exit(f"manual: {' '.join(args.command)}: expected a help text, got exit status "
                 f"{said.returncode} and: {said.stderr.strip()}")
    program = os.path.basename(args.command[-2])
    section = args.page.split(".")[-2]
    os.makedirs(os.path.dirname(args.page), exist_ok=True)
    text = page(args.name, section, args.purpose, args.version, said.stdout, program)
    with gzip.GzipFile(args.page, "wb", 9, mtime=0) as file:
        file.write(text.encode())


if __name__ == "__main__":
    main()
