#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""outside: checks that the program in docs/icec.md, "A program outside this tree", can be built and
prints the output that the page shows.

usage: outside.py PROJECT SLICE2C WORK"""
import os
import pathlib
import re
import shutil
import subprocess
import sys

project, slice2c, work = sys.argv[1:]
page = pathlib.Path(project, "docs/icec.md").read_text(encoding="utf-8")
section = page.split("## A program outside this tree\n")[1].split("\n## ")[0]
blocks = re.findall(r"```(\w*)\n(.*?)```", section, re.S)
shutil.rmtree(work, ignore_errors=True)
os.makedirs(work)
for language, text in blocks:
    if language == "c":
        name = re.match(r"/\* (\S+) \*/\n", text)[1]
        pathlib.Path(work, name).write_text(text, encoding="utf-8")
commands = [text for language, text in blocks if language == "sh"][0]
expected = [text for language, text in blocks if not language][0]
# The page uses the compiler of a clone, but this build may be in another folder.
commands = commands.replace("$ICESOC/build/main/slice/slice2c", f"'{slice2c}'")
ran = subprocess.run(["sh", "-ec", commands], cwd=work, capture_output=True, text=True,
                     env=dict(os.environ, ICESOC=project))
print(ran.stderr, end="")
if ran.returncode or ran.stdout != expected:
    sys.exit(f"expected\n{expected}got (status {ran.returncode})\n{ran.stdout}")
