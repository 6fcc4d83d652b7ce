#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""doxygen_filter: turns the project's plain C comments into Doxygen comments.

Usage: doxygen_filter.py FILE. A comment on separate lines documents the following code; a comment
after code documents that code. The first comment documents the file.
"""
import re
import sys
from pathlib import Path


def convert(text, name):
    """Returns the text with Doxygen's comment marks."""
    # A type that a macro declares is documented as a struct.
    text = re.sub(r"^typedef [A-Z_]+\([^;]*\) (\w+);", r"typedef struct \1 \1;", text, flags=re.M)
    # A macro that wraps a function of the same name is not documented a second time.
    for macro in re.findall(r"^#define (\w+)\(", text, re.M):
        if re.search(rf"^\w[^#\n]*\b{macro}\(", text, re.M):
            text = re.sub(rf"(?:/\*(?:(?!\*/).)*\*/\n)?#define {macro}\("
                          r"(?:[^\n]*\\\n)*[^\n]*\n", "", text)
    text = re.sub(r"^/\* SPDX[^\n]*\n \*\n", f"/** @file {name}\n * ", text, count=1)
    lines = []
    for line in text.splitlines():
        stripped = line.lstrip()
        if re.match(r"/\* ---- .* ---- \*/", stripped):
            line = ""
        elif stripped.startswith("/* "):
            line = line.replace("/* ", "/** ", 1)
        elif re.search(r"[;,{]\s*/\* ", line) or (re.search(r"\S\s+/\* .*\*/$", line)
                                                  and not stripped.startswith("*")):
            line = line.replace("/* ", "/**< ", 1)
        lines.append(line)
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    path = Path(sys.argv[1])
    sys.stdout.write(convert(path.read_text(), path.name))
