# SPDX-License-Identifier: MIT
"""write_slots: writes the slots of several third-party cores in one process, in parallel.

Usage: write_slots.py -- [argument of new_foreign]... [-- argument...]...

One process per core took 20 s of CPU time, most of it for the start of Python. This program takes
half of that time.
"""
import concurrent.futures
import contextlib
import io
import itertools
import sys

from icesoc.cores import new_foreign


def write(words):
    """Writes one slot. If new_foreign rejects the core, ends with its message."""
    with contextlib.redirect_stdout(io.StringIO()):
        new_foreign.main(words)


def main(words):
    cores = [list(group) for is_separator, group in itertools.groupby(words, "--".__eq__)
             if not is_separator]
    with concurrent.futures.ProcessPoolExecutor() as pool:
        list(pool.map(write, cores))


if __name__ == "__main__":
    main(sys.argv[1:])
