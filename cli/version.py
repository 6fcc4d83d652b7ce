# SPDX-License-Identifier: MIT
"""version: the versions of the project, from CHANGELOG.md, of the protocols on the air, and of the
chip's blocks."""
import json
import re
from pathlib import Path

TREE = Path(__file__).resolve().parents[1]


def text():
    newest = re.search(r"^## (\d+\.\d+\.\d+)", (TREE / "CHANGELOG.md").read_text(), re.M)[1]
    link = re.search(r"LINK_VERSION (\d+)", (TREE / "sw/link/link_wire.h").read_text())[1]
    blocks = []
    for path in sorted([*(TREE / "hdl").rglob("*.regs.json"), *(TREE / "ip").rglob("*.regs.json")]):
        block = json.loads(path.read_text())
        if "version" in block:
            number = int(block["version"], 16)
            blocks.append(f"{block['block']} {number >> 8}.{number & 255}")
    return f"icesoc {newest}\nlink protocol {link}\ncontracts: {', '.join(blocks)}"
