# SPDX-License-Identifier: MIT
"""model: the registers of a block, read from its *.regs.json and checked.

All tools read register descriptions through Block.read. Format of the description: docs/bus.md.
"""
import json
from dataclasses import dataclass, field
from pathlib import Path

from icesoc.regs import names
from icesoc.regs.ports import ports_of
from icesoc.util.schema import problems

SCHEMA = json.loads(Path(__file__).with_name("regs.schema.json").read_text())
WORDS_PER_SLOT = 16
FIRST_WORD = 3  # number of the first word of a block; ID, EVENT and MASK precede it
ACCESSES = {
    "ro": "read only",
    "rw": "read and write",
    "w1c": "write 1 to clear",
    "w1s": "write 1 to set",
    "ws": "write acts, reads as 0",
}
# Access of a register -> parts of the hardware that may store its value; the first one is the
# default.
STORAGES = {
    "ro": ("core",),
    "rw": ("flip-flops", "ram", "core", "memory"),
    "w1c": ("flip-flops",),
    "w1s": ("flip-flops",),
    "ws": ("core", "flip-flops"),
}


MIXED = ("rw", "w1c", "w1s")  # registers that may contain ro fields


class Wrong(Exception):
    """An error in the input; its text is the message for the user."""


def check(holds, text):
    if not holds:
        raise Wrong(text)


def reset_of(text):
    """Returns a reset value, or None for "none": reset does not change the register."""
    return None if text == "none" else int(text or "0", 16)


@dataclass
class Field:
    """Some bits of a register. A register that declares no fields is represented by one unnamed
    field."""

    name: str
    lsb: int
    width: int
    doc: str
    access: str = ""  # "ro", or "" for the access of the register
    reset: int | None = 0
    has_reset: bool = False  # True: the description contains the reset value
    hwset: bool = False  # True: the core may set any bit of the field
    hwclr: bool = False  # True: the core may clear any bit of the field

    @property
    def msb(self):
        return self.lsb + self.width - 1

    @property
    def mask(self):
        return (1 << self.width) - 1 << self.lsb

    @property
    def bits(self):
        return str(self.lsb) if self.width == 1 else f"{self.msb}..{self.lsb}"


@dataclass
class Register:
    word: int
    name: str
    access: str
    doc: str
    width: int = 32
    # byte address in the core, if the register is accessed through an adapter; -1: the register
    # is in the slot itself
    page: int = -1
    fields: list = field(default_factory=list)
    reset: int | None = 0  # reset value of a register without fields
    storage: str = ""
    lock: str = ""  # name of an input; while it is high, writes have no effect
    # True: the outputs of pulses are flip-flops, so a pulse comes one clock after the write
    registered: bool = False
    # "read" and "write": for each of them, the block has an output that is high in the clock of
    # such an access
    strobes: tuple = ()

    @property
    def parts(self):
        """Returns the fields, or the whole register as one field."""
        return self.fields or [Field("", 0, self.width, self.doc, self.access, self.reset)]

    @property
    def lower(self):
        return self.name.lower()

    @property
    def is_written(self):
        return self.access != "ro"

    @property
    def is_read(self):
        return self.access != "ws"

    @property
    def is_stored(self):
        """Returns whether flip-flops of the register block hold the value."""
        return self.storage == "flip-flops"

    def holds(self, part):
        """Returns whether flip-flops of the register block hold the field."""
        return self.is_stored and part.access != "ro"

    @property
    def held_parts(self):
        return [p for p in self.parts if self.holds(p)]

    def port(self, part):
        """Returns the port name of a field without _i or _o: status_busy for STATUS.BUSY, but
        page for PAGE.PAGE, the only field of its register."""
        alone = len(self.fields) <= 1 and part.name in ("", self.name)
        return self.lower if alone else f"{self.lower}_{part.name.lower()}"

    def is_pulse(self, part):
        """Returns whether the field is one bit of a `ws` register: writing 1 gives a pulse of one
        clock."""
        return part.access == "ws" and not self.is_stored and bool(part.name) and part.width == 1

    @property
    def pulses(self):
        return [p for p in self.parts if self.is_pulse(p)]

    def written_bits(self, part):
        """Returns whether the register block only passes the written value of the field to the core
        by an output. The core must then store the value."""
        return (part.access != "ro" and self.storage == "core" and bool(part.name)
                and not self.is_pulse(part))

    @property
    def reads(self):
        """Returns whether the register block has an output with a pulse for each read of the
        register."""
        return "read" in self.strobes

    @property
    def has_write_strobe(self):
        """Returns whether the register block has an output with a pulse for each write of the
        register."""
        return self.is_written and ("write" in self.strobes or self.storage == "core" and not all(
            self.is_pulse(p) for p in self.parts if p.access != "ro"))


@dataclass
class Event:
    name: str
    bit: int
    doc: str
    # True: one output is high while the event is pending, and another when it is being cleared
    watched: bool = False

    @property
    def lower(self):
        return self.name.lower()


@dataclass
class Constant:
    name: str
    value: int
    doc: str


class Block:
    """The registers of a block."""

    def __init__(self, description, is_built=False):
        """`is_built`: the build has already checked the description against the schema, so this is
        not done again."""
        if not is_built and (found := problems(description, SCHEMA)):
            raise Wrong("; ".join(found))
        check(("type" in description) == ("version" in description),
              "expected both a type and a version, or neither")
        self.description = description
        self.name, self.doc = description["block"], description["doc"]
        self.prefix = self.name.upper()
        self.is_slot = "type" in description  # True: the block has ID, EVENT and MASK in words 0..2
        self.type = int(description.get("type", "0"), 16)
        self.version = int(description.get("version", "0"), 16)
        self.memory_bytes = description.get("memory_bytes", 0)
        self.events = [Event(**e) for e in description.get("events", [])]
        self.own_registers = [register_of(r) for r in description["registers"]]
        self.registers = self.common_registers() + self.own_registers
        self.constants = [Constant(**c) for c in description.get("constants", [])]
        if self.is_slot:
            self.constants.append(Constant("ID_VALUE", self.type << 16 | self.version,
                                           "value of word ID"))
        taken = set()
        for r in self.registers:
            check_register(r, taken)
        for e in self.events:
            check(sum(other.bit == e.bit for other in self.events) == 1,
                  f"event {e.name}: bit {e.bit} is used twice")
        try:
            names.check_block(self)
        except names.Collision as e:
            raise Wrong(str(e)) from None

    @classmethod
    def read(cls, path, is_built=False):
        try:
            return cls(json.loads(Path(path).read_text("utf-8-sig")), is_built)
        except OSError as e:
            raise Wrong(e.strerror) from None
        except json.JSONDecodeError as e:
            raise Wrong(f"expected JSON: {e}") from None
        except (ValueError, RecursionError):
            raise Wrong("expected JSON in UTF-8 without long numbers or deep brackets") from None

    def common_registers(self):
        """Returns the three registers that every slot begins with, or an empty list if the block is
        not a slot."""
        if not self.is_slot:
            return []
        def events(access):
            return [Field(e.name, e.bit, 1, e.doc, access) for e in self.events]

        ident = [Field("VERSION", 0, 16, "major and minor, 8 bits each", "ro", self.version, True),
                 Field("TYPE", 16, 16, "type id", "ro", self.type, True)]
        return [Register(0, "ID", "ro", "type and version of the slot", fields=ident),
                Register(1, "EVENT", "w1c", "sticky events; write 1 to clear",
                         fields=events("w1c")),
                Register(2, "MASK", "rw", "1: the event drives the interrupt line",
                         fields=events("rw"))]

    @property
    def has_register_block(self):
        """Returns whether a register block can be generated. The registers must be in a slot, and
        none may be accessed through an adapter."""
        return self.is_slot and all(r.page < 0 for r in self.registers)

    @property
    def event_bits(self):
        return max([e.bit + 1 for e in self.events], default=1)

    @property
    def locks(self):
        return sorted({r.lock for r in self.own_registers if r.lock})

    def stored_in(self, storage):
        return [r for r in self.own_registers if r.storage == storage]

    @property
    def ram_bits(self):
        """Returns the number of address bits of the LUT RAM: the smallest number of low bits, at
        least 2, in which the word numbers of all words in the RAM differ."""
        words = [r.word for r in self.stored_in("ram")]
        return next(n for n in range(2, 5) if len({w % (1 << n) for w in words}) == len(words))

    @property
    def word_mask(self):
        return sum(1 << r.word for r in self.registers)

    @property
    def ports(self):
        return ports_of(self)


def register_of(r):
    fields = [Field(**{**f, "reset": reset_of(f.get("reset", r.get("reset"))),
                       "has_reset": "reset" in f, "access": f.get("access", r["access"])})
              for f in r.get("fields", [])]
    storage = r.get("storage") or STORAGES.get(r["access"], ("",))[0]
    return Register(**{**r, "fields": fields, "reset": reset_of(r.get("reset")),
                       "storage": storage, "strobes": tuple(r.get("strobes", ()))})


def check_register(r, taken):
    name, word, page = r.name, r.word, r.page
    check(0 <= word < WORDS_PER_SLOT, f"{name}: expected a word from 0 to 15, got {word}")
    check((word, page) not in taken and (page < 0 or (word, -1) not in taken),
          f"{name}: word {word} is taken")
    taken.add((word, page))
    check(page < 0 or (word >= 8 and page % 32 == 0),
          f"{name}: expected a page that is a multiple of 32, in a word from 8 to 15")
    check(0 < r.width <= 32, f"{name}: expected a width of 1 to 32 bits, got {r.width}")
    check(r.access in ACCESSES,
          f"{name}: access: expected one of {' '.join(ACCESSES)}, got '{r.access}'")
    check(word < FIRST_WORD or r.storage in STORAGES[r.access],
          f"{name}: storage of a register with access {r.access}: expected "
          f"{' or '.join(STORAGES[r.access])}, got '{r.storage}'")
    check(not r.registered or r.pulses,
          f"{name}: registered: expected only in a ws register with bits")
    check(not r.lock or r.is_written, f"{name}: lock: expected only in a register that is written")
    for strobe in r.strobes:
        check(strobe == "read" or r.is_written,
              f"{name}: strobes: expected no write strobe in a ro register")
    used = 0
    for f in r.fields:
        check(f.lsb >= 0 < f.width and f.msb < 32,
              f"{name}.{f.name}: bits {f.msb}..{f.lsb} do not fit a word")
        check(not used & f.mask, f"{name}.{f.name}: overlaps another field")
        used |= f.mask
        check(f.access == r.access or (f.access == "ro" and r.access in MIXED),
              f"{name}.{f.name}: access of a field: expected {r.access}"
              f"{' or ro' if r.access in MIXED else ''}, got '{f.access}'")
        check(not (f.hwset or f.hwclr) or (f.access == "rw" and r.is_stored),
              f"{name}.{f.name}: hwset, hwclr: expected only in a rw field with flip-flops")
    for part in r.parts:
        check(part.reset is None or part.reset >> part.width == 0,
              f"{name}{'.' + part.name if part.name else ''}: reset 0x{part.reset or 0:X} does not "
              f"fit {part.width} bits")
