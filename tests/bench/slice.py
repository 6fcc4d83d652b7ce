#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""slice: measures the CPU time of slice2c and slice2cpp for the five largest files of Debian's
zeroc-ice-slice. The two compilers alternate on each file, and the best of several rounds counts,
because other programs on the machine can only make them slower.

    slice.py SLICE2C OUTPUT.json [--brief]
"""
import pathlib
import resource
import shutil
import subprocess
import sys
import tempfile

from figures import figure, leave

SLICES = pathlib.Path("/usr/share/ice/slice")


def once(program, file, folder):
    """Returns the CPU time of one run, ms, as the mean of ten runs."""
    spent = lambda: sum(resource.getrusage(resource.RUSAGE_CHILDREN)[:2])
    begin = spent()
    for _ in range(10):
        subprocess.run([program, "-I", SLICES, file, "--output-dir", folder], check=True,
                       stdout=subprocess.DEVNULL)
    return (spent() - begin) * 100


def entry(name, ours, theirs):
    print("%-28s %9.2f ms %9.2f ms %8.2f" % (name, theirs, ours, theirs / ours))
    return figure(f"slice2c.{name}", round(ours, 2), "ms", peer=f"slice2cpp: {theirs:.2f} ms",
                  ratio=theirs / ours)


def main(slice2c, output, brief=""):
    if not shutil.which("slice2cpp"):
        sys.exit("slice: slice2cpp is missing; run './icesoc setup'")
    largest = sorted(SLICES.rglob("*.ice"), key=lambda f: -f.stat().st_size)[:1 if brief else 5]
    print("%-28s %12s %12s %8s" % ("file", "slice2cpp", "slice2c", "ratio"))
    entries, sums = [], [0, 0]
    with tempfile.TemporaryDirectory() as folder:
        for file in largest:
            rounds = [(once(slice2c, file, folder), once("slice2cpp", file, folder))
                      for _ in range(1 if brief else 15)]
            best = [min(times) for times in zip(*rounds)]
            entries.append(entry(str(file.relative_to(SLICES)), *best))
            sums = [a + b for a, b in zip(sums, best)]
    entries.append(entry("all", *sums))
    leave(output, entries)


main(*sys.argv[1:]) if len(sys.argv) > 2 else sys.exit(__doc__)
