# SPDX-License-Identifier: MIT
"""mission_log: prints the steps of a mission, and stores them in the result folder."""

import contextlib
import glob
import json
import math
import mmap
import os
import threading
import time

import Ice

import places

RESULTS = ("after.png", "report.md", "report.json", "calls.jsonl")


class Air:
    """The simulator's counters (testbench/status/sim_status.toml). Real hardware has no such
    counters."""

    COUNTERS = ("ns", "cycles", "bytesUp", "bytesDown", "packets", "lost", "wallNs")

    def __init__(self, path):
        self.map = None
        if path:
            self.status = places.record_of("testbench/status/sim_status.toml")
            with open(path, "rb") as f:
                self.map = mmap.mmap(f.fileno(), self.status.size, access=mmap.ACCESS_READ)

    def read(self):
        return self.status.unpack(self.map, *self.COUNTERS) if self.map else None


class Patience:
    """A time-out in simulated time, or in real time without a simulator. It also expires if
    simulated time has not advanced for the same number of seconds of real time."""

    def __init__(self, air, seconds):
        self.air, self.seconds = air, seconds
        self.begin, self.last, self.moved = self.now(), self.now(), time.monotonic()

    def now(self):
        counters = self.air.read()
        return counters["ns"] / 1e9 if counters else time.monotonic()

    def is_over(self):
        now, real = self.now(), time.monotonic()
        if now != self.last:
            self.last, self.moved = now, real
        return now - self.begin > self.seconds or real - self.moved > self.seconds


@contextlib.contextmanager
def whole(path):
    """Yields a temporary file name; the file is renamed to `path` when it is complete."""
    temporary = path + ".new"
    try:
        yield temporary
        os.replace(temporary, path)
    except OSError as error:  # a failed write, for example on a full disk, has no file name
        error.filename = error.filename or path
        raise
    finally:
        with contextlib.suppress(FileNotFoundError):
            os.remove(temporary)


class Log:
    """Prints one line for each call, and stores rows for the report."""

    def __init__(self, air, out, build):
        # out: folder for the results; build: build folder
        self.air, self.out, self.build = air, out, build
        # time-out of a call, s; function that ends the mission
        self.patience, self.give_up = math.inf, None
        self.rows = []
        followers = glob.glob(os.path.join(glob.escape(out), "after[0-9]*.png"))
        # Removes the results of the previous mission. A result may be a symbolic link; then only
        # the link is removed.
        for path in [*(os.path.join(out, name) for name in RESULTS), *followers]:
            with contextlib.suppress(FileNotFoundError):
                os.remove(path)
        # the page of `make run` reads this file continuously
        self.live = open(os.path.join(out, "calls.jsonl"), "x")
        self.lock = threading.Lock()
        self.start = time.monotonic()

    def say(self, text):
        with self.lock:
            print("%7.3f s  %s" % (time.monotonic() - self.start, text), flush=True)

    def follow(self, row):
        with self.lock:
            self.live.write(json.dumps(dict(row, at=round(time.monotonic() - self.start, 3),
                                            ns=(self.air.read() or {}).get("ns"))) + "\n")
            self.live.flush()

    def note(self, text):
        """Prints a line that does not describe a call, and shows it on the page."""
        self.say(text)
        self.follow({"who": "ground", "what": text})

    def remind(self, what, answered):
        """Reports every 15 s that a call has no answer yet. Ends the mission when the time-out
        expires."""
        begin, reported = time.monotonic(), 15
        wait = Patience(self.air, self.patience)
        while not answered.wait(0.5):
            seconds = time.monotonic() - begin
            if seconds >= reported:
                reported += 15
                self.say("no reply to %s for %d s" % (what, seconds))
            if self.give_up and wait.is_over():
                return self.give_up()

    def call(self, who, what, function):
        """Calls `function`, which makes a call of the mission, and returns its result. Records the
        bytes that the call has sent over the air."""
        before, wall = self.air.read(), time.monotonic()
        answered = threading.Event()
        threading.Thread(target=self.remind, args=(what, answered), daemon=True).start()
        outcome = ""
        try:
            return function()
        except Ice.CommunicatorDestroyedException:  # give_up
            outcome = " has no reply"
            raise
        except Ice.Exception as e:
            outcome = " failed: " + type(e).__name__
            e.call = what  # mission.py prints it with the reason
            raise
        finally:
            answered.set()
            ms = (time.monotonic() - wall) * 1000
            after = self.air.read()
            row = {"who": who, "what": what + outcome, "wall_ms": round(ms, 1)}
            text = f"{who:<16} {what + outcome:<48} {ms:7.1f} ms"
            if before:
                row.update(simulated_ms=round((after["ns"] - before["ns"]) / 1e6, 1),
                           bytes_up=after["bytesUp"] - before["bytesUp"],
                           bytes_down=after["bytesDown"] - before["bytesDown"])
                text += (f" wall, {row['simulated_ms']:7.1f} ms simulated, {row['bytes_up']:4} "
                         f"bytes up, {row['bytes_down']:4} down")
            self.rows.append(row)
            self.follow(row)
            self.say(text)


def report(args, log, result, station, air):
    lines = ["# Mission report", "", f"Frame `{os.path.basename(args.frame)}`, threshold "
             f"{args.threshold}, loss on the air {args.loss}: {result.found} corners, "
             f"{result.cycles} cycles in the core.", "",
             "| who | call | wall ms | simulated ms | bytes up | bytes down |",
             "|---|---|---|---|---|---|"]
    for row in log.rows:
        cells = (row.get(name, "") for name in ("who", "what", "wall_ms", "simulated_ms",
                                                "bytes_up", "bytes_down"))
        lines.append(f"| {' | '.join(map(str, cells))} |")
    lines += ["", "| corner | x | y | score |", "|---|---|---|---|"]
    lines += [f"| {i} | {f.x} | {f.y} | {f.score} |" for i, f in enumerate(result.best, 1)]
    with whole(os.path.join(args.out, "report.md")) as temporary, open(temporary, "w") as f:
        f.write("\n".join(lines) + "\n")
    with whole(os.path.join(args.out, "report.json")) as temporary, open(temporary, "w") as f:
        json.dump({"calls": log.rows, "found": result.found, "cycles": result.cycles,
                   "vehicle": station.params, "air": air.read() or {}}, f, indent=2)
