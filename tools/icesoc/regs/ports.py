# SPDX-License-Identifier: MIT
"""ports: the ports of a register block in addition to the ports of every slot."""
from dataclasses import dataclass


@dataclass
class Port:
    """A port of the register block in addition to the ports of every slot."""

    name: str
    is_out: bool
    width: int
    doc: str
    owner: str  # name of the register, field or event that the port serves
    group: str = ""  # comment above the port, if the port begins a group
    is_reg: bool = False


def ports_of(b):
    """Returns the ports of a block in their order."""
    return [*interrupt_ports(b), *register_ports(b), *storage_ports(b)]


def interrupt_ports(b):
    ports = [Port("irq_o", True, 1, "", "the interrupt", "interrupt")]
    for n, e in enumerate(b.events):
        def add(end, is_out, doc, group=""):
            ports.append(Port(f"{e.lower}_{end}", is_out, 1, doc, f"event {e.name}", group))

        add("event_i", False, e.doc, "" if n else "events, high for one clock each")
        if e.watched:
            add("pending_o", True, "the event is set")
            add("clear_o", True, "the event is being cleared")
    return ports


def ports_of_register(r):
    ports = []

    def add(name, is_out, width=1, doc="", part=None, is_reg=False):
        owner = f"{r.name}.{part.name}" if part and part.name else r.name
        ports.append(Port(name, is_out, width, doc, owner, is_reg=is_reg))

    if r.has_write_strobe:
        add(f"{r.lower}_write_o", True)
    if r.reads:
        add(f"{r.lower}_read_o", True)
    for part in r.parts:
        stem, doc = r.port(part), part.doc if part.name else ""
        if part.access == "w1c":
            add(f"{stem}_set_i", False, part.width, "1 sets a bit", part)
        if part.access == "w1s":
            add(f"{stem}_clear_i", False, part.width, "1 clears a bit", part)
        if part.hwset:
            add(f"{stem}_set_i", False, 1, "sets all bits", part)
        if part.hwclr:
            add(f"{stem}_clear_i", False, 1, "clears all bits", part)
        if r.is_pulse(part) or r.written_bits(part) or r.holds(part):
            add(f"{stem}_o", True, part.width, doc, part,
                r.holds(part) or (r.registered and r.is_pulse(part)))
        if r.is_read and (r.storage == "core" or (r.is_stored and part.access == "ro")):
            add(f"{stem}_i", False, part.width, doc, part)
    if len(ports) > 1 or any(p.doc for p in ports):
        ports[0].group = r.name
    return ports


def register_ports(b):
    return [port for r in b.own_registers for port in ports_of_register(r)]


def storage_ports(b):
    ports = []
    for lock in b.locks:
        held = ", ".join(r.name for r in b.own_registers if r.lock == lock)
        ports.append(Port(f"{lock}_i", False, 1, f"writes to {held} are ignored", f"lock {lock}",
                          "" if ports else "locks"))
    for storage, made in (("ram", ram_ports), ("memory", memory_ports)):
        if b.stored_in(storage):
            ports += made(b, ", ".join(r.name for r in b.stored_in(storage)))
    return ports


def ram_ports(b, kept):
    owner = "the RAM of registers"
    return [Port("ram_addr_i", False, b.ram_bits, "low bits of a word's number", owner,
                 f"second read port of the RAM with {kept}"),
            Port("ram_o", True, 32, "", owner)]


def memory_ports(b, kept):
    owner = "the core's memory"
    return [Port("memory_write_o", True, 1, "bus_wdata_i goes to word bus_addr_i", owner,
                 f"the core's memory of {kept}"),
            Port("memory_i", False, 32, "word bus_addr_i; 0 for words of other registers",
                 owner)]
