#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""faults: injects faults into missions: it kills or stops one of a mission's processes, or denies
it a resource, at times drawn from seeds. docs/regression.md contains the table of the expected
consequences.

A `moment` is a time of the flight: the first 0.3 seconds are counted from the start of the process,
the rest in simulated seconds (about 1.7 s per flight). Therefore each moment is within the flight,
however fast the machine is."""

import argparse
import concurrent.futures
import contextlib
import json
import os
import random
import re
import shutil
import signal
import struct
import subprocess
import sys
import time
from pathlib import Path

from fleet_ground import TROUBLE, VEHICLES, words_of
from icesoc.util import record
from icesoc.util.process import children

STATUS = record.of_tree("testbench/status/sim_status.toml")
IMAGE = "/usr/share/xplanet/images/earth.jpg"
LONGEST = 240.0  # time limit of a mission on a busy machine, s
REAL = 0.3  # first part of each moment, counted in real time from the start of the process, s
# latest moment, s. A fault that has a size instead of a time scales its size with moment / LAST.
LAST = 2.0


def proc(pid, name):
    """Returns the text of a process's file in /proc, or "" if the process has ended."""
    try:
        return Path(f"/proc/{pid}/{name}").read_text()
    except (FileNotFoundError, ProcessLookupError):
        return ""


def descendants(of):
    return [pid for child in children(of) for pid in (child, *descendants(child))]


def command_of(pid):
    return proc(pid, "cmdline").replace("\0", " ")


def lives(pid):
    return proc(pid, "stat").rpartition(")")[2].split()[:1] not in ([], ["Z"])


class Mission:
    """A mission that is running, and its processes by name."""
    NAMES = {"ground": "clients/mission.py", "simulator": "sim/icesoc-sim",
             "page": "icesoc.web.live(?!.* --try)", "page's trial": "icesoc.web.live.* --try"}

    def __init__(self, source, build, out, prefix=(), options=(), words=None):
        """words: command to run instead of `./icesoc run` with its options."""
        self.out, self.source, self.build = out, source, build
        os.makedirs(out, exist_ok=True)
        self.log = open(out + ".log", "w+")
        run = [source + "/icesoc", "run", "--built", "--build", build, "--image", IMAGE, "--size",
               "48x32", "--guard", "20", "--out", out, *options]
        self.run = subprocess.Popen(
            [*(word.replace("$0", out) for word in prefix), *(words(self) if words else run)],
            stdout=self.log, stderr=subprocess.STDOUT, start_new_session=True,
            # keys that only the tests use
            env={**os.environ, "XDG_CONFIG_HOME": build + "/config"})

    def all(self):
        return [self.run.pid] + descendants(self.run.pid)

    def find(self, name):
        """Waits for the process with this name to exist, and returns it; returns None if the
        mission ended first."""
        while name != "run" and self.run.poll() is None:
            for pid in descendants(self.run.pid):
                command = command_of(pid)
                if re.search(self.NAMES[name], command) and "setpriv" not in command:
                    return pid
            time.sleep(0.005)
        return self.run.pid if name == "run" else None

    def pass_time(self, moment):
        """Waits until this moment of the flight, or until the flight has ended."""
        time.sleep(min(moment, REAL))
        while self.run.poll() is None and self.simulated() < moment - REAL:
            time.sleep(0.002)

    def simulated(self):
        """Returns the simulated time from the simulator's counters, s."""
        try:
            return STATUS.unpack(Path(self.out, "status").read_bytes(), "ns")["ns"] / 1e9
        except (FileNotFoundError, struct.error):
            return 0

    def wait(self, seconds):
        with contextlib.suppress(subprocess.TimeoutExpired):
            return self.run.wait(seconds)

    def text(self):
        self.log.seek(0)
        return self.log.read()

    def succeeded(self):
        return self.run.returncode == 0 and all(
            os.path.getsize(os.path.join(self.out, f))
            for f in ("after.png", "report.md", "report.json"))

    def remove(self):
        for path in (self.out, self.out + ".kept"):
            shutil.rmtree(path, ignore_errors=True)
        self.log.close()
        for left in Path(self.out).parent.glob(Path(self.out).name + ".*"):
            left.unlink()

    def kill(self):
        """Ends all processes that remain at the end of the test."""
        for pid in self.all():
            with contextlib.suppress(ProcessLookupError):
                os.kill(pid, signal.SIGKILL)
        self.run.wait()


class Fault(AssertionError):
    pass


def expect(condition, mission, text):
    if not condition:
        raise Fault("%s\n%s" % (text, mission.text()))


def is_whole(out):
    """Reads all pictures and JSON files, to check that each of them is complete. Returns True if no
    temporary file is left."""
    from PIL import Image
    for path in Path(out).iterdir():
        if path.suffix == ".png":
            Image.open(path).load()
        elif path.suffix == ".json":
            json.loads(path.read_text())
    return not list(Path(out).glob("*.new"))


def caught(start, name, moment):
    """Starts a mission and waits for a moment. Returns the mission and its process with this name,
    or None instead of the process if it has ended."""
    m = start()
    pid = m.find(name)
    m.pass_time(moment)
    return m, pid if pid and m.run.poll() is None and lives(pid) else None


def goes_on(m, otherwise):
    expect(m.wait(LONGEST) == 0 and m.succeeded(), m, otherwise)
    return "the mission continues"


def without_page(m):
    """Kills the page server. The mission must continue, because the page is only a view of it."""
    said = goes_on(m, "the mission needs the page")
    expect(re.search("page.*signal 9", m.text()), m, "no message about the end of the page")
    return said


def refused(m, why):
    expect(m.wait(LONGEST), m, "it flies, or hangs")
    expect(re.search(why, m.text()), m, "no message with the reason")
    expect(m.simulated() == 0, m, "it is refused after it flew")
    return "refused before it flies"


def killed_early(start, name, moment, deaths):
    """Kills the process within its first 10 ms."""
    m = start()
    pid = m.find(name)
    time.sleep(0.01 * moment / LAST)
    if not pid or not lives(pid):
        return "too late"
    os.kill(pid, signal.SIGKILL)
    return without_page(m)


def killed(start, name, moment, deaths):
    m, pid = caught(start, name, moment)
    everybody = m.all()
    if not pid:
        return "too late"
    os.kill(pid, signal.SIGKILL)
    if name == "page":
        return without_page(m)
    begin = time.monotonic()
    while any(map(lives, everybody)):
        expect(time.monotonic() < begin + deaths, m, "still there after %.0f s: %s" %
               (deaths, [command_of(p) for p in everybody if lives(p)]))
        time.sleep(0.01)
    took = time.monotonic() - begin
    m.run.wait()
    if name != "run":
        expect("signal 9" in m.text(), m, "no message about the cause")
        expect(m.run.returncode != 0 or m.succeeded(), m, "it reports success")
    return "all end, within %.1f s" % took


def stopped(start, name, moment, deaths):
    m, pid = caught(start, name, moment)
    if not pid:
        return "too late"
    os.kill(pid, signal.SIGSTOP)
    time.sleep(3)
    os.kill(pid, signal.SIGCONT)
    return goes_on(m, "it did not survive a pause of 3 s")


def disk_full(start, name, moment, deaths):
    """The output folder is a separate file system with only a few blocks; its files are copied at
    the end."""
    size = 4096 * int(1 + 7 * moment / LAST)
    script = (f"mount -t tmpfs -o size={size} none $0 || exit 9; status=0; \"$@\" || status=$?; "
              "cp -a $0 $0.kept; exit $status")
    m = start(prefix=["unshare", "--map-root-user", "--mount", "sh", "-c", script, "sh"])
    status = m.wait(LONGEST)
    expect(status is not None and status != 9, m, "it hangs")
    expect("Traceback" not in m.text() and "Bus error" not in m.text(), m, "not a clear message")
    expect(is_whole(m.out + ".kept"), m, "a file is cut short")
    expect(status == 0 or "No space left" in m.text() or "disk full" in m.text(), m,
           "no message with the reason")
    return "fails with a message" if status else "has room enough"


def no_descriptors(start, name, moment, deaths):
    return refused(start(prefix=["prlimit", f"--nofile={8 + int(25 * moment / LAST)}"]),
                   "expected at least 64, got [0-9]+; raise it by ulimit -n 64")


def port_taken(start, name, moment, deaths):
    import socket
    with socket.create_server(("127.0.0.1", 0)) as s:
        return refused(start(options=["--port", str(s.getsockname()[1])]), "the port may be in use")


def no_memory(start, name, moment, deaths):
    """Limits the address space of each process to a size from 8 to 800 MB."""
    m = start(prefix=["prlimit", "--as=%d" % (8e6 * 100**(moment / LAST))])
    status = m.wait(LONGEST)
    expect(status is not None, m, "it hangs")
    expect(status != 0 or m.succeeded(), m, "it reports success")
    expect(status == 0 or m.text().strip(), m, "it fails without a word")
    # If the memory is not enough to start the interpreter, Python reports this with a traceback.
    expect("Fatal Python error: init" in m.text() or
           not re.search("bad_alloc|Traceback", m.text()), m, "not a clear message")
    expect(is_whole(m.out), m, "a file is cut short")
    return "fails with a message" if status else "succeeds"


def clock_step(start, name, moment, deaths):
    """Makes the time of day jump forward or back by hours, every second."""
    m = start(prefix=["env", "LD_PRELOAD=" + CLOCK_STEP])
    said = goes_on(m, "it lives by the clock of the day")
    expect("cannot be preloaded" not in m.text(), m, "no clock was stepped")
    return said


def loss(start, name, moment, deaths):
    """Loses a fraction of all packets; `name` is this fraction."""
    m = start(options=["--loss", name, "--patience", "16", "--seed", str(int(1000 * moment))])
    status = m.wait(LONGEST)
    expect(status is not None, m, "it does not end")
    reported = re.search("^mission: .+", m.text(), re.M)
    expect(status == 0 and m.succeeded() or reported, m, "no message about the missing part")
    return "fails after its patience" if status else "succeeds"


def fleet(start, name, moment, deaths):
    """No reply may be lost, be duplicated, or come from another vehicle. A fault must not affect
    programs that do not depend on the failed part. A ground station with the address and key of the
    first one takes over all vehicles until it ends; after that the first ground station reaches
    them again."""
    trouble, least, most = TROUBLE[name]
    # at this time all vehicles have sessions, also with the second ground station
    begin = 7 + moment
    end = begin + least + (most - least) * moment / LAST
    m = start(words=lambda m: words_of(m, IMAGE, name, begin, end))
    expect(m.wait(5 * LONGEST) == 0, m, "a vehicle does not answer at the end, or it hangs")
    result = json.loads(Path(m.out, "fleet.json").read_text())
    cores = re.search("vision cores were started ([0-9, ]+) times", m.text())[1].split(", ")
    away, isLong = int(trouble[-1]) if trouble.startswith("away") else None, least > 9
    for address in range(1, VEHICLES + 1):
        t, ran = result[str(address)], int(cores[address - 1])
        expect(not t["wrong"], m, f"vehicle {address}: the result is of another picture")
        expect(t["answered"] <= ran <= t["started"], m, f"vehicle {address}: {t}, and {ran} frames")
        expect(bool(t["reported"]) == (isLong and away in (None, address)), m,
               f"vehicle {address}: {t}")
    seen = {at for at, second in result["seen"] if away != 0 or begin <= second < end}
    expect(seen == set(range(1, VEHICLES + 1)), m, f"the other ground saw only {seen}")
    sessions = m.text().count("link up, secure")
    expect(trouble or sessions == 3 * VEHICLES, m, f"{sessions} sessions: the grounds compete")
    return "%d frames started, %d calls reported" % tuple(
        sum(count) for count in zip(*((t["started"], len(t["reported"]))
                                      for at, t in result.items() if at != "seen")))


FAULTS = [(killed, n) for n in ("ground", "simulator", "run", "page")] + \
         [(killed_early, n) for n in ("page", "page's trial")] + \
         [(stopped, n) for n in ("ground", "simulator", "page")] + \
         [(f, "") for f in (disk_full, no_descriptors, no_memory, clock_step, port_taken)] + \
         [(loss, n) for n in ("0.9", "1")] + [(fleet, n) for n in TROUBLE]


def undergo(args, fault, name, seed, number, moment):
    """Applies one fault at one moment. Returns true if the consequences for the mission were those
    in the table."""
    title = (fault.__name__ + " " + name).strip()
    missions = []

    def start(prefix=(), options=(), words=None):
        out = f"{args.out}/{seed}-{title.replace(' ', '-')}-{number}"
        missions.append(Mission(args.source, args.build, out, prefix, options, words))
        return missions[-1]

    try:
        said = fault(start, name, moment, args.deaths)
    except Fault as e:
        said = "FAILED: %s" % e
    finally:
        for m in missions:
            m.kill()
    print("%4d %-20s at %.2f: %s" % (seed, title, moment, said), flush=True)
    if said.startswith("FAILED"):
        return False
    for m in missions:
        m.remove()
    return True


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    for name in "source", "build", "out":
        parser.add_argument(name)
    parser.add_argument("--seed", type=int, default=1, help="the first")
    parser.add_argument("--seeds", type=int, default=1, help="number of seeds")
    parser.add_argument("--moments", type=int, default=1, help="moments per fault and seed")
    parser.add_argument("--jobs", type=int, default=1, help="missions at a time")
    parser.add_argument("--deaths", type=float, default=LONGEST,
                        help="seconds in which all processes of a mission follow the first")
    parser.add_argument("--only", default="", help="only faults with this text in the name")
    args = parser.parse_args()
    global CLOCK_STEP
    CLOCK_STEP = os.path.abspath(args.build) + "/tests/e2e/mission/libclock_step.so"
    faults = [(fault, name, args.only in fault.__name__ + " " + name) for fault, name in FAULTS]
    if not any(chosen for _, _, chosen in faults):
        names = ", ".join(sorted({fault.__name__ for fault, _ in FAULTS}))
        sys.exit(f"faults: none is called {args.only}; there are {names}")
    shutil.rmtree(args.out, ignore_errors=True)
    os.makedirs(args.out)
    may_mount = subprocess.run(["unshare", "--map-root-user", "--mount", "true"],
                               stderr=subprocess.DEVNULL).returncode == 0
    if not may_mount:
        print("faults: disk_full is left out: this machine lets its users mount nothing "
              "(unshare --map-root-user)")
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        runs = []
        for seed in range(args.seed, args.seed + args.seeds):
            draw = random.Random(seed)
            for fault, name, chosen in faults:
                moments = [draw.uniform(0, LAST) for _ in range(args.moments)]
                if chosen and (may_mount or fault is not disk_full):
                    runs += [pool.submit(undergo, args, fault, name, seed, number, moment)
                             for number, moment in enumerate(moments)]
        failed = sum(not run.result() for run in runs)
    if not runs:
        return 77
    print("faults: %d moments of seeds %d to %d, %d failed" %
          (len(runs), args.seed, args.seed + args.seeds - 1, failed))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
