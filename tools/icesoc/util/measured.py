# SPDX-License-Identifier: MIT
"""measured: reads the measurements that benches, coverage, synthesis and builds of the firmware
write as JSON.

A file is a list of entries, or an object, which usually has this list in "entries". An entry has
name, value and unit. It may also have limit and share (value / limit), gross (value / a limit that
includes overhead), or peer and ratio (value / the figure of another system). The files of `make
synth` also have the state of each design in "states", such as NOW.
"""
import json
import pathlib

from icesoc.util.errors import Stop

NOW = "measured now"  # state of a design with figures of the current sources


def read(path):
    """Returns the content of a file as an object."""
    try:
        content = json.loads(pathlib.Path(path).read_text())
    except (OSError, ValueError) as error:
        raise Stop(f"{path}: " + (getattr(error, "strerror", None) or f"expected JSON: {error}")
                   ) from None
    return content if isinstance(content, dict) else {"entries": content}
