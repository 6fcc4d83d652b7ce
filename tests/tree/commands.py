#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""commands: each command that README.md, docs/ or `make help` names has its line in tests/plan.toml, with the tests that run it.

    commands.py TREE

A command is a target of the Makefile with one of its variables: `make run LOSS=0.1`. A line of the plan's chapter `commands`
begins with `make target VARIABLE= ...`; one of the list below that chapter says why no test runs it. Exit status 1 where a
command has no line, a line no command, or a page names a target that there is not.
"""
import glob
import os
import re
import sys

VARIABLE = r"[A-Z][A-Z0-9_]*="
VALUE = rf"""{VARIABLE}(?:'[^']*'|"[^"]*"|[^\s`'"]*)"""


def pairs(target, text):
    """The target alone, and with each variable of the text."""
    return {(target, "")} | {(target, v) for v in re.findall(rf"(?<![\w$]){VARIABLE}", text)}


def main(words):
    if len(words) != 1:
        sys.exit(__doc__)
    os.chdir(words[0])
    named, wrong, targets = {}, [], set()
    for file in ["Makefile"] + sorted(glob.glob("*/targets.mk")):
        for target, text in re.findall(r"^([a-z-]+):.*?## (.*)$", open(file).read(), re.M):
            targets.add(target)
            named.update((each, "make help") for each in pairs(target, text))
        for line in re.findall(r"^\t@echo \"(?:Variables:)?(.*)\"$", open(file).read(), re.M):
            for text, target in re.findall(r"([^;]*?)\(make ([a-z-]+)\)", line):
                named.update((each, "make help") for each in pairs(target, text))
    for page in ["README.md", "CONTRIBUTING.md"] + sorted(glob.glob("docs/*.md")):
        quoted = "\n\n".join(re.findall(r"```.*?```|``.*?``|`[^`]+`", open(page).read(), re.S))
        for before, target, after in re.findall(rf"\bmake ((?:{VALUE} )*)([a-z][a-z-]*)((?:[ \n]+\[?{VALUE})*)", quoted):
            if target not in targets:
                wrong.append(f"{page}: there is no `make {target}`")
            named.update((each, page) for each in pairs(target, before + after) if target in targets)
    chapter = re.search(r"^\[commands\].*", open("tests/plan.toml").read(), re.M | re.S)
    lines = set()
    for target, text in re.findall(r"`make ([a-z-]+)([^`]*)`", chapter[0] if chapter else ""):
        lines |= pairs(target, text)
    wrong += [f"tests/plan.toml: no test runs `make {' '.join(each)}` of {named[each]}" for each in sorted(set(named) - lines)]
    wrong += [f"tests/plan.toml: `make {' '.join(each)}` is on no page" for each in sorted(lines - set(named)) if each[1]]
    print("\n".join(wrong) or f"{len(named)} commands")
    return 1 if wrong else 0


sys.exit(main(sys.argv[1:]))
