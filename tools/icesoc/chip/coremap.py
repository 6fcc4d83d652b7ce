# SPDX-License-Identifier: MIT
"""coremap: builds the chip from the cores in ip/cores.list, one per line (docs/hw-mapping.md).

Writes map.regs.json (slots, memory ports, buffers in DDR3, pins), soc_cores.vh (instances, for
soc.v), soc_cores.c (servants), soc_pins.h and core_pins.vh (for the simulator), core_pins.ucf (for
ISE), chip.json (slots, objects and probes, for the programs on the PC), and register descriptions
for other tools and for people.
"""
import argparse
import os
import sys

from icesoc.regs import core_exchange
from icesoc.chip import collisions, core_output, manifest
from icesoc.chip.model import SLOT_BYTES, Chip, Slot, read
from icesoc.regs.generate import save
from icesoc.regs.model import Block, Wrong, check
from icesoc.util.errors import reason_of


def described(path):
    try:
        return Block.read(path)
    except Wrong as e:
        raise Wrong(f"1: error: '{path}': {e}") from None


def of_core(file, registers):
    """Returns the manifest of a core and its register block."""
    try:
        found = manifest.read(file)
        return found, manifest.block_of(found, registers)
    except Wrong as e:
        raise Wrong(f"1: error: {e}") from None


def parts(option, text, form):
    found = text.split("=", form.count("="))
    check(len(found) == form.count("=") + 1, f"1: error: {option}: expected {form}, got '{text}'")
    return found


def build(asked):
    """Returns all generated files as {name: text}."""
    manifests, descriptions, files = {}, {}, {}
    for folder, file, registers in (parts("--core", c, "folder=core.toml=file")
                                    for c in asked.core):
        manifests[folder], descriptions[folder] = of_core(file, registers)
        files[folder] = registers
    slices = [parts("--slice", s, "folder=file") for s in asked.slice]
    base = described(asked.base).description
    chip = Chip(read(asked.list), base, manifests, descriptions)
    blocks = [parts("--block", b, "slot=name=file") for b in asked.block]
    slots = [(name, int(number), described(file)) for number, name, file in blocks]
    collisions.check(chip, base, [block for _, _, block in slots])
    slots += [(core.name, core.slot, descriptions[core.folder]) for core in chip.cores]
    placed = [Slot(name, number, chip.registers + SLOT_BYTES * number, block)
              for name, number, block in slots]
    paths = {slot.name: os.path.abspath(file) for slot, (_, _, file) in zip(placed, blocks)}
    paths.update({core.name: os.path.abspath(files[core.folder]) for core in chip.cores})
    return core_output.files(chip, placed, base) | core_exchange.files(placed) | {
        "chip.json": core_output.description_of(chip, placed, paths, slices)}


def main():
    parser = argparse.ArgumentParser(
        description="Puts the cores of a list into the chip: address map, instances in Verilog, "
                    "the firmware's table.")
    parser.add_argument(
        "list", help="cores.list, with one core per line: folder [name=] [identity=] [slot=] "
        "[memory=] [gate=on] [clock=3/8] [signals=u_fir.count:9] [input=core.output] [pin=@places]")
    parser.add_argument("--base", required=True, help="the platform's map.regs.json")
    for option, text in (
            ("--core", "FOLDER=MANIFEST=REGISTERS of a core (core.toml, *.regs.json)"),
            ("--slice", "FOLDER=FILE of a core: a Slice file of its servant"),
            ("--block", "slot=name=description of a block of the platform, for the pages")):
        parser.add_argument(option, action="append", default=[], help=text)
    parser.add_argument("--output-dir", default=".", help="output folder")
    asked = parser.parse_args()
    try:
        for name, text in build(asked).items():
            save(os.path.join(asked.output_dir, name), text)
    except (Wrong, OSError) as e:
        sys.exit(f"{asked.list}:{'' if isinstance(e, Wrong) else '1: error: '}{reason_of(e)}")


if __name__ == "__main__":
    main()
