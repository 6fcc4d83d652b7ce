# SPDX-License-Identifier: MIT
"""rooms: the folders of the tree that CMake configures, and the groups that they belong to.

`python -m icesoc.util.rooms` prints all rooms in the order in which CMake configures them; a room
reads properties of earlier ones. With the name of a group, it prints the rooms of this group.
CMakeLists.txt reads this output.

Groups:
  platform  RTL of the platform
  rtl       RTL
  core      needed by the block test of a core
  program   needed by the programs and their tests
  measured  changes the results of tests, coverage, mutants and benches
"""
import sys

_GROUPS = {
    "bus": "platform rtl core program measured",
    "slice": "core program measured",
    "ip": "rtl core program measured",
    "sw": "core program measured",
    "hdl": "platform rtl core program measured",
    "testbench": "core program measured",
    "tests": "program measured",
    "synth": "",
    "docs": "",
}

ROOMS = tuple(_GROUPS)


def rooms(group):
    """Returns the names of the rooms of a group."""
    return tuple(name for name in ROOMS if group in _GROUPS[name].split())


PLATFORM, RTL = sorted(rooms("platform")), sorted(rooms("rtl"))
# folders whose changes make measurements (coverage, mutants, benches) out of date
MEASURED = " ".join((*rooms("measured"), "tools"))

if __name__ == "__main__":
    print(";".join(rooms(sys.argv[1]) if sys.argv[1:] else ROOMS), end="")
