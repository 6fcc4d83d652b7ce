#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""cores: measures the throughput of cores in their block tests and compares it with their memory
ports.

    cores.py BUILD-FOLDER OUTPUT.json [--brief]

A port moves 8 bytes per clock in each direction (docs/memory.md); the fabric clock is 100 MHz.
"""
import re
import subprocess
import sys
from pathlib import Path

from figures import figure, leave

# name, test program, test case, expression that finds the figure in the output, function that
# converts the figure to bytes per clock
FIGURES = (
    ("vision core, frame read", "vision", "ProcessesOnePixelPerClock", "^(.*) clocks a pixel",
     lambda clocks: 1 / clocks),
    ("Ascon-AEAD128, each direction", "ascon", "ReachesItsRate", "AEAD128 (.*) bytes", float),
    ("Ascon-Hash256, read", "ascon", "ReachesItsRate", "Hash256 ([0-9.]*)", float),
    ("FIR filter, each direction", "fir", "ProcessesOneSamplePerClock", "^(.*) clocks a sample",
     lambda clocks: 2 / clocks),
    ("camera, written", "camera", "StoresOnePixelPerClock", "^(.*) pixels a clock", float))


def main(build, output, *_):
    entries = []
    for name, core, case, expression, bytes_of in FIGURES:
        program = Path(build, f"ip/{core}/test_ip_{core}")
        if not program.exists():  # the chip of this build does not contain this core
            continue
        said = subprocess.run([program, f"--gtest_filter=*{case}*"], stdout=subprocess.PIPE,
                              text=True).stdout
        found = re.search(expression, said, re.M) or sys.exit(f"cores: {core} prints no {name}")
        value = round(bytes_of(float(found[1])), 3)
        print(f"{name:<34} {value} bytes per clock: {100 * value:.1f} MB/s at 100 MHz, "
              f"{100 * value / 8:.1f} % of the port")
        entries.append(figure(name, value, "bytes per clock", limit=8))
    leave(output, entries)


main(*sys.argv[1:]) if len(sys.argv) > 2 else sys.exit(__doc__)
