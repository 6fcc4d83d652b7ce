# SPDX-License-Identifier: MIT
"""chip: the description of a chip for programs on the PC. It is gen/chip.json in the chip's build
folder, and has a list of slots, of objects that a client can call, and of probes. This module is
the only one that writes and reads the file."""
import dataclasses
import json
from dataclasses import dataclass, field
from pathlib import Path

FILE = "gen/chip.json"


@dataclass
class Slot:
    slot: int  # number
    name: str  # name of the block
    registers: str  # path of the block's *.regs.json


@dataclass
class Object:
    identity: str
    core: str  # name of the core, and of its register block
    slice: list  # paths of the core's Slice files
    registers: str = ""  # path of the core's *.regs.json; empty: not installed
    interface: str = ""  # empty: an interface of the core's own, in one of its Slice files


@dataclass
class Probe:
    core: str
    identity: str
    names: int  # hash of the names and widths of the signals; the chip contains the same number
    signals: list  # [name, width] of each signal, bit 0 first


@dataclass
class Chip:
    slots: list = field(default_factory=list)
    objects: list = field(default_factory=list)
    probes: list = field(default_factory=list)

    def text(self):
        """Returns the description as JSON."""
        return json.dumps(dataclasses.asdict(self), indent=1) + "\n"


def read(path):
    """Returns the description in a file. Raises OSError if the file cannot be read, and ValueError
    if it contains something else."""
    found = json.loads(Path(path).read_text())
    try:
        return Chip(*([kind(**one) for one in found.get(name, [])] for name, kind in (
            ("slots", Slot), ("objects", Object), ("probes", Probe))))
    except (AttributeError, TypeError):
        raise ValueError("expected the description of a chip") from None
