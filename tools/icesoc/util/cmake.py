# SPDX-License-Identifier: MIT
"""cmake: reads the variables that CMake has stored in a build folder, and lists its tests."""
import json
import re
import tempfile
from pathlib import Path

from icesoc.util.process import collect


def cached(build, name):
    """Returns the value of a variable in CMake's cache; empty if it is not set."""
    try:
        text = Path(build, "CMakeCache.txt").read_text()
    except OSError:
        return ""
    found = re.search(rf"^{name}:\w+=(.*)$", text, re.M)
    return found[1] if found else ""


def cached_list(build, name):
    """Returns the words of a variable that contains a list."""
    return [word for word in cached(build, name).split(";") if word]


def shown_tests(build, *words):
    """Returns (exit status, output) of a CTest that only lists tests of a build folder. It runs in
    another folder, because it would overwrite the log of a CTest that runs in the build folder."""
    build, name = Path(build).resolve(), "CTestTestfile.cmake"
    if not (build / name).exists():
        return 1, f"{build / name} not found"
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, name).write_text(f"subdirs({json.dumps(str(build))})\n")
        return collect(["ctest", "--test-dir", folder, *words])
