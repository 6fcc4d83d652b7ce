#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""arrows: checks that every #include, and every import of the tools, is allowed by the dependencies
in rooms.toml. Also checks that each C file includes its own header, and that the files of a library
have no circular dependencies.

    arrows.py TREE                checks the includes in a checkout
    arrows.py --circles LIBRARY [PREFIX...]
                                  checks the object files of a static library for circular
                                  dependencies; files with names that share a PREFIX count
                                  as one file, because their recursion is intended

A room is a folder in rooms.toml; a file belongs to the innermost room that contains it. A file may
include headers of its room, and of the rooms that its room may use. A C file in sw/ must include
the header with its own name, or the header that the table `headers` of rooms.toml names for the
file or for its folder. The exit status is 1 if an include is not allowed, a C file does not include
its header, or a dependency is circular.
"""
import os
import re
import subprocess
import sys
import tomllib

ROOMS = "tests/tree/rooms.toml"


def tracked(tree):
    """Returns the paths of all C, C++ and Verilog files in the checkout that people have written,
    and of the Python files of the tools."""
    listing = "grep --no-index --exclude-standard --no-color -l".split()
    names = subprocess.check_output(["git", "-C", tree, *listing, ""], text=True).split("\n")
    return [n for n in names
            if re.search(r"\.(c|h|cpp|v|vh|in)$|^tools/icesoc/.*\.py$", n)
            and "/golden" not in n and "/errors/" not in n
            and os.path.isfile(os.path.join(tree, n))]


def room_of(path, rooms):
    """Returns the room of a file. Tests and vectors of a core belong to the room `tests`."""
    if re.search(r"_(test|vectors)\.(cpp|h)$", path):
        return "tests"
    while path:
        path = os.path.dirname(path)
        if path in rooms:
            return path
    return None


def wrong_imports(tree, path, room, rooms):
    """Yields a line for each import in a file of the tools that the file's room does not allow."""
    for number, line in enumerate(open(os.path.join(tree, path)), 1):
        found = re.match(r"\s*(?:from|import) icesoc([.\w]*)(?: import (\w+))?", line)
        if not found:
            continue
        module = "tools/icesoc" + found[1].replace(".", "/")
        if os.path.isdir(os.path.join(tree, module, found[2] or "")):
            module += f"/{found[2]}" if found[2] else ""
        used = module if module in rooms else room_of(module, rooms)
        if used != room and used not in rooms[room]:
            yield f"{path}:{number}: {room} may not use {used} ({found[0].strip()})"


def wrong_headers(tree, files, headers):
    """Yields a line for each C file in sw/ that does not include its header."""
    for path in sorted(set(headers) - set(files)):
        if not os.path.isdir(os.path.join(tree, path)):
            yield f"{ROOMS}: headers: no file or folder {path}"
    for path in files:
        if not re.match(r"sw/.*\.c$", path):
            continue
        own = path[:-2] + ".h"
        place = next((p for p in (path, os.path.dirname(path)) if p in headers), None)
        if place:
            wanted = headers[place] + [os.path.basename(own)] * (own in files)
        elif own in files:
            wanted = [os.path.basename(own)]
        else:
            yield f"{path}: has no header: add {own}, or its header to `headers` in {ROOMS}"
            continue
        text = open(os.path.join(tree, path)).read()
        if wanted and not any(f'#include "{name}"' in text for name in wanted):
            yield f"{path}: expected #include of {' or '.join(wanted)}"


def wrong_arrows(tree):
    with open(os.path.join(tree, ROOMS), "rb") as file:
        table = tomllib.load(file)
    headers = table.pop("headers")
    rooms = {room: set(used) for room, used in table.items()}
    files = tracked(tree)
    by_name = {}
    for path in files:
        by_name.setdefault(os.path.basename(path), []).append(path)
    wrong = [f"{ROOMS}: `{room}` is not a folder" for room in sorted(rooms)
             if not os.path.isdir(os.path.join(tree, room))]
    wrong += [f"{ROOMS}: `{used}`, which `{room}` may use, does not exist" for room in sorted(rooms)
              for used in sorted(rooms[room]) if used not in rooms]
    wrong += wrong_headers(tree, files, headers)
    for path in files:
        room = room_of(path, rooms)
        if not room:
            wrong.append(f"{path}: its folder is in no room of {ROOMS}")
            continue
        if path.endswith(".py"):
            wrong += wrong_imports(tree, path, room, rooms)
            continue
        for number, line in enumerate(open(os.path.join(tree, path), errors="replace"), 1):
            include = re.match(r'\s*[#`]include "([^"]+)"', line)
            if not include:
                continue
            name = include.group(1)
            places = [p for p in by_name.get(os.path.basename(name), [])
                      if ("/" + p).endswith("/" + name.replace("../", ""))]
            # A generated header has no place in the tree. If several files have the same name, the
            # include is accepted if one of them is allowed.
            targets = {room_of(p, rooms) for p in places}
            if targets and room not in targets and not targets & rooms[room]:
                used = " or ".join(sorted(map(str, targets)))
                wrong.append(f"{path}:{number}: {room} may not use {used} ({name})")
    return wrong


def circles(library, prefixes):
    """Returns the circular dependencies between the object files of a library, each as a sentence.
    Files with the same prefix count as one file."""
    defines, needs = {}, {}
    for line in subprocess.check_output(["nm", "-A", library], text=True).split("\n"):
        part = re.match(r".*?:([^:]+):\s*\S*\s+([A-Za-z]) (\S+)$", line)
        if not part:
            continue
        file, kind, symbol = part.groups()
        file = next((p for p in prefixes if file.startswith(p)), file)
        if kind == "U":
            needs.setdefault(file, set()).add(symbol)
        elif kind.isupper():
            defines[symbol] = file
    uses = {file: {defines[s]: s for s in names if defines.get(s, file) != file}
            for file, names in needs.items()}
    found, done = [], set()

    def visit(file, way):
        if file in way:
            circle = way[way.index(file):] + [file]
            found.append(", ".join(f"{a} needs {uses[a][b]} of {b}"
                                   for a, b in zip(circle, circle[1:])))
        elif file not in done:
            for used in sorted(uses.get(file, {})):
                visit(used, way + [file])
            done.add(file)

    for file in sorted(uses):
        visit(file, [])
    return found


def main(words):
    if len(words) >= 2 and words[0] == "--circles":
        wrong = circles(words[1], words[2:])
    elif len(words) == 1 and not words[0].startswith("-"):
        wrong = wrong_arrows(words[0])
    else:
        sys.exit(__doc__)
    print("\n".join(wrong))
    return 1 if wrong else 0


sys.exit(main(sys.argv[1:]))
