#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""speed: clocks a second of the Verilated chip in the simulator, each one evaluated, and of the
same chip under Icarus (chip_tb.v).

    speed.py ICESOC-SIM SOURCE-FOLDER GENERATED-FOLDER OUTPUT.json [--brief]

Both are at rest, where Icarus has the least to do. In processor time: what else the machine does,
does not count. Of three runs the quickest counts; --brief: one run of fewer clocks. Exit status 1:
Verilator's model is not LEAST times as fast as Icarus: something costs that should not.
"""
import re
import resource
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

from measured import figure, leave

LEAST = 50
IMAGE = "/usr/share/xplanet/images/earth.jpg"


def run(*words):
    done = subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    return sys.exit(done.stdout) if done.returncode else done.stdout


def quickest(runs, once):
    """Clocks a second of a processor"""
    def spent():
        return sum(resource.getrusage(resource.RUSAGE_CHILDREN)[:2])

    def timed():
        begin = spent()
        clocks = once()
        return clocks / (spent() - begin)

    return max(timed() for _ in range(runs))


def main(simulator, source, generated, output, brief=""):
    runs, seconds, rest = (1, "0.0025", 1000) if brief else (3, "0.02", 20000)
    source = Path(source)
    with tempfile.TemporaryDirectory() as work:
        folders = [source / "bus", *source.glob("hdl/*/"), *source.glob("ip/*/"), generated]
        run("iverilog", "-g2005", "-o", f"{work}/chip.vvp", "-s", "chip_tb",
            *(word for folder in folders for word in ("-y", folder, "-I", folder)),
            source / "tests/bench/chip_tb.v", source / "hdl/soc.v")

        def verilator():
            run(simulator, "--image", IMAGE, "--speed", "max", "--duration", seconds,
                "--every-clock", "--out", f"{work}/flight")
            # cycles in sw/ground/sim_status.h
            return struct.unpack_from("q", Path(work, "flight/status").read_bytes(), 16)[0]

        def icarus():
            # newer ones tell of $finish, too
            said = run("vvp", "-n", f"{work}/chip.vvp", f"+clocks={rest}")
            return int(re.search(r"^clocks (\d+)", said, re.M)[1])

        ours, theirs = quickest(runs, verilator), quickest(runs, icarus)
    times = ours / theirs
    name = "Verilator over Icarus, each clock of the chip at rest"
    leave(output, [figure(name, round(times), "times, at least", limit=LEAST)])
    print(f"Verilator is {times:.0f} times as fast as Icarus; {LEAST} are wanted")
    if times < LEAST:
        sys.exit(f"speed: too slow, see {output}")


main(*sys.argv[1:]) if len(sys.argv) > 4 else sys.exit(__doc__)
