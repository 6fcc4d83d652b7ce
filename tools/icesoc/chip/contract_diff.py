# SPDX-License-Identifier: MIT
"""contract_diff: lists changes of the register contract since a commit
(./icesoc contract diff COMMIT).

    contract_diff.py SLICE2C TREE COMMIT | contract_diff.py SLICE2C OLD-FOLDER NEW-FOLDER

Compares the register descriptions of two trees: each block's *.regs.json, and those that slice2c
generates from [":hw"] interfaces. Software that was built against the old contract fails after a
breaking change: a block, register, field or event that was removed, moved or narrowed, or has
another access or type. New items and wider items are compatible. Exit status: 1 after a breaking
change, 2 if a tree cannot be read.
"""
import glob
import os
import subprocess
import sys
import tempfile

from icesoc.chip import manifest
from icesoc.regs.model import Block, Wrong
from icesoc.util.rooms import RTL

ROOMS = (*RTL, "examples")


def fail(text):
    print("contract-diff: " + text, file=sys.stderr)
    sys.exit(2)


def blocks_of(tree, slice2c, work):
    """Returns the register descriptions of all blocks, written by hand or generated from Slice
    files."""
    os.makedirs(work)
    files = [f for r in ROOMS for f in glob.glob(os.path.join(tree, r, "**", "*.regs.json"),
                                                 recursive=True)]
    for ice in [f for r in ROOMS for f in glob.glob(os.path.join(tree, r, "**", "*.ice"),
                                                    recursive=True)]:
        with open(ice) as f:
            if '":hw"' in f.read():
                run = subprocess.run([slice2c, ice, "--output-dir", work + "/c", "--hw-regs", work],
                                     capture_output=True, text=True)
                if run.returncode:
                    fail(run.stderr.rstrip().replace(tree + "/", ""))
    blocks = {}
    for file in files + glob.glob(work + "/*.regs.json"):
        try:
            block = Block.read(file)
            facts = os.path.join(os.path.dirname(file), "core.toml")
            if block.is_slot and os.path.exists(facts):
                add_memory(block, manifest.parse(facts))
        except Wrong as e:
            fail(f"{os.path.relpath(file, tree)}: {e}")
        if block.is_slot:
            blocks.setdefault(block.name, block)
    return blocks


def add_memory(block, facts):
    """Adds the size of the buffers to the description of a block. The size is in the core's
    manifest, but belongs to the register contract."""
    if "memory_bytes" in facts:
        block.description["memory_bytes"] = facts["memory_bytes"]


def places(block):
    """Returns {name: (place, width in bits, access)} of the registers, fields and events. The place
    is a text such as "word 3, from bit 4"."""
    there = {}
    for r in block.own_registers:
        word = f"word {r.word}" + (f", PAGE 0x{r.page:X}" if r.page >= 0 else "")
        there[r.name] = (word, r.width, r.access)
        for f in r.fields:
            there[f"{r.name}.{f.name}"] = (f"{word}, from bit {f.lsb}", f.width, f.access)
    for e in block.events:
        there["EVENT." + e.name] = (f"bit {e.bit}", 1, "w1c")
    return there


def compare(old, new):
    """Compares two descriptions of one block. Returns breaking and compatible changes."""
    breaking, compatible = [], []
    for key in ("type", "memory_bytes"):
        before, after = old.description.get(key, 0), new.description.get(key, 0)
        if before != after:
            grown = key == "memory_bytes" and after > before
            (compatible if grown else breaking).append(f"{key} {before} is {after}")
    before, after = map(places, (old, new))
    for name, (place, width, access) in before.items():
        if name not in after:
            breaking.append(f"{name} ({place}) is gone")
            continue
        now_place, now_width, now_access = after[name]
        if now_place != place:
            breaking.append(f"{name} moved from {place} to {now_place}")
        if now_width < width:
            breaking.append(f"{name} has {now_width} bits, and had {width}")
        elif now_width > width:
            compatible.append(f"{name} has {now_width} bits, and had {width}")
        # A change from ro to rw does not break software. A field that changes together with its
        # register is not reported separately.
        register = name.split(".")[0]
        follows = "." in name and (access, now_access) == tuple(
            names.get(register, ("", 0, ""))[2] for names in (before, after))
        if now_access != access and not follows:
            ((compatible if (access, now_access) == ("ro", "rw") else breaking)
             .append(f"{name} is {now_access}, and was {access}"))
    compatible += [f"{name} ({after[name][0]}) is new" for name in after if name not in before]
    return breaking, compatible


def main(words):
    if len(words) != 3:
        sys.exit("usage: ./icesoc contract diff --base COMMIT")
    slice2c, tree, base = words
    with tempfile.TemporaryDirectory() as work:
        if os.path.isdir(base):
            old, new = tree, base
        else:
            old, new = os.path.join(work, "old"), tree
            os.makedirs(old)
            archive = subprocess.run(["git", "-C", tree, "archive", "--end-of-options", base],
                                     capture_output=True)
            if archive.returncode:
                fail(f"BASE={base}: expected a commit: " + archive.stderr.decode().splitlines()[0])
            subprocess.run(["tar", "-x", "-C", old], input=archive.stdout, check=True)
        old, new = (blocks_of(t, slice2c, os.path.join(work, n))
                    for t, n in ((old, "o"), (new, "n")))
    broken = 0
    for name in sorted(set(old) | set(new)):
        breaking, compatible = [], []
        if name not in new:
            breaking = ["the block is gone"]
        elif name not in old:
            compatible = ["the block is new"]
        else:
            breaking, compatible = compare(old[name], new[name])
        broken += len(breaking)
        for kind, lines in (("breaking", breaking), ("compatible", compatible)):
            for line in lines:
                print(f"{kind:10} {name}: {line}")
    print(f"{broken} breaking change{'s' * (broken > 1)}" if broken else "no breaking change")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
