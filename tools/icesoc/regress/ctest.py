# SPDX-License-Identifier: MIT
"""ctest: runs CTest with the given arguments.

`--output-junit FILE` leaves the results in FILE, for CI systems. At the end, ctest.py prints the
notes of tests that passed (lines that begin with `note: `), each skipped test with the reason, and
each failed test with the reason. The failed tests come last, because a CI system or a terminal may
keep only the end of the output.
After Ctrl-C, TERM or HUP it ends the tests, and FILE contains the tests that have finished.
`--end-hangs` ends a test that hangs, as a regression does, and prints its stacks.
"""

import contextlib
import datetime
import pathlib
import re
import subprocess
import sys
import tempfile
import textwrap
import threading
import time

from icesoc.regress.execution import Progress
from icesoc.regress.failures import reason_of
from icesoc.regress.history import History
from icesoc.regress.junit import begun, ended, finished, read_junit, write_junit
from icesoc.util.errors import Interrupted
from icesoc.util.process import (adopt_orphans, end_descendants, hear_signals, reading, start,
                                 wait, wait_for)


FAILED = 8  # CTest's exit status if a test has failed
# A run of more tests prints no notes: they are about a core that a user is working on.
MOST_WITH_NOTES = 50


class Watch(Progress):
    """Ends tests that hang. CTest prints the progress."""

    def __init__(self, history):
        super().__init__([], history, 1)
        self.history = history

    def start(self, name):
        self.usual[name] = self.history.usual(name)
        super().start(name)

    def end(self, name, status, seconds):
        self.running.pop(name, None)

    def _show(self, keep):
        pass


@contextlib.contextmanager
def watching(watch, build):
    """Watches the tests of a build folder in a thread. Without `watch`, does nothing."""
    done = threading.Event()
    thread = threading.Thread(target=watch.watch, args=[done, build], daemon=True) \
        if watch else None
    if thread:
        thread.start()
    yield
    done.set()
    if thread:
        thread.join()


def reason_for_skipping(text):
    """Returns the text of GTEST_SKIP, or the last output line of a script that ended with 77."""
    said = re.search(r": Skipped\n(.+)", text)
    lines = [line for line in text.splitlines() if line.strip()]
    return said[1] if said else lines[-1] if lines else "no reason was printed"


def write_finished(folder, results, ends, total):
    """Writes JUnit of the finished tests of a run that was stopped, and prints how many."""
    cases = finished(folder, ends)
    now = datetime.datetime.now().astimezone().isoformat(timespec="seconds")
    # CTest prints the total with the first test that ends
    stopped = f"after {len(cases)} of {total}" if total else "before a test had ended"
    write_junit(results, cases, now, lambda result: ("", ""), stopped=stopped)
    failed = [case.name for case in cases if case.status == "failed"]
    passed = sum(case.status == "passed" for case in cases)
    print(f"\nstopped {stopped}: {passed} passed, {len(failed)} failed"
          + f": {' '.join(failed)}" * bool(failed), flush=True)


def run(words, results, watch=None):
    """Runs CTest. Returns its exit status, and whether it was stopped. watch: Watch that ends
    tests that hang, or None."""
    ends, total = {}, 0
    build = words[words.index("--test-dir") + 1]

    def hear(line):
        nonlocal total
        if watch and (name := begun(line)):
            watch.start(name)
        if end := ended(line):
            name, outcome, seconds, total = end
            ends[name] = outcome, seconds
            if watch:
                watch.end(name, outcome, seconds)
        with contextlib.suppress(OSError):  # the terminal is gone
            print(line, end="", flush=True)
    # CTest gets a separate process group. Otherwise Ctrl-C would reach the tests, and CTest would
    # report them as failed.
    program = start(["ctest", "--test-output-size-passed", "100000", *words], process_group=0,
                    stdout=subprocess.PIPE, text=True, errors="replace")
    output_ended = reading(program, hear)
    try:
        with watching(watch, str(pathlib.Path(build).resolve())):
            wait_for(output_ended)
        status = wait(program)
        if results.exists() or status < 128:
            return status, False
    except Interrupted as stop:
        time.sleep(0.1)  # gives CTest time to log the test that has just ended
        adopt_orphans()
        program.kill()
        program.wait()
        end_descendants()
        wait_for(output_ended)
        status = stop.status
    # CTest was stopped, by us or by a signal, before it wrote its JUnit file, which it does only
    # when it ends.
    write_finished(build, results, ends, total)
    return status, True


def fail(results, hangs, path, status):
    """Marks the tests that hung as failed, also in the JUnit file. Returns the exit status. A
    script may report success although its program hung and was ended."""
    for result in results:
        if result.name in hangs:
            result.status, (result.end, stacks) = "failed", hangs[result.name]
            result.log += stacks
    now = datetime.datetime.now().astimezone().isoformat(timespec="seconds")
    write_junit(path, results, now, lambda result: (result.end or reason_of(result.log), ""))
    return status or FAILED


def print_summary(results, stopped, hangs):
    """Prints the notes of passed tests, then the skipped and the failed tests with their reasons,
    and the stacks of tests that hung. hangs: name -> (reason, stacks). If the run was stopped,
    write_finished has already printed the names of the failed tests."""
    if len(results) <= MOST_WITH_NOTES:
        for result in results:
            if result.status == "passed":
                for note in re.findall("^note: (.*)", result.log, re.M):
                    print(f"{result.name}: {note}")
    for status, reason in ("skipped", reason_for_skipping), ("failed", reason_of):
        chosen = [result for result in results if result.status == status]
        if chosen and not (stopped and status == "skipped"):
            print(f"\n{status.capitalize()}, {len(chosen)}:")
            for result in chosen:
                why, stacks = hangs.get(result.name, (reason(result.log) or "no output", ""))
                print(f"    {result.name}: {why}")
                print(textwrap.indent(stacks, "        "), end="")


def main():
    hear_signals()
    with tempfile.TemporaryDirectory() as folder:
        words = [word for word in sys.argv[1:] if word != "--end-hangs"]
        watch = Watch(History(costs=pathlib.Path("tests/costs.txt"))) \
            if "--end-hangs" in sys.argv else None
        if "--output-junit" not in words:
            words += ["--output-junit", f"{folder}/results.xml"]
        path = pathlib.Path(words[words.index("--output-junit") + 1]).resolve()
        path.unlink(missing_ok=True)
        status, stopped = run(words, path, watch)
        results = read_junit(path) if path.exists() else []
        if watch and watch.hangs:
            status = fail(results, watch.hangs, path, status)
    print_summary(results, stopped, watch.hangs if watch else {})
    return status


if __name__ == "__main__":
    sys.exit(main())
