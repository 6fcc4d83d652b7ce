# SPDX-License-Identifier: MIT
"""ctest: runs CTest with the given arguments.

`--output-junit FILE` leaves the results in FILE, for CI systems. At the end, ctest.py prints the
notes of tests that passed (lines that begin with `note: `), and each skipped test with the reason.
"""

import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml


def reason(text):
    """Returns the text of GTEST_SKIP, or the last output line of a script that ended with 77."""
    said = re.search(r": Skipped\n(.+)", text)
    lines = [line for line in text.splitlines() if line.strip()]
    return said[1] if said else lines[-1] if lines else "it does not say why"


def main():
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # CTest ends on SIGINT and reports the interrupt
                                                  # itself
    with tempfile.TemporaryDirectory() as folder:
        words = sys.argv[1:]
        if "--output-junit" not in words:
            words += ["--output-junit", f"{folder}/results.xml"]
        results = pathlib.Path(words[words.index("--output-junit") + 1]).resolve()
        results.unlink(missing_ok=True)
        status = subprocess.call(
            ["setpriv", "--pdeathsig", "TERM", "ctest", "--test-output-size-passed", "100000",
             *words],
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
        cases = list(xml.parse(results).iter("testcase")) if results.exists() else []
    for case in [case for case in cases if case.get("status") == "run"]:
        for note in re.findall("^note: (.*)", case.findtext("system-out") or "", re.M):
            print(f"{case.get('name')}: {note}")
    skipped = [case for case in cases if case.find("skipped") is not None]
    if skipped:
        print(f"\nSkipped, {len(skipped)}:")
    for case in skipped:
        print(f"    {case.get('name')}: {reason(case.findtext('system-out') or '')}")
    return status


if __name__ == "__main__":
    sys.exit(main())
