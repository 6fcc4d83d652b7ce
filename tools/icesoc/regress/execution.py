# SPDX-License-Identifier: MIT
"""execution: runs selected tests with CTest, prints the progress, and ends hangs."""
import contextlib
import functools
import os
import pathlib
import re
import signal
import threading
import time

from icesoc.regress.junit import begun, ended, finished, logs, read_junit, status_of
from icesoc.regress.tests import write_numbers
from icesoc.util.errors import Interrupted, Stop
from icesoc.util.process import children, collect, descendants, end_descendants
from icesoc.util.progress import Line, clock, is_tenth

# s; a test may be ended only after this CPU time, or after this time without using the CPU
SHORTEST_HANG = 30
IDLE = 10  # s; a test that uses less than 1 s of CPU time within this period counts as idle


class Progress:
    """Prints the progress: on a terminal in one line that is rewritten, otherwise after each tenth.
    Prints failures immediately."""

    def __init__(self, tests, history, jobs):
        self.jobs, self.total, self.done, self.failed = jobs, len(tests), 0, 0
        self.seconds = {test.name: history.seconds(test.name) for test in tests}
        self.usual = {test.name: history.usual(test.name) for test in tests}
        self.running = {}  # name -> start time, oldest first
        self.due = {}  # name -> age in s at which the test is next reported as late
        # name -> (CPU time, time at which this CPU time was reached); updated after each second of
        # CPU time
        self.busy = {}
        self.hangs = {}  # name -> (reason why the test was ended, stacks)
        self.line = Line()

    def start(self, name):
        usual = self.usual.get(name)
        self.running[name] = time.monotonic()
        self.due[name] = 60 if usual is None else max(10, 3 * usual)

    def watch(self, done, build):
        """Watches the running tests until `done` is set. If a test takes three times its usual time
        (or 60 s if this time is unknown), prints its name and age, and prints them again whenever
        the age has doubled. Ends tests that hang."""
        def cpu_of(name):
            return cpu_time(process_of(name, self.running))
        while not done.wait(1):
            self._show(keep=False)
            for name, how in self.late(cpu_of):
                with contextlib.suppress(*GONE):
                    if process := process_of(name, self.running):
                        where, stacks = end_hang(process, build)
                        self.hangs[name] = f"Hang, ended after {how}{where}", stacks

    def late(self, cpu_of):
        """Prints the names of late tests, and yields (name, reason) for each test that hangs. A
        test hangs if its CPU time reaches ten times its usual time, or if it has run for that long
        and no longer uses the CPU. A test that waits for a CPU does not hang. `cpu_of`: function
        that returns the CPU time of a running test, given its name."""
        for name, begin in list(self.running.items()):
            now, usual = time.monotonic(), self.usual.get(name)
            age, known = now - begin, "unknown" if usual is None else f"{usual:.1f} s"
            if age >= self.due[name]:
                self.due[name] = 2 * age
                self.line.show(f"{name} has run for {age:.0f} s, usually {known}", True)
            limit = self.limit(name)
            is_proof = name.startswith("formal.")  # a proof has a limit of CPU time instead
            if age < limit or is_proof or name in self.hangs:
                continue
            try:
                used = cpu_of(name)
            except GONE:
                continue
            if used >= limit:
                yield name, f"{used:.0f} s of CPU time, usually {known}"
            before = self.busy.get(name)
            if not before or used >= before[0] + 1:
                self.busy[name] = used, now
            elif used < limit and now - before[1] >= IDLE:
                yield name, f"{age:.0f} s without using the CPU, usually {known}"

    def limit(self, name):
        """Returns the CPU time, or time without using the CPU, after which a test counts as
        hanging, s."""
        usual = self.usual.get(name)
        return max(SHORTEST_HANG, 10 * (60 if usual is None else usual))

    def left(self):
        """Returns the estimated time left as text. If a test is late, returns the longest time
        until a late test is ended. If the times of some tests are unknown, returns the number of
        tests left."""
        late = {name: time.monotonic() - begin for name, begin in list(self.running.items())
                if time.monotonic() - begin >= max(10, 3 * (self.usual.get(name) or 20))}
        known = all(each is not None for each in self.seconds.values())
        if late:
            seconds = int(max(self.limit(name) - age for name, age in late.items()))
            return f"at most {clock(max(0, seconds))}"
        seconds = int(sum(self.seconds.values()) / self.jobs) if known else 0
        return clock(seconds) if known else self.total - self.done

    def end(self, name, status, seconds):
        self.running.pop(name, None)
        self.seconds.pop(name, None)
        self.done += 1
        if status == "failed":
            self.failed += 1
            self.line.show(f"FAILED {name} ({seconds:.1f} s)", True)
        self._show(is_tenth(self.done, self.total) and not self.line.moves)

    def _show(self, keep):
        self.line.show(f"{self.done} of {self.total}, {self.failed} failed, {self.left()} left: "
                       f"{' '.join(sorted(self.running))}", keep)


# exceptions that mean that a test has just ended and its processes no longer exist
GONE = (OSError, StopIteration, ValueError)


def cpu_time(process):
    """Returns the CPU time of a process, its ended children and all its descendants, s."""
    ticks = 0
    for pid in [process, *descendants(process)] if process else ():
        with contextlib.suppress(OSError):
            fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
            ticks += sum(map(int, fields[11:15]))
    return ticks / os.sysconf("SC_CLK_TCK")


def process_of(name, running):
    """Returns the process of a running test, or 0 if it is unknown. CTest prints the tests in the
    order in which it starts them, so the position in `running` identifies the process."""
    ctest = next(pid for pid in children(os.getpid())
                 if pathlib.Path(f"/proc/{pid}/comm").read_text() == "ctest\n")
    processes = children(ctest)
    return processes[list(running).index(name)] if len(processes) == len(running) else 0


def cpu_ticks(pid, thread):
    try:
        fields = pathlib.Path(f"/proc/{pid}/task/{thread}/stat").read_text().rpartition(")")[2]
        return sum(map(int, fields.split()[11:13]))
    except GONE:
        return 0


def stacks_of(text, ticks):
    """Returns GDB's stacks of a program, a list of lines for each thread. The thread that has used
    the most CPU time comes first; if no thread has used any, the first thread. ticks: function that
    returns the CPU time of a thread."""
    threads = re.split(r"(?m)^(?=Thread \d+ \()", text)[1:]

    def order(thread):
        number, process = re.match(r"Thread (\d+) \((?:.*?LWP (\d+))?", thread).groups()
        return -ticks(process), int(number)
    return [re.findall(r"(?m)^(?:#|Thread ).*", thread) for thread in sorted(threads, key=order)]


def function_of(frame):
    """Returns the name of the function in a line of GDB's stack, without its types."""
    name = re.sub(r"^#\d+ +(0x\w+ in )?", "", frame).replace("(anonymous namespace)::", "")
    while (plain := re.sub(r"<[^<>]*>", "", name)) != name:
        name = plain
    return (name.partition("(")[0].split() or [""])[-1]


def end_hang(process, build):
    """Ends a test's processes. Returns the functions that the first of its programs was executing,
    and the stacks of all programs. The programs are aborted, so that they print the chip's state
    (testbench/common/tell_on_abort.h)."""
    below = [process, *descendants(process)]
    stacks, names = "", []
    for pid in below:
        # ending an earlier process may also have ended this one
        with contextlib.suppress(OSError):
            program = os.readlink(f"/proc/{pid}/exe")
            if not program.startswith(f"{build}/"):
                continue
            text = collect(["timeout", 60, "gdb-multiarch", "-nx", "-batch", "-p", pid, "-ex",
                        "thread apply all backtrace 40"])[1]
            threads = stacks_of(text, functools.partial(cpu_ticks, pid))
            frames = sum(threads, []) or text.splitlines()[-1:]
            names = names or [*map(function_of, threads[0][1:] if threads else [])]
            stacks += "\n".join([f"Stack of {os.path.basename(program)}:", *frames, ""])
            os.kill(pid, signal.SIGABRT)
            time.sleep(1)
    for pid in below:
        with contextlib.suppress(OSError):
            os.kill(pid, signal.SIGKILL)
    # the functions of GoogleTest say nothing about the test
    names = [name for name in names if name.strip("?") and not name.startswith("testing::")][:3]
    return ", in " * bool(names) + ", called by ".join(names), stacks


def readable(log):
    """Returns a log without colours (CTest replaces ESC by a word) and with long lines
    shortened."""
    def short(line):
        return line if len(line) <= 2000 else \
            f"{line[:1000]} ... {len(line)} characters ... {line[-500:]}"
    log = re.sub(r"\[NON-XML-CHAR-0x1B\]\[[0-9;]*m", "", log)
    return "".join(short(line) + "\n" for line in log.splitlines())


def run_tests(tests, build, out, seed, jobs, history):
    """Runs tests in parallel; tests that failed last time start first. Returns the results, and the
    signal that interrupted the tests, or None. After a signal, only finished tests have results."""
    chosen, junit = out / "tests.list", (out / f"junit-{seed}.xml").resolve()
    write_numbers(chosen, tests)
    junit.unlink(missing_ok=True)
    progress, ends, interrupted = Progress(tests, history, jobs), {}, None
    print(f"{len(tests)} tests, SEED={seed}", flush=True)

    def on_line(line):
        if name := begun(line):
            progress.start(name)
        if end := ended(line):
            name, outcome, seconds, _ = end
            ends[name] = outcome, seconds
            progress.end(name, status_of(outcome), seconds)

    def wait_for_log():
        """Waits until CTest has logged the test that has just ended."""
        for _ in range(40):
            if ends.keys() <= logs(build).keys():
                break
            time.sleep(0.05)
    done = threading.Event()
    watcher = threading.Thread(target=progress.watch, args=[done, str(build)], daemon=True)
    watcher.start()
    try:
        # CTest gets a separate process group. Otherwise Ctrl-C would reach the tests, and CTest
        # would report them as failed.
        status, text = collect(
            ["ctest", "--test-dir", build, "-I", chosen.resolve(), "-j", jobs, "--output-junit",
             junit, "--test-output-size-passed", 4096, "--test-output-size-failed", 200000,
             "--test-output-truncation", "middle"], {"SEED": seed}, on_line, wait_for_log,
            process_group=0)
    except Interrupted as stop:
        interrupted = stop
        end_descendants()
    finally:
        done.set()
        watcher.join()  # the watcher may still be reading the stacks of a test that hangs
    progress.line.clear()
    if interrupted:
        results = finished(build, ends)
    elif junit.exists():
        results = read_junit(junit)
    else:
        raise Stop(f"ctest gave no results ({status}):\n{text}")
    for result in results:
        result.log, result.seed = readable(result.log), seed
        if result.log.startswith("Unable to find"):  # its program
            result.status = "failed"
        end = ends.get(result.name, ("",))[0]
        result.end = "" if end in ("***Failed", "***Not Run") else \
            re.sub("[*]{3}(Exception: *)?", "", end)
        if result.name in progress.hangs:
            result.end, stacks = progress.hangs[result.name]
            result.status, result.log = "failed", result.log + stacks
    return results, interrupted
