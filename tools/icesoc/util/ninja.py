# SPDX-License-Identifier: MIT
"""ninja: runs ninja and shows its progress in one line."""
import re
import subprocess
import time
from pathlib import Path

from icesoc.util import ghdl
from icesoc.util.errors import Stop
from icesoc.util.process import end, start, wait
from icesoc.util.progress import Line, clock

# Beginnings of lines that are not shown: reports of CMake, ninja, Verilator and its makefiles about
# their own work.
NOISE = ("ninja: Entering directory", "ninja: no work to do", "- Verilator: ", "- V e r i l a t",
         "Archive ar ", "-- GLOB", "-- Configuring", "-- Generating", "-- Build files")


class Steps(Line):
    """The progress of a build. An output that is not a terminal gets a line for each tenth of the
    steps, but not in the first three seconds, so a short build prints nothing."""

    def __init__(self):
        super().__init__()
        self.begin, self.told = time.monotonic(), 0

    def step(self, done, total, what):
        spent = time.monotonic() - self.begin
        text = f"[{done}/{total}]"
        if done > total / 20:
            text += f" {clock(round(spent * (total - done) / done))} left"
        is_new = not self.moves and spent > 3 and done * 10 // total > self.told
        if is_new:
            self.told = done * 10 // total
        self.show(f"{text} {what}", is_new)


def in_vhdl(match):
    """Returns a location in Verilog. If GHDL has generated the line, the location in the VHDL
    follows in parentheses."""
    try:
        lines = Path(match[1]).read_text(errors="replace").splitlines()
    except OSError:
        return match[0]
    place = ghdl.is_converted(lines) and int(match[2]) <= len(lines) and ghdl.place_of_line(
        lines, int(match[2]))
    return f"{match[0]} ({place})" if place else match[0]


def explained(text):
    """Returns a line of a build's output, with additional source locations: in VHDL if the line is
    about generated Verilog, or of the list that names a missing file."""
    missing = re.match(r"ninja: error: '(\S+)', needed by .* missing and no known rule", text)
    if not missing:
        return re.sub(r"(\S+\.v):(\d+)(?=:)", in_vhdl, text)
    file = re.escape(Path(missing[1]).name)
    folders = [*Path(missing[1]).parents, *sorted(Path("ip").glob("*"))]
    for lists in (folder / name for folder in folders for name in ("CMakeLists.txt", "core.toml")):
        lines = lists.read_text().splitlines() if lists.is_file() else []
        for number, line in enumerate(lines, 1):
            if re.search(rf"(?<![\w.]){file}(?![\w.])", line):
                return f"{lists}:{number}: file {missing[1]} not found\n{text}"
    return text


def run_ninja(words, log, check=True, env=None):
    """Runs ninja. Prints the messages of the tools but not the steps; the whole output goes to the
    file `log`. If ninja fails, the command ends, unless `check` is false."""
    line = Steps()
    process = start(words, env={**(env or {}), "NINJA_STATUS": "[%f/%t] "}, text=True,
                    stdout=subprocess.PIPE, stderr=subprocess.STDOUT, errors="replace")
    try:
        with open(log, "w", buffering=1) as file, process.stdout as lines:
            for text in lines:
                file.write(text)
                step = re.match(r"\[(\d+)/(\d+)\] (.*)", text)
                if step:
                    line.step(int(step[1]), int(step[2]), step[3])
                elif not text.startswith(NOISE):
                    line.clear()
                    print(explained(text), end="", flush=True)
    except BaseException:
        end(process)
        raise
    finally:
        line.clear()
    status = wait(process)
    if status and check:
        raise Stop(f"the build failed (above); the whole output is in {log}", status)
    return status
