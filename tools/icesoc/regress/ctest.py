# SPDX-License-Identifier: MIT
"""ctest: runs CTest with the given arguments.

`--output-junit FILE` leaves the results in FILE, for CI systems. At the end, ctest.py prints the
notes of tests that passed (lines that begin with `note: `), each skipped test with the reason, and
each failed test with the reason. The failed tests come last, because a CI system or a terminal may
keep only the end of the output.
After Ctrl-C, TERM or HUP it ends the tests, and FILE contains the tests that have finished.
"""

import contextlib
import datetime
import pathlib
import re
import subprocess
import sys
import tempfile
import time

from icesoc.regress.failures import reason_of
from icesoc.regress.junit import ended, finished, read_junit, write_junit
from icesoc.util.errors import Interrupted
from icesoc.util.process import (adopt_orphans, end_descendants, hear_signals, reading, start,
                                 wait, wait_for)


# A run of more tests prints no notes: they are about a core that a user is working on.
MOST_WITH_NOTES = 50


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


def run(words, results):
    """Runs CTest. Returns its exit status, and whether it was stopped."""
    ends, total = {}, 0

    def hear(line):
        nonlocal total
        if end := ended(line):
            name, outcome, seconds, total = end
            ends[name] = outcome, seconds
        with contextlib.suppress(OSError):  # the terminal is gone
            print(line, end="", flush=True)
    # CTest gets a separate process group. Otherwise Ctrl-C would reach the tests, and CTest would
    # report them as failed.
    program = start(["ctest", "--test-output-size-passed", "100000", *words], process_group=0,
                    stdout=subprocess.PIPE, text=True, errors="replace")
    output_ended = reading(program, hear)
    try:
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
    write_finished(words[words.index("--test-dir") + 1], results, ends, total)
    return status, True


def print_summary(results, stopped):
    """Prints the notes of passed tests, then the skipped and the failed tests with their reasons.
    If the run was stopped, write_finished has already printed the names of the failed tests."""
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
                print(f"    {result.name}: {reason(result.log) or 'no output'}")


def main():
    hear_signals()
    with tempfile.TemporaryDirectory() as folder:
        words = sys.argv[1:]
        if "--output-junit" not in words:
            words += ["--output-junit", f"{folder}/results.xml"]
        path = pathlib.Path(words[words.index("--output-junit") + 1]).resolve()
        path.unlink(missing_ok=True)
        status, stopped = run(words, path)
        results = read_junit(path) if path.exists() else []
    print_summary(results, stopped)
    return status


if __name__ == "__main__":
    sys.exit(main())
