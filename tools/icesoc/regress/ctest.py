# SPDX-License-Identifier: MIT
"""ctest: runs CTest with the given arguments.

`--output-junit FILE` leaves the results in FILE, for CI systems. At the end, ctest.py prints the
notes of tests that passed (lines that begin with `note: `), and each skipped test with the reason.
After Ctrl-C, TERM or HUP it ends the tests, and FILE contains the tests that have finished.
"""

import pathlib
import re
import sys
import tempfile
import time
import xml.etree.ElementTree as xml

from icesoc.util.errors import Interrupted
from icesoc.util.process import adopt_orphans, end_descendants, hear_signals, start


def reason(text):
    """Returns the text of GTEST_SKIP, or the last output line of a script that ended with 77."""
    said = re.search(r": Skipped\n(.+)", text)
    lines = [line for line in text.splitlines() if line.strip()]
    return said[1] if said else lines[-1] if lines else "it does not say why"


def finished(folder):
    """Returns the tests in the log that CTest writes while it runs: name, JUnit's status, log; and
    the number of tests of the run."""
    logs = pathlib.Path(folder) / "Testing/Temporary"
    path = next((path for name in ("LastTest.log.tmp", "LastTest.log")
                 if (path := logs / name).exists()), None)
    log = path.read_text(errors="replace") if path else ""
    ends = {"Passed": "run", "Failed": "fail"}
    cases = re.findall(r'^"(\S+)" start time: .*?^Output:\n-+\n(.*?)^<end of output>\nTest time = '
                       r" *([\d.]+) sec\n-+\nTest (\w+)\.", log, re.M | re.S)
    total = re.search(r"^\d+/(\d+) Testing: ", log, re.M)
    return ([(name, ends.get(end, "notrun"), seconds, text) for name, text, seconds, end in cases],
            int(total[1]) if total else 0)


def write_finished(folder, results):
    """Writes JUnit of the finished tests of a run that was stopped, and prints how many."""
    cases, total = finished(folder)
    root = xml.Element("testsuite", name="stopped", tests=str(len(cases)))
    for name, status, seconds, text in cases:
        case = xml.SubElement(root, "testcase", name=name, classname=name, time=seconds,
                              status=status)
        if status == "fail":
            xml.SubElement(case, "failure", message="")
        elif status == "notrun":
            xml.SubElement(case, "skipped", message="")
        xml.SubElement(case, "system-out").text = re.sub(r"[^\t\n\x20-\uFFFD]", "?", text)
    xml.ElementTree(root).write(results)
    failed = [name for name, status, _, _ in cases if status == "fail"]
    passed = sum(status == "run" for _, status, _, _ in cases)
    print(f"\nstopped after {len(cases)} of {total}: {passed} passed, {len(failed)} failed"
          + f": {' '.join(failed)}" * bool(failed), flush=True)


def main():
    hear_signals()
    stopped = None
    with tempfile.TemporaryDirectory() as folder:
        words = sys.argv[1:]
        if "--output-junit" not in words:
            words += ["--output-junit", f"{folder}/results.xml"]
        results = pathlib.Path(words[words.index("--output-junit") + 1]).resolve()
        results.unlink(missing_ok=True)
        # In a process group of its own: Ctrl-C would reach the tests, which CTest then reports as
        # failed.
        program = start(["ctest", "--test-output-size-passed", "100000", *words], process_group=0)
        try:
            status = program.wait()
        except Interrupted as stop:
            stopped, status = stop, stop.status
            time.sleep(0.1)  # until CTest has logged the test that has just ended
            adopt_orphans()
            program.kill()
            program.wait()
            end_descendants()
            write_finished(words[words.index("--test-dir") + 1], results)
        cases = list(xml.parse(results).iter("testcase")) if results.exists() else []
    for case in [case for case in cases if case.get("status") == "run"]:
        for note in re.findall("^note: (.*)", case.findtext("system-out") or "", re.M):
            print(f"{case.get('name')}: {note}")
    skipped = [case for case in cases if case.find("skipped") is not None]
    if skipped and not stopped:
        print(f"\nSkipped, {len(skipped)}:")
    for case in skipped:
        print(f"    {case.get('name')}: {reason(case.findtext('system-out') or '')}")
    return status


if __name__ == "__main__":
    sys.exit(main())
