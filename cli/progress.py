# SPDX-License-Identifier: MIT
"""progress: shows a build as one line that moves; the whole of it is in a file."""
import os
import re
import subprocess
import sys
import time

from cli.runner import Stop, end, say, start, wait

# Beginnings of lines in which CMake, ninja, Verilator and its makefiles report on themselves.
NOISE = ("ninja: Entering directory", "ninja: no work to do", "- Verilator: ", "- V e r i l a t",
         "Archive ar ", "-- GLOB", "-- Configuring", "-- Generating", "-- Build files")


class Line:
    """The line: on a terminal it is written anew, elsewhere each tenth of the steps gives one, but
    none in the first seconds: a build of nothing says nothing."""

    def __init__(self):
        self.begin, self.told, self.is_shown = time.monotonic(), 0, False
        self.moves = sys.stdout.isatty()

    def show(self, done, total, what):
        spent = time.monotonic() - self.begin
        text = f"[{done}/{total}]"
        if done > total / 20:
            left = round(spent * (total - done) / done)
            text += f" {left // 60}:{left % 60:02} left"
        if self.moves:
            width = os.get_terminal_size(sys.stdout.fileno()).columns or 80
            print("\r\033[K" + f"{text} {what}"[:width - 1], end="", flush=True)
            self.is_shown = True
        elif spent > 3 and done * 10 // total > self.told:
            self.told = done * 10 // total
            say(f"{text} {what}")

    def clear(self):
        if self.is_shown:
            print("\r\033[K", end="", flush=True)
        self.is_shown = False


def build(words, log, check=True, env=None):
    """Runs ninja. What it says beside its steps is printed; its whole output goes to a file. If it
    fails, the command ends, unless `check` is false."""
    line = Line()
    process = start(words, env={**(env or {}), "NINJA_STATUS": "[%f/%t] "}, text=True,
                    stdout=subprocess.PIPE, stderr=subprocess.STDOUT, errors="replace")
    try:
        with open(log, "w", buffering=1) as file, process.stdout as said:
            for text in said:
                file.write(text)
                step = re.match(r"\[(\d+)/(\d+)\] (.*)", text)
                if step:
                    line.show(int(step[1]), int(step[2]), step[3])
                elif not text.startswith(NOISE):
                    line.clear()
                    print(text, end="", flush=True)
    except BaseException:
        end(process)
        raise
    finally:
        line.clear()
    status = wait(process)
    if status and check:
        raise Stop(f"the build failed (above); all of it is in {log}", status)
    return status
