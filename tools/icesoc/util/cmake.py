# SPDX-License-Identifier: MIT
"""cmake: reads the variables that CMake has stored in a build folder."""
import re
from pathlib import Path


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
