#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""simulator: simulated clocks a second, the best of three runs in turn: the UAV alone, at 100 and
at 2 MHz, with quiet clocks passed at once and with each one evaluated; and the mission, flown again
from its recording, on the host and on the Cortex-M3.

    simulator.py SOURCE-FOLDER BUILD-FOLDER OUTPUT.json [--brief]

--brief: without 2 MHz, whose simulator it would build
"""
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from measured import figure, leave

IMAGE = "--image", "/usr/share/xplanet/images/earth.jpg"


def logged(*words):
    done = subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    return sys.exit(done.stdout[-4000:]) if done.returncode else done.stdout


def main(source, build, output, brief=""):
    runs, seconds = (1, "0.5") if brief else (3, "5")
    slow = Path(source, "build/slow")
    work = tempfile.TemporaryDirectory()
    for cpu in "host", "m3":
        logged(f"{source}/icesoc", "run", "--built", "--build", build, *IMAGE, "--cpu", cpu,
               "--out", f"{work.name}/{cpu}",
               *("--size 96x64 --guard 20".split() if brief else ()))
    long = *IMAGE, "--duration", seconds
    kinds = {"quiet": (build, *long), "m3": (build, *long, "--cpu", "m3"),
             "every": (build, *IMAGE, "--duration", "0.02", "--every-clock"),
             "flight": (build, "--replay", f"{work.name}/host"),
             "flight m3": (build, "--replay", f"{work.name}/m3")}
    if not brief:
        logged("cmake", "-S", source, "-B", slow, "-G", "Ninja", "-DCLK_HZ=2000000",
               "-DROOMS=bus;slice;sw;hdl;ip;testbench")
        logged("ninja", "-C", slow, "--quiet", "icesoc-sim")
        kinds["slow"] = slow, *long
        kinds["slow every"] = slow, *IMAGE, "--duration", "1", "--every-clock"
    best = dict.fromkeys(kinds, (0, 0))  # million clocks a second, percent of them evaluated
    for run in range(runs):
        for kind, (folder, *options) in kinds.items():
            said = logged(f"{folder}/testbench/sim/icesoc-sim", "--speed", "max", "--out",
                          f"{work.name}/out", *options)
            found = re.search(r"([\d.]+) million clocks.*; ([\d.]+) %", said)
            best[kind] = max(best[kind], (float(found[1]), float(found[2])))
        print(f"run {run + 1}: at best {best['quiet'][0]} million clocks/s", flush=True)
    rate = {kind: rate for kind, (rate, _) in best.items()}
    active = {kind: rate * share / 100 for kind, (rate, share) in best.items()}

    def row(name, value, **beside):
        return figure(name, float(f"{value:.4g}"), "million clocks/s", **beside)

    def every(name, kind, quiet):
        return row(name, rate[kind], peer="quiet ones passed at once",
                   ratio=rate[quiet] / rate[kind])

    rows = [row("UAV at 100 MHz, quiet clocks passed at once", rate["quiet"], limit=100),
            row("the same on the Cortex-M3", rate["m3"], limit=100),
            every("each clock evaluated", "every", "quiet"),
            row("the default mission, from its recording", rate["flight"], limit=100),
            row("of these evaluated", active["flight"]),
            row("the mission on the Cortex-M3", rate["flight m3"], limit=100),
            row("of these evaluated, Cortex-M3", active["flight m3"])]
    if not brief:
        rows += [row("UAV at 2 MHz, quiet clocks passed at once", rate["slow"], limit=2),
                 every("each clock evaluated at 2 MHz", "slow every", "slow")]
    leave(output, rows)
    print(f"the mission: {rate['flight']} million clocks/s, on the Cortex-M3 {rate['flight m3']}; "
          "100 are wanted and are real time")


main(*sys.argv[1:]) if len(sys.argv) > 3 else sys.exit(__doc__)
