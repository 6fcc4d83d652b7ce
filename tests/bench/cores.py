#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""cores: measures the throughput of cores in their block tests and compares it with their memory
ports; also measures the duration of the first `./icesoc core test` in a fresh clone, compared with
the time that Verilator itself takes.

    cores.py BUILD-FOLDER OUTPUT.json [--brief]

A port moves 8 bytes per clock in each direction (docs/memory.md); the fabric clock is 100 MHz.
"""
import os
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from figures import figure, leave

# name, test program, test case, expression that finds the figure in the output, function that
# converts the figure to bytes per clock
FIGURES = (
    ("vision core, frame read", "vision", "OnePixelAClock", "^(.*) clocks a pixel",
     lambda clocks: 1 / clocks),
    ("Ascon-AEAD128, each direction", "ascon", "Speed", "AEAD128 (.*) bytes", float),
    ("Ascon-Hash256, read", "ascon", "Speed", "Hash256 ([0-9.]*)", float),
    ("FIR filter, each direction", "fir", "OneSampleAClock", "^(.*) clocks a sample",
     lambda clocks: 2 / clocks),
    ("camera, written", "camera", "APixelEach", "^(.*) pixels a clock", float))
# A minimal program that runs a Verilated model by advancing its clock.
PROGRAM = """#include "Vfir.h"
int main() {
    Vfir top;
    for (int i = 0; i < 20000; ++i, top.clk_i = i & 1) top.eval();
}
"""


def seconds(*words):
    """Runs a command without ccache, and returns its duration in seconds."""
    begin = time.monotonic()
    done = subprocess.run(list(map(str, words)), stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, env={**os.environ, "CCACHE_DISABLE": "1"})
    return sys.exit(done.stdout[-4000:]) if done.returncode else time.monotonic() - begin


def first_test(build, brief):
    """Measures how long the test of the core fir takes in a fresh clone, and how long Verilator
    alone takes for the same core with a minimal program. With --brief, runs the test in this build
    instead of in a clone."""
    source = Path(__file__).resolve().parents[2]
    with tempfile.TemporaryDirectory() as work:
        clone, words = Path(work, "icesoc"), []
        if brief:
            clone, words = source, ["--built", "--build", build]
        else:
            seconds("git", "clone", "--quiet", source, clone)
            build = clone / "build/main"
        ours = seconds(clone / "icesoc", "core", "test", "fir", *words)
        program = Path(work, "main.cpp")
        program.write_text(PROGRAM)
        alone = seconds(*"verilator --cc --exe --build -Wno-fatal --top-module fir --Mdir".split(),
                        f"{work}/model", "-f", f"{build}/files/fir_slot.f", program)
        alone += seconds(f"{work}/model/Vfir")
    print(f"the first test of fir in a fresh clone: {ours:.1f} s, Verilator alone {alone:.1f} s")
    return figure("first test of fir in a fresh clone, no compiler cache", round(ours, 1), "s",
                  peer=f"Verilator and a program of one loop: {alone:.1f} s", ratio=ours / alone)


def main(build, output, *brief):
    entries = [first_test(build, brief)] if Path(build, "ip/fir/test_ip_fir").exists() else []
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
