# SPDX-License-Identifier: MIT
"""model: reads boards/NAME/board.toml, and the files of the modules and parts that it names.

The facts of parts (boards/parts/*.csv) and of modules (boards/modules/*.toml) are read here and
nowhere else. check.py checks a Board; ucf.py and the files next to it generate files from a Board.
"""
import csv
import json
import re
from dataclasses import dataclass, field
from pathlib import Path

from icesoc import TREE
from icesoc.board.signals import SIGNALS, Signal
from icesoc.chip.manifest import parse
from icesoc.regs.model import Wrong
from icesoc.util import schema
from icesoc.util.errors import nearest

SCHEMA = json.loads(Path(__file__).with_name("board.schema.json").read_text())
BOARDS = TREE / "boards"


@dataclass
class Pin:
    """A pin of a microcontroller, or a ball of an FPGA."""
    name: str
    number: str = ""  # number in the package; empty for a ball
    functions: dict = field(default_factory=dict)  # name of each alternate function -> its number
    bank: int | None = None
    # ball as Xilinx names it, such as IO_L41P_GCLK9_IRDY1_M1RASN_1 or VCCO_0; for a pin of a
    # microcontroller, empty if it is an I/O pin
    description: str = ""

    @property
    def is_io(self):
        return self.description == "" or self.description.startswith("IO_")

    @property
    def is_clock(self):
        return "_GCLK" in self.description


@dataclass
class Module:
    """A circuit board with connectors, which holds the microcontroller, the FPGA or the modem."""
    name: str
    facts: dict

    @property
    def occupied(self):
        return self.facts.get("occupied", {})

    def place(self, pin, connectors):
        """Returns the connector and number of a pin, such as ("CN11", 34), or None. If several
        connectors have the pin, the first in `connectors` is returned."""
        for connector in connectors:
            pins = self.facts["connectors"].get(connector, [])
            if pin in pins:
                return connector, pins.index(pin) + 1
        return None


@dataclass
class Net:
    """A wire of the board with its ends, and with the known facts about the wire."""
    name: str
    facts: dict

    @property
    def signal(self) -> Signal:
        return SIGNALS[self.name]

    @property
    def function(self):
        return self.facts.get("function", self.signal.function)

    @property
    def level(self):
        return self.facts.get("level", 3.3)

    def get(self, key, default=None):
        return self.facts.get(key, default)


@dataclass
class Board:
    """A board as described in its board.toml. `parts` and `modules` have the keys mcu, fpga and
    modem, if the board has such a part."""
    path: Path
    name: str
    facts: dict
    parts: dict
    modules: dict
    nets: list

    @property
    def muxed(self):
        return self.facts.get("fsmc", {}).get("muxed", False)

    @property
    def address_lines(self):
        return self.facts.get("fsmc", {}).get("address_lines", 25)

    @property
    def modem(self):
        """Returns the kind of the modem as a value of the option --modem; None if the board has no
        modem."""
        return self.facts.get("modem", {}).get("profile")

    @property
    def banks(self):
        return self.facts["fpga"].get("banks", [0.0] * 4)

    @property
    def ddr(self):
        """Returns the facts of the memory, or None if the board does not use it."""
        module = self.modules.get("fpga")
        used = self.facts["fpga"].get("ddr", False)
        return module.facts.get("ddr") if used and module else None

    def net(self, name):
        return next((net for net in self.nets if net.name == name), None)

    def place(self, net, end):
        """Returns (connector, number) of an end of a net, or None."""
        module = self.modules.get(end)
        connectors = self.facts.get(end, {}).get("connectors", [])
        return module.place(net.get(end), connectors) if module and net.get(end) else None


def names(boards=BOARDS):
    """Returns the names of all boards in a folder (default: the boards of the tree)."""
    return sorted(path.parent.name for path in boards.glob("*/board.toml"))


def rows(path):
    """Returns the rows of a CSV file of facts, without its comments."""
    text = path.read_text("utf-8-sig")
    lines = [line for line in text.split("\n") if line and not line.startswith("#")]
    return list(csv.DictReader(lines))


def part_file(name, column, where, boards):
    """Returns the path of the CSV file about a part. `column`: a column that only files about this
    kind of part have. Raises Wrong if boards/parts has no part of this kind and name; the message
    begins with `where`."""
    known = {path.stem: path for path in sorted((boards / "parts").glob("*.csv"))
             if column in rows(path)[0]}
    if name not in known:
        raise Wrong(f"{where}.part: expected {' or '.join(known)}, got '{name}'"
                    + nearest(name, known))
    return known[name]


def read_module(name, part, where, boards):
    """Returns the Module with this name. Raises Wrong if boards/modules has no such module, or if
    its part is not `part`; the message begins with `where`."""
    known = {path.stem: path for path in sorted((boards / "modules").glob("*.toml"))}
    if name not in known:
        raise Wrong(f"{where}.module: expected {' or '.join(known)}, got '{name}'"
                    + nearest(name, known))
    module = Module(name, checked(known[name], "module"))
    if part and module.facts["part"] != part:
        raise Wrong(f"{where}.module: expected a module with the part {part}, got '{name}' with "
                    f"{module.facts['part']}")
    return module


def mcu_part(path):
    """Returns the pins of a microcontroller by name."""
    pins = {}
    for row in rows(path):
        words = row["functions"].split()
        functions = {}
        for word in words:
            number, colon, function = word.partition(":")
            if colon:
                functions[function] = int(number)
        kind = "" if functions or not words else words[0]
        pins.setdefault(row["pin"], Pin(row["pin"], row["number"], functions, None, kind))
    return pins


def fpga_part(path):
    """Returns the balls of an FPGA by name."""
    return {row["ball"]: Pin(row["ball"], bank=int(row["bank"]) if row["bank"] else None,
                             description=row["name"]) for row in rows(path)}


def merged(base, facts):
    """Returns the facts of a board that is derived from a base board. Tables of both are merged,
    nets of the base are replaced by nets of the same name, and the nets listed in `without` are
    left out."""
    result = {**base, **facts}
    for key, value in facts.items():
        if isinstance(value, dict) and isinstance(base.get(key), dict):
            result[key] = {**base[key], **value}
    own = {net.get("name") for net in facts.get("nets", [])}
    left_out = own | set(facts.get("without", []))
    result["nets"] = [net for net in base["nets"] if net["name"] not in left_out]
    result["nets"] += facts.get("nets", [])
    return {key: value for key, value in result.items() if key not in ("base", "without")}


def problems(path, facts, kind, **changes):
    """Raises Wrong if facts do not fit the schema of a board or a module."""
    found = schema.problems(facts, {**SCHEMA["$defs"][kind], "$defs": SCHEMA["$defs"], **changes})
    if found:
        raise Wrong("\n".join(f"{path}: {text}" for text in found))


def with_base(path, facts, boards):
    """Returns the facts of a board that names a `base`: the facts of the base, except for those
    that the board changes."""
    tables = {key: {k: v for k, v in value.items() if k != "required"}
              for key, value in SCHEMA["$defs"]["board"]["properties"].items()}
    problems(path, facts, "board", required=[], properties=tables)  # the base has the rest
    base = facts["base"]
    known = names(boards)
    if base not in known:
        raise Wrong(f"{path}: base: expected a board of boards/, got '{base}'"
                    + nearest(base, known))
    other = boards / base / "board.toml"
    if "base" in parse(other):
        raise Wrong(f"{path}: base: expected a board without a base, got '{base}'")
    below = checked(other, "board", boards)
    has = [net["name"] for net in below["nets"]]
    for name in facts.get("without", []):
        if name not in has:
            raise Wrong(f"{path}: without: expected a net of {base}, got '{name}'"
                        + nearest(name, has))
    return merged(below, facts)


def checked(path, kind, boards=BOARDS):
    """Returns the facts in a TOML file after checking them against the schema. If the file names a
    `base`, the facts of the base are included, except for those that the file changes."""
    facts = parse(path)
    if kind == "board" and "base" in facts:
        facts = with_base(path, facts, boards)
    elif "without" in facts:
        raise Wrong(f"{path}: without: expected only in a board with 'base'")
    problems(path, facts, kind)
    return facts


def read(path, boards=BOARDS):
    """Returns the Board of a file board.toml; raises Wrong with the reason and what to do.
    `boards`: the folder with parts/ and modules/."""
    path = Path(path).absolute()
    name = path.parent.name
    if not re.fullmatch(r"[a-z0-9][\w.-]{0,63}", name, re.A | re.I):
        raise Wrong(f"{path}: expected a folder with the name of the board, at most 64 letters, "
                    f"digits, '.', '_' and '-', got '{name}'")
    facts = checked(path, "board", boards)
    parts, modules = {}, {}
    for role, reader in (("mcu", mcu_part), ("fpga", fpga_part), ("modem", None)):
        if role not in facts:
            continue
        part, where = facts[role].get("part"), f"{path}: {role}"
        if reader:
            column = {"mcu": "functions", "fpga": "ball"}[role]
            parts[role] = reader(part_file(part, column, where, boards))
        if module := facts[role].get("module"):
            modules[role] = read_module(module, part, where, boards)
    nets = []
    for entry in facts["nets"]:
        if entry["name"] not in SIGNALS:
            raise Wrong(f"{path}: nets: unknown name {entry['name']}"
                        + nearest(entry["name"], SIGNALS))
        nets.append(Net(entry["name"], entry))
    return Board(path, name, facts, parts, modules, nets)


def find(name, boards=BOARDS):
    """Returns the Board with this name."""
    known = names(boards)
    if name not in known:
        raise Wrong(f"no board '{name}'; expected {', '.join(known)}" + nearest(name, known))
    return read(boards / name / "board.toml", boards)
