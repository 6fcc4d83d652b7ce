# SPDX-License-Identifier: MIT
"""reserved: the names that a core must not have."""
import re

from icesoc import TREE

HDL = TREE / "slice/hw/keywords.inc"
# Reserved words of C, Slice and this project.
OTHERS = """double false float long object operation private public
  short template test throws value work"""
RESERVED = set(" ".join(re.findall('"(.*)"', HDL.read_text())).split() + OTHERS.split())

REFUSAL = "is a reserved word of Verilog, VHDL, C, Slice or this project"
