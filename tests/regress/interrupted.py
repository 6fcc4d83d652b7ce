#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""interrupted: interrupts make regress, make synth and ./icesoc core new at times drawn from a
seed, by Ctrl-C (INT to all processes), TERM or KILL. No process may be left, and the next run must
give the correct result.

Usage: interrupted.py source-folder build-folder work-folder moments tool... (new_ip, regress,
synth); `moments` is the number of interruptions. SEED=1
"""
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import time

from icesoc.util.rooms import ROOMS

LONGEST = 600  # time after which a run is considered to hang, s
source, build, work = (pathlib.Path(word).resolve() for word in sys.argv[1:4])
moments, tools = int(sys.argv[4]), sys.argv[5:]


def members(session):
    """Returns the processes of a session that are still running."""
    return subprocess.run(["pgrep", "--session", str(session), "--runstates", "D,I,R,S,T,t"],
                          stdout=subprocess.PIPE, text=True).stdout.split()


def interrupt(command, number, moment, where):
    """Starts a command and interrupts it. Returns True if the command was still running."""
    with open(work / "log", "w") as log:
        run = subprocess.Popen(command, cwd=where, stdout=log, stderr=log, start_new_session=True)
        try:
            run.wait(moment)
            return False
        except subprocess.TimeoutExpired:
            (os.killpg if number == signal.SIGINT else os.kill)(run.pid, number)
        run.wait(LONGEST)
        end = time.monotonic() + LONGEST
        while members(run.pid):
            assert time.monotonic() < end, "left over: %s" % members(run.pid)
            time.sleep(0.05)
        return True


def regress():
    out = work / "regress"
    command = [build / "tests/regress/regress", "--source", source, "--build", build, "--out", out,
               "--name", "^tree.pages$"]
    return (command, source, 1.5,
            lambda: [row[:2] for row in json.loads((out / "report.json").read_text())["results"]])


def synth():
    out = work / "synth"
    command = [build / "synth/utilisation", "--source", source, "--generated", build / "gen",
               "--output", out, "--design", "npi_arbiter"]
    return command, source, 6, lambda: (out / "report.json").read_text()


def new_ip():
    tree = work / "tree"
    for folder in ROOMS:
        (tree / folder).mkdir(parents=True)
    core = tree / "ip/low_pass"

    def written():
        files = {path.name: path.read_bytes() for path in core.iterdir()}
        shutil.rmtree(core)
        return files

    made = ('[ -d ip/low_pass ] || '
            'ICESOC_TREE=. exec "$0" core new low_pass --lang vhdl --built --build none')
    return ["sh", "-c", made, source / "icesoc"], tree, 0.3, written


def main():
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    draw = random.Random(int(os.environ.get("SEED", 1)))
    for tool in tools:
        command, where, longest, result = {"new_ip": new_ip, "regress": regress,
                                           "synth": synth}[tool]()
        subprocess.run(command, cwd=where, check=True, stdout=subprocess.DEVNULL, timeout=LONGEST)
        right = result()
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL) * moments:
            moment = draw.uniform(0, longest)
            # removes the result that the previous run stored
            shutil.rmtree(work / tool, ignore_errors=True)
            cut = interrupt(command, number, moment, where)
            subprocess.run(command, cwd=where, check=True, stdout=subprocess.DEVNULL,
                           timeout=LONGEST)
            place = f"{tool:<8} {number.name:<7} at {moment:.2f} s{'' if cut else ' (too late)'}"
            assert result() == right, f"{place}: another result"
            print(f"{place}: the next run is right", flush=True)


main()
