#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""objects: writes the installed list of the chip's objects, for icesoc-call.

    objects.py BUILD/gen/chip.json TREE OUT

Slice files get their installed paths, relative to share/icesoc: ip/CORE for the cores' files, slice
for the vehicle's. Register descriptions are left out, because the cores of the default chip are
called through Slice interfaces.
"""
import os
import sys

from icesoc.util import chip

given, tree, out = sys.argv[1:]
cores = chip.read(given).objects
for core in cores:
    core.registers = ""
    if core.interface:
        sys.exit(f"objects: {core.core}: expected a core with its own interface")
    paths = [os.path.relpath(path, tree) for path in core.slice]
    core.slice = [path if path.startswith("ip/") else f"slice/{os.path.basename(path)}"
                  for path in paths]
with open(out, "w") as file:
    file.write(chip.Chip(objects=cores).text())
