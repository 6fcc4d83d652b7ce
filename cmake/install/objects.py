#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""objects: makes the installed list of the chip's objects, for icesoc-call.

    objects.py BUILD/gen/objects.json TREE OUT

Slice files get paths relative to TREE. Register descriptions are left out, since cores of the
default chip have their own interfaces.
"""
import json
import os
import sys

given, tree, out = sys.argv[1:]
with open(given) as file:
    cores = json.load(file)
for core in cores:
    del core["registers"]
    core["slice"] = [os.path.relpath(path, tree) for path in core["slice"]]
    outside = [path for path in core["slice"] if path.startswith("..")]
    if outside or "interface" in core:
        sys.exit(f"objects: {core['core']}: expected a core of the default chip, got one with "
                 + (f"Slice outside the tree, {outside[0]}" if outside else "registers only"))
with open(out, "w") as file:
    json.dump(cores, file, indent=1)
