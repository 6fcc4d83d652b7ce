# SPDX-License-Identifier: MIT
"""collisions: rejects a chip in which two cores, or a core and the platform, would have the same
name in the generated files.

For example, the output `c_o` of a core `a_b` and the output `b_c_o` of a core `a` would both get
the wire pin_a_b_c_o. The error message contains both names.
"""
import re

from icesoc import TREE
from icesoc.regs.names import Collision, Spelled, constants
from icesoc.util import rooms

PLATFORM = "the platform"


def platform_names(base):
    """Yields (scope, name) for each name that the platform uses: names in hdl/soc.v, names of
    modules, and names of the constants of bus/map.regs.json."""
    text = re.sub("//.*", "", (TREE / "hdl/soc.v").read_text())
    yield from (("soc.v", name) for name in re.findall(r"[A-Za-z_]\w*", text))
    yield from (("modules", path.stem) for room in rooms.PLATFORM
                for path in (TREE / room).rglob("*.v"))
    yield from (("map_regs.h", constant["name"]) for constant in base["constants"])
    yield "core_pins.ucf", "soc_clk"


def instance_names(core):
    """Yields (scope, name) for each name that core_output.py derives from a core of the chip."""
    name, upper = core.name, core.name.upper()
    yield from (("soc.v", stem + name) for stem in ("u_", "u_gate_", "u_clock_", "clk_", "idle_",
                                                    "cycles_", "signals_"))
    yield from (("soc.v", f"pin_{name}_{pin.name}") for pin in core.pins)
    yield from (("soc.v", f"{name}_{number}") for number in range(len(core.signals)))
    yield from (("soc_cores.c", f"core_{name}{end}")
                for end in ("", "_table", "_start", "_interrupt", "_poll"))
    yield from (("map_regs.h", stem + upper) for stem in ("SLOT_", "NPI_PORT_", "MEMORY_"))
    yield from (("map_regs.h", f"PIN_{upper}_{pin.name.upper()}") for pin in core.pins)
    yield "core_pins.ucf", f"{name}_clk"


def constant_names(block):
    """Returns pairs for the constants of a block: the name in C, and the name in the
    description."""
    return [(f"{block.prefix}_{name}", f"{block.name}.{owner}")
            for name, owner in constants(block).owners.values()]


def check(chip, base, blocks):
    """Raises Wrong if two cores, or a core and the platform, would have the same name in a
    generated file. The message contains the line of the later core in ip/cores.list. `blocks`: the
    register blocks of the platform."""
    scopes, registers = {}, Spelled()
    for block in blocks:
        for name, owner in constant_names(block):
            registers.add(name, owner)
    for scope, name in platform_names(base):
        found = scopes.setdefault(scope, Spelled())
        found.owners.setdefault(name.upper(), (name, PLATFORM))
    folders = set()
    for core in chip.cores:
        spelled, constants_here = set(instance_names(core)), []
        if core.folder not in folders:  # several cores may be instances of one folder
            spelled |= {("modules", core.folder + end)
                        for end in ("", "_regs", "_clocked", "_wrapper")}
            constants_here = constant_names(chip.descriptions[core.folder])
        folders.add(core.folder)
        try:
            for scope, name in sorted(spelled):
                scopes.setdefault(scope, Spelled()).add(name, f"core '{core.name}'")
            for name, owner in constants_here:
                registers.add(name, owner)
        except Collision as e:
            core.fail(str(e))
