# SPDX-License-Identifier: MIT
"""blocks: collects the known facts of each block; a block is a folder of the tree. The facts are
the tests and proofs of this run, the lines covered, the mutants caught, the LUTs, and the last
commit without a failure."""
import collections
import pathlib
import re

from icesoc.regress.lights import below_gate
from icesoc.util.rooms import PLATFORM, RTL
from icesoc.util.tree import tracked


class Blocks:
    """Finds the block to which a file, a module or a test belongs."""

    def __init__(self, source):
        files = [pathlib.PurePath(file) for file in tracked(source)]
        self.folders = {str(folder) for file in files for folder in file.parents}
        self.modules = {file.stem: str(file) for file in files
                        if file.suffix in (".v", ".vhd") and file.parts[0] in RTL}

    def of_file(self, path):
        return "/".join(path.split("/")[:-1][:2])

    def of_module(self, name):
        """Returns the block of the module `name`. If it does not exist, uses the module with
        the longest name that `name` begins with, or else the first module that begins with the
        first word of `name`. Returns "" if neither exists."""
        first = name.partition("_")[0] + "_"
        while name and name not in self.modules:
            name = name.rpartition("_")[0]
        name = name or next((each for each in sorted(self.modules) if each.startswith(first)), "")
        return self.of_file(self.modules[name]) if name else ""

    def of_test(self, name, place):
        about = re.match(r"((formal|lint|hdl[.]cdc)[.])?(test_|idle_|crossings_)?(\w+)", name)[4]
        if f"ip/{place}" in self.folders:
            return f"ip/{place}"
        if place.split("/")[0] in PLATFORM and (block := self.of_module(about)):
            return block
        words = place.split("/")[:2]
        return "/".join(words) if "/".join(words) in self.folders else words[0]


def last_green(history, block_of):
    """Returns {block: commit}: the newest commit at which a test of the block passed and no test of
    the block was failing."""
    failing, green = collections.defaultdict(set), {}
    for run in history.runs:
        ran = collections.defaultdict(set)
        for name, how, _, _, seed in run["ends"]:
            if block := block_of.get(name):
                ran[block].add(how)
                (failing[block].add if how == "f" else failing[block].discard)((name, seed))
        green.update({block: run["commit"] for block in ran
                      if "p" in ran[block] and not failing[block]})
    return green


def blocks_of(data, tests, history, source):
    """Returns rows for the data of report.py: {block, tests and proofs: [passed, failed, did not
    run], lines: [covered, total, files below their gate], mutants: [caught, total], luts: [LUTs and
    budget of the largest design, number of designs over budget], green}; unknown values are left
    out."""
    blocks, rows = Blocks(source), collections.defaultdict(dict)

    def add(block, what, *numbers):
        if block:
            known = rows[block].get(what, [0] * len(numbers))
            rows[block][what] = [a + b for a, b in zip(known, numbers)]
    block_of = {test.name: blocks.of_test(test.name, test.place) for test in tests}
    left = set(block_of)
    for name, status, *_ in data["results"]:
        left.discard(name)
        add(block_of.get(name), "proofs" if name.startswith("formal.") else "tests",
            status == "passed", status == "failed", 0)
    for name in left:
        add(block_of[name], "proofs" if name.startswith("formal.") else "tests", 0, 0, 1)
    for file in data.get("coverage", {}).get("entries", []):
        add(blocks.of_file(file["name"]), "lines", file["value"] * file["lines"] / 100,
            file["lines"], below_gate(file))
    for _, result, _, _, place in data["mutants"]:
        if place:
            add(blocks.of_file(place), "mutants", result == "caught", 1)
    luts = collections.defaultdict(list)
    for each in data.get("utilisation", {}).get("entries", []):
        design, _, figure = each["name"].rpartition(" ")
        if figure == "lut" and "limit" in each and design in blocks.modules:
            luts[blocks.of_module(design)].append((each["value"], each["limit"]))
    for block, designs in luts.items():
        rows[block]["luts"] = [*max(designs), sum(value > limit for value, limit in designs)]
    green = last_green(history, block_of)
    return [{"block": block, "green": green.get(block, ""), **row}
            for block, row in sorted(rows.items())]
