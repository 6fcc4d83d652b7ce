# SPDX-License-Identifier: MIT
"""rooms: lists the source folders of the tree, from cmake/rooms.txt."""
from icesoc import TREE


def _read():
    """Yields the name and the groups of each room, in the order of the file."""
    for line in (TREE / "cmake/rooms.txt").read_text().splitlines():
        name, *groups = line.split()
        if name != "#":
            yield name, groups


ROOMS = tuple(name for name, _ in _read())


def rooms(group):
    """Returns the names of the rooms of a group."""
    return tuple(name for name, groups in _read() if group in groups)


PLATFORM, RTL = sorted(rooms("platform")), sorted(rooms("rtl"))
# folders whose changes make measurements (coverage, mutants, benches) out of date
MEASURED = " ".join((*rooms("measured"), "tools"))
