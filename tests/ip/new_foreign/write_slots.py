# SPDX-License-Identifier: MIT
"""write_slots: writes the slots of several third-party cores in one process for each CPU.

Usage: write_slots.py -- [argument of new_foreign]... [-- argument...]...

One process per core took 20 s of CPU time, most of it for the start of Python. This program takes
half of that time. The pools of concurrent.futures are not used, because their semaphores need a
writable /dev/shm, which some containers and chroots lack.
"""
import contextlib
import io
import itertools
import multiprocessing
import os
import sys

from icesoc.cores import new_foreign


def write(cores):
    """Writes some slots. If new_foreign rejects a core, ends with its message."""
    with contextlib.redirect_stdout(io.StringIO()):
        for words in cores:
            new_foreign.main(words)


def main(words):
    """Writes all slots. Returns the exit status."""
    cores = [list(group) for is_separator, group in itertools.groupby(words, "--".__eq__)
             if not is_separator]
    count = len(os.sched_getaffinity(0))
    started = [multiprocessing.Process(target=write, args=(cores[first::count],))
               for first in range(min(count, len(cores)))]
    for process in started:
        process.start()
    for process in started:
        process.join()
    return max(process.exitcode != 0 for process in started)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
