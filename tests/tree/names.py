#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""names: checks that the name of each test begins with its folder.

    names.py BUILD

The first word of a name must be one of the folders that the test is in: slice.check is in
tests/slice, formal.cdc_bit in tests/hdl/formal. The cases of a GoogleTest program begin with the
program, such as test_fir. Prints a line for each fault; the exit status is then 1.
"""
import sys
from pathlib import Path

from icesoc.regress.tests import list_tests


def wrong(tests):
    """Yields a line for each test whose name does not begin with one of its folders."""
    for test in tests:
        first = test.name.split(".")[0]
        if first not in test.path.split("/") and not first.startswith("test_"):
            yield f"{test.name}: expected a name that begins with a folder of {test.path}"


if __name__ == "__main__":
    lines = list(wrong(list_tests(Path(sys.argv[1]))))
    print(*lines, sep="\n", end="\n" if lines else "")
    sys.exit(bool(lines))
