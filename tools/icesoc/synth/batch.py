# SPDX-License-Identifier: MIT
"""batch: runs several syntheses in parallel, and shows their progress."""
import concurrent.futures
import os
import sys
import threading
import time

from icesoc.synth.synthesis import carry_out_one, netlist_of_order, version_of
from icesoc.util.errors import Stop
from icesoc.util.progress import Line, clock


def time_left(runs, options, now):
    """Returns a line such as "11 of 55 designs, about 3:20 left: soc, vision". The time of a design
    on an idle machine is estimated from its number of LUTs. The finished runs, or the load, show
    how much slower this machine is. For a design that is synthesised in several orders, the number
    of netlists already written shows its progress."""
    def expected(run):
        return 1 + options.luts.get(run.design.name, 100) * (1 + run.orders) / 200

    def rest(run):
        files = [f"{run.netlist}.part"] + [netlist_of_order(run.netlist, n + 1)
                                           for n in range(run.orders)]
        age, written = now - run.begun, sum(map(os.path.exists, files))
        return (age * (len(files) - written) / written if written else
                max(slowness * expected(run) - age, age / 10))

    ended = [run for run in runs if run.spent is not None]
    new = [run for run in ended if run.spent]
    slowness = sum(run.spent for run in new) / sum(map(expected, new)) if new else \
        max(1, os.getloadavg()[0] / os.cpu_count())
    running = [run for run in runs if run.begun and run.spent is None]
    rests = list(map(rest, running))
    waiting = slowness * sum(expected(run) for run in runs if not run.begun)
    left = round(max([0, (waiting + sum(rests)) / options.jobs, *rests]))
    return (f"{len(ended)} of {len(runs)} designs, about {clock(left)} left: "
            f"{', '.join(run.design.name for run in running)}")


def carry_out(runs, library, options):
    """Carries out all runs. Prints each finished run on stderr and, on a terminal, the remaining
    time. A failed run does not stop the others."""
    version = version_of(options.yosys)
    options.cache.mkdir(parents=True, exist_ok=True)
    wanted, line, over = [r for r in runs if r.wanted], Line(sys.stderr), threading.Event()

    def tell():
        while not over.wait(1) and any(run.spent is None for run in wanted):
            line.show(time_left(wanted, options, time.monotonic()))

    def work(run):
        run.begun = time.monotonic()
        try:
            is_new = carry_out_one(run, library, options, version)
        except (Stop, ValueError, KeyError, OSError) as error:
            run.error, is_new = str(error), True
        run.spent = time.monotonic() - run.begun if is_new else 0
        if is_new and run.wanted:
            result = (f"{run.figures['lut']} LUT, {run.figures['ff']} FF" if run.figures
                      else "failed")
            done = sum(each.spent is not None for each in wanted)
            line.show(f"[{done}/{len(wanted)}] {run.design.name} for {run.family}: {result} "
                      f"({run.spent:.1f} s)", keep=True)

    # designs with limits come first, because their figures are checked; then the largest designs
    def size(run):
        files = library.files_of(run.design.top)
        return (not run.design.limits, -sum(file.stat().st_size for file in files))

    threading.Thread(target=tell, daemon=True).start()
    sys.setrecursionlimit(1 << 20)  # the functions recurse as deep as the logic of a design
    threading.stack_size(512 << 20)
    try:
        in_parallel(options.jobs, work, sorted(runs, key=size))
    finally:
        over.set()
        line.clear()


def in_parallel(jobs, work, items):
    """Calls work(item) for each item, with `jobs` calls at a time; raises the first exception."""
    with concurrent.futures.ThreadPoolExecutor(max(1, jobs)) as pool:
        try:
            for future in [pool.submit(work, item) for item in items]:
                future.result()
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise
