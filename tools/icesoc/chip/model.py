# SPDX-License-Identifier: MIT
"""model: reads the list of the chip's cores (ip/cores.list, docs/hw-mapping.md), and assigns slots,
memory ports, buffers in DDR3 and pins to them."""
import re
from dataclasses import dataclass, field

import places

from icesoc.regs.model import Block, Wrong

SLOT_LIMIT, PIN_LIMIT = 64, 32
SLOT_BYTES = 64
BUFFER_ALIGNMENT = 128  # size of the largest NPI burst, bytes
# Lowest frequency of a core's separate clock, Hz. With a slower clock, an access would take longer
# than the TIMEOUT of bus_crossing.
LEAST_HZ = 3e6
PROBE_BITS = 223


def read(path):
    """Returns the text of a file; raises Wrong with the reason if it cannot be read."""
    try:
        with open(path, encoding="utf-8-sig") as f:
            return f.read()
    except OSError as e:
        raise Wrong(f"1: error: cannot read '{path}'") from e
    except ValueError as e:
        raise Wrong(f"1: error: '{path}': expected text in UTF-8") from e


@dataclass
class Pin:
    name: str  # port of the core; the suffix _i or _o gives the direction
    width: int = 1
    # True: never connected to a pin, only to other cores; an unconnected input is 0
    internal: bool = False
    lsb: int = 0  # index of its first bit in core_pins_i or core_pins_o
    source: str = ""  # output of another core that drives this input, instead of a pin
    places: list = field(default_factory=list)  # locations of its bits on the board, bit 0 first

    @property
    def is_pin(self):
        return not self.source and not self.internal

    @property
    def direction(self):
        return self.name[-1]


@dataclass
class Core:
    line: int
    folder: str
    name: str
    identity: str = ""
    slot: int = 0
    port: int = -1  # memory port; -1: no port
    memory: int = 0  # DDR3 byte address of the buffers, a multiple of memory_bytes
    memory_bytes: int = 0  # size of the buffers in bytes, a power of two; 0: no buffers
    is_placed: bool = False  # True: the list gives the address with memory=
    # C type and header of the servant; None: the common servant in sw/hw/registers
    servant: dict = None
    pins: list = field(default_factory=list)
    constraints: str = ""  # text of the core's *.ucf
    has_clock: bool = False  # the module has the parameter CLK_HZ
    # highest frequency of the core's separate clock, Hz; 0: the core uses the chip clock
    own_clock: int = 0
    # clock_hz is the chip clock * multiply / divide; 0: the clock comes from pin clock_i, the last
    # pin of the core
    multiply: int = 0
    divide: int = 1
    says_idle: bool = False  # the module has the output idle_o
    # the clock of the core stops while the core is idle, in the simulator and on the board
    has_gate: bool = False
    is_probe: bool = False  # the core is a probe: its module has cycles_i and signals_i
    signals: list = field(default_factory=list)  # signals of a probe, bit 0 first: (name below soc,
                                                 # width)

    @property
    def clock_hz(self):
        """Returns the frequency of the core's separate clock, Hz. If the clock comes from a pin,
        returns the highest frequency of that clock."""
        return 100e6 / self.divide * self.multiply if self.multiply else self.own_clock

    def fail(self, text):
        raise Wrong(f"{self.line}: error: {text}")

    def check(self, holds, text):
        if not holds:
            self.fail(text)


@dataclass
class Slot:
    """A slot with its block, which is a core or a part of the platform."""

    name: str
    number: int
    address: int  # byte address of the slot for the processor
    block: Block
    bytes: int = SLOT_BYTES


class Chip:
    """The cores of a list, with the resources that the chip assigns to each of them."""

    def __init__(self, text, base, manifests, descriptions):
        constants = {c["name"]: c["value"] for c in base["constants"]}
        self.manifests, self.descriptions = manifests, descriptions
        self.first = constants["SLOT_COUNT"]
        self.buffers = constants["BUFFERS"]
        self.memory_end = 1 << constants["DDR_BYTES_LOG2"]
        self.ports = constants["NPI_PORT_COUNT"]
        self.registers = constants["CONTROL_WINDOW"]  # the processor's address of slot 0
        # number of bits used in core_pins_i ("i") and core_pins_o ("o")
        self.pins = {"i": 0, "o": 0}
        # name in use -> its line in the list; 0: a slot of the platform
        self.names = {n[5:].lower(): 0 for n in constants if n.startswith("SLOT_")}
        self.identities, self.places, self.cores = set(), {}, []
        # splitlines() would also split at form feeds
        for n, line in enumerate(text.split("\n"), 1):
            words = line.split("#")[0].split()
            if words:
                self.cores.append(self.read(n, words[0], words[1:]))
        self.give_slots()
        self.give_memory()
        for core in self.cores:
            self.connect(core)
        self.cores.sort(key=lambda core: core.slot)
        self.slots = self.cores[-1].slot + 1 if self.cores else self.first

    def read(self, line, folder, words):
        core = Core(line, folder, folder)
        core.check(folder in self.descriptions,
                   f"no core '{folder}': add ip/{folder}/core.toml or remove the line")
        self.describe(core, self.descriptions[folder].description)
        given = {}
        for word in words:
            key, _, value = word.partition("=")
            core.check(value, f"'{word}': expected name=, identity=, slot=, memory=, gate=, "
                              "signals=, or a pin of the core")
            core.check(key not in given, f"'{key}' is given twice")
            given[key] = value
        for key, value in given.items():
            self.set(core, key, value)
        for name, locations in self.manifests[folder].places().items():
            pin = next(p for p in core.pins if p.name == name)
            if pin.is_pin and not pin.places:
                self.set_places(core, pin, "@" + ",".join(locations))
        core.check(core.says_idle or not core.has_gate,
                   f"gate=on: '{core.folder}' has no output idle_o (idle in its core.toml)")
        core.check(core.signals or not core.is_probe,
                   f"'{core.name}' records no signals: expected a list such as "
                   "signals=u_fir.busy,u_fir.count:9")
        core.identity = core.identity or core.name
        known = self.names.setdefault(core.name, line)
        core.check(known, f"'{core.name}' is a name of the platform; give the core another name "
                          "with name=")
        core.check(known == line, f"'{core.name}' is already on line {known}; give one of the two "
                                  "another name with name=")
        core.check(core.identity not in places.OBJECTS,
                   f"the identity '{core.identity}' is an object of the platform; give the core "
                   "another identity with identity=")
        core.check(core.identity not in self.identities,
                   f"the identity '{core.identity}' is taken")
        self.identities.add(core.identity)
        return core

    def describe(self, core, block):
        core.check("type" in block, f"'{core.folder}': expected the description of a slot, got one "
                                    "without a type")
        if block.get("memory_port"):
            core.port = self.ports
            self.ports += 1
        needed = block.get("memory_bytes", 0)
        if needed > self.memory_end - self.buffers:
            self.no_room(core, needed)
        if needed:
            core.memory_bytes = max(BUFFER_ALIGNMENT, 1 << (needed - 1).bit_length())
        core.is_probe = block.get("probe", False)
        core.servant = block.get("servant")
        core.pins = [Pin(p["name"], p.get("width", 1), p.get("internal", False))
                     for p in block.get("pins", [])]
        facts = self.manifests[core.folder].facts
        core.has_clock = facts.get("clk_hz", False)
        core.says_idle = facts.get("idle", False)
        core.own_clock = facts.get("clock_hz", 0)
        if "constraints" in facts:
            core.constraints = read(self.manifests[core.folder].file(facts["constraints"]))
        for signal in facts.get("signals", []):
            self.set_signals(core, signal)
        if core.own_clock:
            core.pins.append(Pin("clock_i"))

    @staticmethod
    def no_room(core, needed):
        core.fail(f"no room in DDR3 for the {needed} bytes of '{core.folder}'")

    def set(self, core, key, value):
        """Parses one word of a core's line in the list."""
        if key == "name":
            core.check(re.fullmatch("[a-z][a-z0-9_]*", value),
                       f"name={value}: expected small letters, digits and _")
            core.name = value
        elif key == "identity":
            core.check(not re.search(r'["\\/]', value),
                       f"identity={value}: expected no quotes, \\ and /")
            core.identity = value
        elif key == "slot":
            core.slot = int(value) if re.fullmatch("[0-9]{1,2}", value) else 0
            core.check(self.first <= core.slot < SLOT_LIMIT,
                       f"slot={value}: expected {self.first} to {SLOT_LIMIT - 1}, the slots for "
                       "cores")
        elif key == "memory":
            digits = "0[xX][0-9a-fA-F]{1,8}|0|[1-9][0-9]{0,9}"
            core.check(core.memory_bytes and re.fullmatch(digits, value),
                       f"memory={value}: expected a byte address in DDR3, and a core with buffers")
            core.memory, core.is_placed = int(value, 0), True
        elif key == "signals" and core.is_probe:
            core.signals = []  # these replace the manifest's signals
            self.set_signals(core, value)
        elif key == "clock" and core.own_clock:
            self.set_clock(core, value)
        elif key == "gate":
            core.check(value == "on", f"gate={value}: expected gate=on, or no gate=")
            core.has_gate = True
        else:
            self.set_pin(core, key, value)

    def set_pin(self, core, key, value):
        inputs = [p.name for p in core.pins if p.direction != "o"]
        pin = next((p for p in core.pins if p.name == key), None)
        if pin and value[0] == "@":
            self.set_places(core, pin, value)
        elif pin and value == "none":
            pin.internal = True
        elif key in inputs:
            pin.source = value
        else:
            core.fail(f"'{core.folder}' has no input pin '{key}'; "
                      f"it has {', '.join(inputs) or 'none'}")

    @staticmethod
    def set_clock(core, value):
        """Handles clock=3/8: the clock is this fraction of the chip clock, generated by a
        DCM_CLKGEN, and the core has no pin clock_i."""
        match = re.fullmatch("([0-9]{1,3})/([0-9]{1,3})", value)
        core.multiply, core.divide = map(int, match.groups()) if match else (0, 0)
        core.check(2 <= core.multiply <= core.divide <= 256,
                   f"clock={value}: expected a fraction of the chip clock, such as 3/8 "
                   "(2..256 / 2..256)")
        core.check(LEAST_HZ <= core.clock_hz <= core.own_clock,
                   f"clock={value}: expected {LEAST_HZ:.0f} to {core.own_clock} Hz for "
                   f"'{core.folder}', got {core.clock_hz:.0f} Hz")
        core.pins[-1].internal = True

    @staticmethod
    def set_signals(core, value):
        """Handles signals=u_fir.busy,u_fir.count:9: hierarchical names below soc, and widths in
        bits."""
        for word in value.split(","):
            match = re.fullmatch("([A-Za-z0-9_.]+)(?::([0-9]{1,3}))?", word)
            width = int(match[2] or 1) if match else 0
            core.check(width, f"signals: '{word}': expected a name and a width, such as "
                       "u_fir.count:9")
            core.signals.append((match[1], width))
        bits = sum(width for _, width in core.signals)
        core.check(bits <= PROBE_BITS, f"signals: expected at most {PROBE_BITS} bits, got {bits}")

    def set_places(self, core, pin, value):
        """Handles pwm_o=@A4,B4: locations of the bits on the board, bit 0 first."""
        for place in value[1:].split(","):
            core.check(re.fullmatch("[A-Za-z0-9]+", place),
                       f"{pin.name}={value}: expected places of letters and digits, such as "
                       "@A4,B4")
            core.check(place not in self.places,
                       f"place {place} is taken on line {self.places.get(place)}")
            self.places[place] = core.line
            pin.places.append(place)
        core.check(len(pin.places) == pin.width,
                   f"{pin.name}={value}: expected {pin.width} places, one per bit, got "
                   f"{len(pin.places)}")

    def give_slots(self):
        taken = {}
        for core in self.cores:
            if core.slot:
                core.check(core.slot not in taken,
                           f"slot {core.slot} is taken on line {taken.get(core.slot)}")
                taken[core.slot] = core.line
        free = (slot for slot in range(self.first, SLOT_LIMIT) if slot not in taken)
        for core in self.cores:
            core.slot = core.slot or next(free, 0)
            core.check(core.slot, f"all {SLOT_LIMIT} slots are taken")

    def give_memory(self):
        """Assigns the addresses of the buffers in DDR3.

        A core's wrapper keeps only the address bits above the size of its buffers, so their address
        is a multiple of this size. Buffers with memory= are placed first. The others follow in the
        order of the list, each at the next free address after the one before.
        """
        placed = []

        def neighbour(core):
            return next((other for other in placed
                         if core.memory < other.memory + other.memory_bytes
                         and other.memory < core.memory + core.memory_bytes), None)

        for core in self.cores:
            if core.is_placed:
                core.check(core.memory % core.memory_bytes == 0
                           and self.buffers <= core.memory < self.memory_end,
                           f"memory=0x{core.memory:X}: expected a multiple of the buffers' size, "
                           f"{core.memory_bytes} bytes, from 0x{self.buffers:X} to below "
                           f"0x{self.memory_end:X}")
                other = neighbour(core)
                core.check(not other, f"memory=0x{core.memory:X} is within the buffers of line "
                                      f"{other and other.line}")
                placed.append(core)
        end = self.buffers
        for core in self.cores:
            if core.memory_bytes and not core.is_placed:
                core.memory = aligned(end, core.memory_bytes)
                while other := neighbour(core):
                    core.memory = aligned(other.memory + other.memory_bytes, core.memory_bytes)
                end = core.memory + core.memory_bytes
                if end > self.memory_end:
                    self.no_room(core, core.memory_bytes)
                placed.append(core)

    def connect(self, core):
        """Connects inputs of a core to outputs of other cores, and assigns bits of the chip pins
        to the remaining pins of the core."""
        outputs = {f"{c.name}.{p.name}": p for c in self.cores for p in c.pins
                   if p.direction == "o"}
        names = [c.name for c in self.cores]
        for pin in core.pins:
            if pin.source and pin.internal and pin.source.split(".")[0] not in names:
                # the core that would drive this input is not in the chip, so the input stays
                # unconnected
                pin.source = ""
            elif pin.source:
                origin = outputs.get(pin.source)
                core.check(origin and origin.width == pin.width,
                           f"{pin.name}={pin.source}: expected a core's output of {pin.width} "
                           "bits")
            elif not pin.internal:
                pin.lsb = self.pins[pin.direction]
                self.pins[pin.direction] += pin.width
                core.check(self.pins[pin.direction] <= PIN_LIMIT,
                           f"'{pin.name}' of '{core.name}': the chip has only {PIN_LIMIT} pins per "
                           f"direction for cores; {pin.name}=none leaves it unconnected")


def aligned(address, size):
    return -(-address // size) * size
