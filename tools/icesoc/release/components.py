# SPDX-License-Identifier: MIT
"""components: the parts of the firmware that other projects can use without this source tree. A
test compares the list with the layers of the build."""
from dataclasses import dataclass, field
from pathlib import Path

from icesoc import TREE
from icesoc.util.errors import Stop

LIST = "tools/icesoc/release/components.py"
# folders of headers that every component may include; each component gets a copy of these headers
SHARED = ["sw/base"]


@dataclass(frozen=True)
class Component:
    """A component. Paths are relative to the tree."""
    name: str
    title: str  # one line, for lists of packages
    # C files, in the order in which they are joined into one file; a pattern adds its files in the
    # order of their names
    sources: list[str]
    # headers for programs; the headers that they include are added automatically
    headers: list[str]
    folders: list[str]  # folders that are searched for included headers
    needs: list[str] = field(default_factory=list)  # other components, whose headers it includes
    # register descriptions; the component includes their generated C headers
    registers: list[str] = field(default_factory=list)
    # names of headers that generated code includes; each becomes a file with one line, which
    # includes the component's header
    forwards: list[str] = field(default_factory=list)
    host: bool = False  # needs a POSIX system

    def files(self, tree=TREE):
        """Returns the paths of the C files."""
        found = []
        for pattern in self.sources:
            paths = sorted(Path(tree).glob(pattern))
            if not paths:
                raise Stop(f"{LIST}: {self.name}: expected files at {pattern}, found none")
            found += [str(path.relative_to(tree)) for path in paths]
        return found


# The components by name. Each comes after the components that it needs.
COMPONENTS = {its.name: its for its in (
    Component(
        "icec", "IceC: servants and proxies of ZeroC Ice 3.7 in C90",
        sources=["sw/icec/*.c", "sw/icec/values/*.c", "sw/icec/extra/*.c"],
        headers=["sw/icec/icec.h", "sw/icec/ice_operation.h", "sw/icec/ice_value.h"],
        folders=["sw/icec", "sw/icec/values"],
        forwards=["ice_operation.h", "ice_value.h"]),
    Component(
        "icec_tcp", "TCP transport of IceC for POSIX systems",
        needs=["icec"],
        sources=["sw/icec/endpoints/tcp_*.c"],
        headers=["sw/icec/endpoints/tcp_endpoint.h"],
        folders=["sw/icec/endpoints"],
        host=True),
    Component(
        "icec_link", "Reliable, encrypted messages over a lossy packet radio or a serial line",
        sources=["sw/crypto/*.c", "sw/link/*.c"],
        headers=["sw/link/link.h", "sw/link/link_broadcast.h"],
        folders=["sw/link", "sw/crypto"]),
    Component(
        "icec_radio", "Transport of IceC over the link layer (xbee-at)",
        needs=["icec", "icec_link"],
        sources=["sw/icec/endpoints/xbee_endpoint.c", "sw/icec/endpoints/xbee_peers.c"],
        headers=["sw/icec/endpoints/xbee_endpoint.h"],
        folders=["sw/icec/endpoints"]),
    Component(
        "icec_fsmc", "Driver of the STM32F2's FSMC for registers and memory in an FPGA",
        sources=["sw/fsmc/fsmc.c"],
        headers=["sw/fsmc/fsmc.h"],
        folders=["sw/fsmc"],
        registers=["bus/map.regs.json", "hdl/system/system.regs.json"]),
)}
