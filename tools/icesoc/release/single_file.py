# SPDX-License-Identifier: MIT
"""single_file: joins the layered sources of a component to one C file and one header.

    tools/python -m icesoc.release.single_file FOLDER [COMPONENT...]

The C file contains all sources, one after the other. If two sources use the same file-local name,
it gets the name of the source as a prefix. Each source ends with #undef lines for its macros. The
header contains every header that programs include.
"""
import argparse
import re
import sys
from collections import Counter
from pathlib import Path

from icesoc import TREE
from icesoc.regs.generate import render
from icesoc.regs.model import Block
from icesoc.release import components, version
from icesoc.util.errors import Stop
from icesoc.util.files import write

TOKEN = re.compile(r'/\*.*?\*/|"(?:\\.|[^"\\])*"|\'(?:\\.|[^\'\\])*\'|[A-Za-z_]\w*|->|\s+|.', re.S)
INCLUDE = re.compile(r'^#include ([<"])([^">]+)[">].*\n', re.M)
# macros that select code for the minimal layers; no component contains this code
MINIMAL = ("ICEC_MINIMAL", "LINK_MINIMAL")


def plain(text):
    """Returns a text without comments and strings, for reading declarations."""
    return "".join(" " if token[:2] == "/*" else '""' if token[0] == '"' else token
                   for token in TOKEN.findall(text))


def outer(text):
    """Returns the declarations at file level. Function bodies become {}, and initialisers are
    removed."""
    parts, depth = [], 0
    text = re.sub(r"^#(.*\\\n)*.*\n", "", plain(text), flags=re.M)
    for token in re.findall(r"[{}]|[^{}]+", text):
        if token == "{":
            depth += 1
            if depth == 1:
                parts.append("{")
        elif token == "}":
            depth -= 1
            if depth == 0:
                parts.append("}")
        elif depth == 0 or re.search(r"\benum\b[^;{]*\{$", "".join(parts)[-60:]):
            parts.append(token)
    return "".join(parts)


def declared(statement):
    """Returns the names that a statement such as 'static U8 a = 15, b[2]' declares."""
    head = re.sub(r"\{[^}]*\}|\[[^\]]*\]", "", statement)
    if match := re.match(r"[^=(]*?(\w+)\s*\(", head):
        return [match[1]]
    names = [re.search(r"(\w+)\s*(=.*)?$", part.strip(), re.S) for part in head.split(",")]
    return [name[1] for name in names if name]


def local_names(text):
    """Returns the names that are local to a C file: static functions and data, types, enumerators
    and tags."""
    text, found = outer(text), set()
    for match in re.finditer(r"\bstatic\b([^;{]*?(?:=\s*\{[^}]*\}[^;{]*)?)[;{]", text):
        found.update(declared(match[1]))
    for match in re.finditer(r"\benum\b[^;{]*\{([^}]*)\}", text):
        found.update(re.findall(r"(\w+)\s*(?:=[^,]*)?(?:,|$)", match[1].strip()))
    found.update(re.findall(r"\btypedef\b[^;]*?(\w+)(?:\[\w+\])?\s*;", text))
    found.update(re.findall(r"\b(?:struct|enum|union)\s+(\w+)\s*\{", text))
    return found


def renamed(text, names, stem):
    """Returns the text with `stem_` in front of these names. Names of members of structures are not
    changed."""
    parts, before = [], ""
    for token in TOKEN.findall(text):
        parts.append(f"{stem}_{token}" if token in names and before not in (".", "->") else token)
        if not token.isspace() and token[:2] != "/*":
            before = token
    return "".join(parts)


def full(text):
    """Returns a text without the parts that only the minimal layers use."""
    # stack: [whether it tests a macro of MINIMAL, whether the following text is kept] for each open
    # #if
    lines, stack = [], []
    for line in text.splitlines(keepends=True):
        words = line.split()
        if words and words[0] in ("#if", "#ifdef", "#ifndef"):
            ours = len(words) > 1 and words[1] in MINIMAL and words[0] != "#if"
            stack.append([ours, words[0] == "#ifndef" if ours else True])
            if ours:
                continue
        elif words and words[0] in ("#else", "#endif") and stack and stack[-1][0]:
            if words[0] == "#else":
                stack[-1][1] = not stack[-1][1]
            else:
                stack.pop()
            continue
        elif words and words[0] == "#endif" and stack:
            if all(on for _, on in stack):
                lines.append(line)
            stack.pop()
            continue
        if all(on for _, on in stack):
            lines.append(line)
    return "".join(lines)


def uncovered(text):
    """Returns a file's text without its licence line and its guard."""
    text = re.sub(r"\A/\* SPDX[^\n]*\n \*\n \*", "/*", full(text))
    return re.sub(r"^#pragma once\n\n?", "", text, flags=re.M)


class Joiner:
    """Makes the two files of one component."""

    def __init__(self, component, known, tree=TREE):
        self.component, self.known, self.tree = component, known, Path(tree)
        # headers of the C library, in the order in which they are first included
        self.system = {"h": [], "c": []}
        # macros such as _POSIX_C_SOURCE, which select the declarations of the C library
        self.features = []
        self.done = set()
        self.foreign = set()  # headers of the components that this component needs
        for name in component.needs:
            self.foreign |= Joiner(known[name], known, tree).public()

    def public(self):
        """Returns the paths of the headers that programs include, and of the headers that these
        include."""
        if not self.done:
            for path in self.component.headers:
                self.header(path, "h")
        return self.done | self.foreign

    def find(self, name, user):
        """Returns the path of an included header, or its text if it is generated."""
        folders = [str(Path(user).parent), *self.component.folders, *components.SHARED]
        for other in self.component.needs:
            folders += self.known[other].folders
        for folder in folders:
            if (self.tree / folder / name).is_file():
                return f"{folder}/{name}"
        for path in self.component.registers:
            if name == Path(path).name.replace(".regs.json", "_regs.h"):
                return path
        raise Stop(f"{user}: includes {name}, which was not found in the folders of the component "
                   f"{self.component.name} ({components.LIST})")

    def header(self, path, kind):
        """Returns the text of a header, with the text of the headers that it includes. Returns an
        empty text if the output already contains the header."""
        if path in self.done or path in self.foreign:
            return ""
        self.done.add(path)
        if path.endswith(".json"):
            text = render("regs.h.j2", b=Block.read(self.tree / path))
        else:
            text = (self.tree / path).read_text(encoding="utf-8")
        body = self.joined(uncovered(text), path, kind).strip("\n")
        if Path(path).parent.as_posix() in components.SHARED:
            guard = "ICESOC_" + Path(path).name.upper().replace(".", "_")
            body = f"#ifndef {guard}\n#define {guard}\n{body}\n#endif"
        return f"\n/* ---- {Path(path).name} ---- */\n\n{body}\n"

    def joined(self, text, path, kind):
        """Returns a text in which each #include of a local header is replaced by the text of the
        header."""
        def replace(match):
            if match[1] == "<":
                if match[2] not in self.system["h"] + self.system["c"]:
                    self.system[kind].append(match[2])
                return ""
            return self.header(self.find(match[2], path), kind)

        return INCLUDE.sub(replace, text)

    def sources(self):
        """Returns the text of the C files, one after the other."""
        files = self.component.files(self.tree)
        texts = {path: (self.tree / path).read_text(encoding="utf-8") for path in files}
        locals_ = {path: local_names(text) for path, text in texts.items()}
        uses = Counter(name for names in locals_.values() for name in names)
        parts = []
        for path, text in texts.items():
            text = uncovered(text)
            for feature in re.findall(r"^#define (_\w+_SOURCE .*)\n", text, re.M):
                if feature not in self.features:
                    self.features.append(feature)
            text = re.sub(r"^#define _\w+_SOURCE .*\n", "", text, flags=re.M)
            heads = "".join(self.header(self.find(match[2], path), "c")
                            for match in INCLUDE.finditer(text) if match[1] == '"')
            text = self.joined(text, path, "c")
            text = renamed(text, {n for n in locals_[path] if uses[n] > 1}, Path(path).stem)
            macros = re.findall(r"^#define (\w+)", text, re.M)
            ends = "".join(f"#undef {name}\n" for name in dict.fromkeys(macros))
            parts.append(f"{heads}\n/* ---- {Path(path).name} ---- */\n\n{text.strip(chr(10))}\n"
                         + (f"\n{ends}" if ends else ""))
        return "".join(parts)

    def files(self, number):
        """Returns all files of the component: name -> text."""
        name, its = self.component.name, self.component
        holder = re.search(r"^Copyright \(c\) (.*)$", (self.tree / "LICENSE").read_text(), re.M)[1]
        head = (f"/* SPDX-License-Identifier: MIT\n * Copyright (c) {holder}; licence: LICENSE.\n"
                f" *\n * {name} {number}\n * {its.title}.\n"
                " * Generated from IceSoC's layered sources: do not edit.\n */\n")
        body = "".join(self.header(path, "h") for path in its.headers)
        needs = "".join(f'#include "{other}.h"\n' for other in its.needs)
        system = "".join(f"#include <{header}>\n" for header in sorted(self.system["h"]))
        guard = f"{name.upper()}_H"
        header = (f"{head}#ifndef {guard}\n#define {guard}\n\n"
                  f"#define {name.upper()}_VERSION \"{number}\"\n\n{needs}{system}"
                  + ("\n" if needs or system else "")
                  + '#ifdef __cplusplus\nextern "C" {\n#endif\n' + body
                  + "\n#ifdef __cplusplus\n}\n#endif\n\n#endif\n")
        text = self.sources()
        features = "".join(f"#define {feature}\n" for feature in self.features)
        system = "".join(f"#include <{other}>\n" for other in sorted(self.system["c"]))
        system = f"\n{system}" if system else ""
        source = f'{head}{features}#include "{name}.h"\n{system}{text}'
        files = {f"{name}.h": header, f"{name}.c": source}
        for other in its.forwards:
            files[other] = ("/* SPDX-License-Identifier: MIT\n *\n"
                            f" * {other}: forwards to {name}.h, for code that slice2c generates.\n"
                            f" */\n#include \"{name}.h\"\n")
        return files


def files(names=None, tree=TREE, number=None):
    """Returns the files of these components, or of all: name to text. `number` is their version."""
    known, made = components.COMPONENTS, {}
    for name in names or known:
        if name not in known:
            raise Stop(f"components: '{name}' does not exist; {components.LIST} lists "
                       + ", ".join(known))
        made |= Joiner(known[name], known, tree).files(number or version.newest())
    return made


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("component", nargs="*")
    args = parser.parse_args()
    args.folder.mkdir(parents=True, exist_ok=True)
    try:
        for name, text in files(args.component).items():
            write(args.folder / name, text)
    except Stop as stop:
        sys.exit(f"single_file: {stop}")


if __name__ == "__main__":
    main()
