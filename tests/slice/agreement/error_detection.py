#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""error_detection: compares slice2c with slice2cpp on ZeroC's own wrong Slice files, line by line.

error_detection.py SLICE2C FOLDER (of cmake/fetch.py zeroc). Each line of which slice2cpp says
something must be one of which slice2c does, or have one of the REASONS.
"""
import collections
import pathlib
import re
import subprocess
import sys
import tempfile

NEXT = "slice2c names the line of the name, slice2cpp that of the bracket behind it"
REASONS = {  # regular expression of "FILE:LINE: message": why slice2c does not say it
    "only at module scope|IdentAsKeyword.*(syntax error|capitalization from (dict|enum))":
        "after a syntax error slice2cpp has lost the module; slice2c goes on in it",
    "metadata `cpp:": "metadata of C++ alone",
    "StructMembers.ice:10:": NEXT,
    "Undefined.ice:9:": "a name that is no type is told once, not at each use",
    "ConstDef.ice:132:": "a value that was refused above is refused once",
    "NotType.ice:28:": "a struct whose member was refused is not called empty, too",
    "IllegalIdentifier.ice:23:": "the line of the wrong character is named, not the one behind it"}
SAID = re.compile(r"[^:\n]*?([^/:\n]+\.ice):(\d+):(.*)")


def said(compiler, file, work):
    """{line: the messages of it} of one compiler."""
    words = [compiler, "--output-dir", work, file.name]
    words += ["--underscore"] * ("Underscore" in file.name)
    run = subprocess.run(words, cwd=file.parent, capture_output=True, text=True)
    lines = collections.defaultdict(list)
    for line in (run.stderr + run.stdout).splitlines():
        if match := SAID.match(line):
            lines[int(match[2])].append(f"{match[1]}:{match[2]}:{match[3]}")
    return lines


def main():
    compiler, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    counts, wrong = collections.Counter(), []
    files = sorted(folder.glob("*.ice"))
    with tempfile.TemporaryDirectory() as work:
        for file in files:
            ours, theirs = said(compiler, file, work), said("slice2cpp", file, work)
            for line, messages in theirs.items():
                if line in ours:
                    counts["the same line"] += 1
                elif line - 1 in ours and line - 1 not in theirs:
                    counts[NEXT] += 1
                else:
                    whys = {why for text, why in REASONS.items()
                            if any(re.search(text, message) for message in messages)}
                    counts.update(list(whys)[:1])
                    wrong += messages if not whys else []
    for why, count in counts.most_common():
        print(f"{count:5} {why}")
    print(f"{len(files)} files, {sum(counts.values())} lines, {len(wrong)} messages without a reason")
    sys.exit("\n".join(wrong) if wrong or counts["the same line"] < 400 else 0)


main()
