# SPDX-License-Identifier: MIT
"""components: reads sw/components.toml, the list of the components that other firmware projects can
use."""
import dataclasses
import re
import tomllib
from pathlib import Path

from icesoc import TREE
from icesoc.util.errors import Stop

LIST = "sw/components.toml"
# folders of headers that every component may include; each component gets a copy of these headers
SHARED = ["sw/base"]


@dataclasses.dataclass
class Component:
    """A component. Paths are relative to the tree."""
    name: str
    title: str
    needs: list
    sources: list
    headers: list
    folders: list
    registers: list = dataclasses.field(default_factory=list)
    forwards: list = dataclasses.field(default_factory=list)
    host: bool = False

    def files(self, tree=TREE):
        """Returns the paths of the C files."""
        found = []
        for pattern in self.sources:
            paths = sorted(Path(tree).glob(pattern))
            if not paths:
                raise Stop(f"{LIST}: {self.name}: expected files at {pattern}, found none")
            found += [str(path.relative_to(tree)) for path in paths]
        return found


def read(tree=TREE):
    """Returns the components by name. Each comes after the components that it needs."""
    known = {}
    for name, its in tomllib.loads((Path(tree) / LIST).read_text(encoding="utf-8")).items():
        try:
            known[name] = Component(name, **its)
        except TypeError as error:
            field = re.search(r"'(\w+)'", str(error))
            raise Stop(f"{LIST}: {name}: "
                       + ("unknown field " if "unexpected" in str(error) else "missing field ")
                       + (field[1] if field else str(error))) from None
        for other in known[name].needs:
            if other not in known:
                raise Stop(f"{LIST}: {name}: needs '{other}', which is not listed before it")
    return known
