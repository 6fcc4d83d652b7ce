#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""simulator: measures simulated clocks per second, as the best of three alternating runs. It
measures the UAV without a ground station (with quiet clocks skipped, with each clock evaluated, and
with a camera that sends pictures which the vehicle ignores) and the replay of a mission (with the
firmware's host build, with the model of the Cortex-M3, and with pictures from a camera).

    simulator.py SOURCE-FOLDER BUILD-FOLDER OUTPUT.json [--brief]
"""
import re
import subprocess
import sys
import tempfile

from figures import figure, leave

IMAGE = "--image", "/usr/share/xplanet/images/earth.jpg"


def logged(*words):
    done = subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    return sys.exit(done.stdout[-4000:]) if done.returncode else done.stdout


def main(source, build, output, brief=""):
    runs, seconds = (1, "0.5") if brief else (3, "5")
    work = tempfile.TemporaryDirectory()
    camera = "--camera", "--size", "96x64" if brief else "640x480"
    flown = {"host": (), "m3": ("--cpu", "m3"), "camera": camera}
    for flight, options in flown.items():
        logged(f"{source}/icesoc", "run", "--built", "--build", build, *IMAGE, "--out",
               f"{work.name}/{flight}", *("--size 96x64 --guard 20".split() if brief else ()),
               *options)
    long = *IMAGE, "--duration", seconds
    kinds = {"quiet": (build, *long), "m3": (build, *long, "--cpu", "m3"),
             "every": (build, *IMAGE, "--duration", "0.02", "--every-clock"),
             "camera": (build, *long, *camera),
             "flight": (build, "--replay", f"{work.name}/host"),
             "flight m3": (build, "--replay", f"{work.name}/m3"),
             "flight camera": (build, "--replay", f"{work.name}/camera")}
    # millions of clocks per second, and percentage of skipped clocks, of each kind
    best = dict.fromkeys(kinds, (0, 0))
    for run in range(runs):
        for kind, (folder, *options) in kinds.items():
            said = logged(f"{folder}/testbench/sim/icesoc-sim", "--speed", "max", "--out",
                          f"{work.name}/out", *options)
            found = re.search(r"([\d.]+) million clocks.*; ([\d.]+) % .* skipped", said)
            best[kind] = max(best[kind], (float(found[1]), float(found[2])))
        print(f"run {run + 1}: at best {best['quiet'][0]} million clocks/s", flush=True)
    rate = {kind: rate for kind, (rate, _) in best.items()}
    active = {kind: rate * (1 - skipped / 100) for kind, (rate, skipped) in best.items()}

    def row(name, value, unit="million clocks/s", **compared):
        return figure(name, float(f"{value:.4g}"), unit, **compared)

    def real_time(name, kind):
        return row(name, rate[kind], "million clocks/s, at least", limit=100)

    leave(output, [
        real_time("vehicle at 100 MHz, idle clocks skipped", "quiet"),
        real_time("the same, firmware on the Cortex-M3 model", "m3"),
        row("the same, every clock evaluated", rate["every"], peer="with idle clocks skipped",
            ratio=rate["quiet"] / rate["every"]),
        real_time("replay of the default mission", "flight"),
        row("clocks evaluated in that replay", active["flight"]),
        real_time("replay of the mission, firmware on the Cortex-M3 model", "flight m3"),
        row("clocks evaluated in that replay, Cortex-M3", active["flight m3"]),
        real_time("vehicle with a camera, 640 x 480, 4 pictures/s, no capture", "camera"),
        row("clocks evaluated by that vehicle", active["camera"]),
        real_time("replay of the mission with that camera", "flight camera"),
        row("clocks evaluated in that replay, camera", active["flight camera"])])
    print(f"the mission: {rate['flight']} million clocks/s, on the Cortex-M3 {rate['flight m3']}; "
          "100 are wanted and are real time")


main(*sys.argv[1:]) if len(sys.argv) > 3 else sys.exit(__doc__)
