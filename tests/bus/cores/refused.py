#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""refused: checks that coremap rejects wrong lists of cores, each with a message, and writes no
file.

Usage: refused.py CASES FOLDER [option of coremap]...
CASES contains pairs of texts, each ended by NUL: a regular expression for the message, and the
list. All cases run in one process, because starting coremap takes longer than a case.
"""
import re
import sys
from pathlib import Path

from icesoc.chip import coremap


def message_of(words):
    """Runs coremap. Returns the message with which it ends, or "" if it accepts the list."""
    sys.argv = ["coremap", *words]
    try:
        coremap.main()
    except SystemExit as end:
        return str(end.code)
    return ""


def main():
    cases, folder, *options = sys.argv[1:]
    path = Path(folder) / "cores.list"
    texts = Path(cases).read_bytes().split(b"\0")[:-1]
    wrong = []
    for pattern, listed in zip(texts[::2], texts[1::2]):
        path.write_bytes(listed)
        message = message_of([str(path), *options, "--output-dir", folder])
        if not re.search(pattern.decode(), message):
            wrong.append(f"{listed!r}: expected '{pattern.decode()}', got '{message}'")
        if (Path(folder) / "soc_cores.vh").exists():
            sys.exit(f"{listed!r}: files were written although the list was rejected: {message}")
    print(f"{len(texts) // 2} lists rejected")
    sys.exit("\n".join(wrong) if wrong or not texts else 0)


if __name__ == "__main__":
    main()
