# SPDX-License-Identifier: MIT
"""core_output: generates the files about the cores of the chip: address map, instances in soc.v,
and the firmware's table.

The chip is a model.Chip, a slot a model.Slot.
"""
import copy
import functools
import json
from pathlib import Path

from icesoc.regs.verilog import span
from icesoc.util import chip as description
from icesoc.util import templates

HAND = "Generated from ip/cores.list: do not edit."


def bits(lsb, width):
    return f"[{lsb}]" if width == 1 else f"[{lsb + width - 1}:{lsb}]"


def hash_of(text):
    """Returns the FNV-1a hash of a text, 32 bits."""
    value = 0x811C9DC5
    for c in text.encode():
        value = (value ^ c) * 0x01000193 & 0xFFFFFFFF
    return value


def declared(width, name):
    return f"wire {name}" if width == 1 else f"wire [{width - 1}:0] {name}"


def source_net(pin):
    """Returns the name of the wire that drives an input. The input's `source` names an output of
    another core as CORE.PIN."""
    return "pin_" + pin.source.replace(".", "_", 1)


def map_of(chip, base):
    made = copy.deepcopy(base)
    constants = made["constants"]

    def add(name, value, doc):
        constants.append({"name": name, "value": value, "doc": doc})

    for c in list(constants):
        if c["name"] == "SLOT_COUNT":
            add("CONTRACTS", c["value"] + len(chip.cores),
                "slots that are not empty: the platform's and the cores'")
            c["value"] = chip.slots
        elif c["name"] == "NPI_PORT_COUNT":
            c["value"] = chip.ports
    add("CORES", len(chip.cores) or 1, "number of cores, at least 1: for tables")
    add("PROBES", sum(core.is_probe for core in chip.cores), "probes among the cores")
    for core in chip.cores:
        name = core.name.upper()
        add(f"SLOT_{name}", core.slot, f"slot of the core {core.name}")
        if core.port >= 0:
            add(f"NPI_PORT_{name}", core.port, f"memory port of the core {core.name}")
        add(f"MEMORY_{name}", core.memory, f"DDR3 byte address of the buffers of the core "
                                           f"{core.name}: {core.memory_bytes} bytes")
        for pin in core.pins:
            if pin.is_pin:
                add(f"PIN_{name}_{pin.name.upper()}", pin.lsb,
                    f"bit of core_pins_{pin.direction}, {pin.width} wide")
    return json.dumps(made, indent=2, ensure_ascii=False) + "\n"


def contract_of(block):
    """Returns a hash of the register properties on which software relies."""
    lines = [json.dumps(block.description["type"])]
    for r in block.own_registers:
        lines.append(f"{r.word} {r.page} {r.name} {r.access} {r.width}")
        lines += [f"{r.name}.{f.name} {f.lsb} {f.width}"
                  f"{'' if f.access == r.access else ' ' + f.access}" for f in r.fields]
    lines += [f"{e.name} {e.bit}" for e in block.events]
    # sorted: the order in the file does not matter
    return hash_of("".join(line + "\n" for line in sorted(lines)))


def change_words(probe):
    """Returns the number of 64-bit words in one entry of a probe: 1, 2 or 4 words for up to 31, 95
    or 223 recorded bits (ip/probe/probe.v)."""
    recorded = sum(width for _, width in probe.signals)
    return 1 if recorded <= 31 else 2 if recorded <= 95 else 4


def names_of(probe):
    """Returns a hash of the names and widths of a probe's signals."""
    return hash_of("".join(f"{name}:{width}\n" for name, width in probe.signals))


def signal_bits(probe):
    """Returns the width of signals_i of a probe."""
    return 64 * change_words(probe) - 33


def recorded(probe):
    """Returns the concatenation of a probe's signals, padded to the width of signals_i."""
    spare = signal_bits(probe) - sum(width for _, width in probe.signals)
    wires = [f"{probe.name}_{i}" for i in range(len(probe.signals))]
    return ", ".join(([f"{spare}'d0"] if spare else []) + wires[::-1])


def taps_of(probe):
    """Returns (wire, hierarchical name of the signal, width of the signal, width of the wire) for
    each signal that a probe records."""
    return [*((f"{probe.name}_{i}", name, width, width)
              for i, (name, width) in enumerate(probe.signals)),
            (f"cycles_{probe.name}", "u_system_slot.cycles", 64, 32)]


def parameters_of(core):
    hz = ("CLK_HZ" if not core.own_clock else
          f"CLK_HZ / {core.divide} * {core.multiply}" if core.multiply else core.own_clock)
    given = [f".CLK_HZ({hz})"] if core.has_clock else []
    if core.is_probe:
        given += [f".WORDS({change_words(core)})", f".NAMES(32'h{names_of(core):08X})"]
    return f"#({', '.join(given)}) " if given else ""


def net_of(core, pin):
    """Returns the expression that is connected to a pin of a core."""
    if pin.source:
        return source_net(pin)
    if core.multiply and pin.name == "clock_i":
        return "clk_" + core.name
    if pin.direction == "o":
        return f"pin_{core.name}_{pin.name}"
    return f"{pin.width}'d0" if pin.internal else "core_pins_i" + bits(pin.lsb, pin.width)


def verilog_of(chip, slots):
    """Returns the Verilog of the core instances, for soc.v. Signals of probes have hierarchical
    names: when Yosys flattens the chip, it joins a wire of such a name with the signal."""
    contracts = [0] * chip.slots
    for slot in slots:
        contracts[slot.number] = contract_of(slot.block)
    probes = [core for core in chip.cores if core.is_probe]
    taps = [tap for probe in probes for tap in taps_of(probe)]
    joined = {}
    for _, name, width, _ in taps:
        joined.setdefault(name, width)
    used = [core.slot for core in chip.cores]
    return render(
        "soc_cores.vh.j2", chip=chip, probes=probes,
        contracts=[f"32'h{contract:08X}" for contract in reversed(contracts)],
        outputs=[(f"pin_{c.name}_{p.name}", p) for c in chip.cores for p in c.pins
                 if p.direction == "o"],
        joined=joined.items(),
        taps=[(wire, name, width, f"[{width - 1}:0]" if width < whole else "")
              for wire, name, whole, width in taps],
        empty=[slot for slot in range(chip.first, chip.slots) if slot not in used])


def alone_pins(core):
    """Returns the connections of a core's pins in a model of this core alone (core_pins.vh.j2)."""
    lsb = {"from": 1, "to": 1}
    nets, connections = [], []
    for pin in core.pins:
        net = net_of(core, pin)
        if pin.direction == "o" or not pin.is_pin:
            side = "to" if pin.direction == "o" else "from"
            if side == "from":
                nets.append(net if "'" in net else "soc." + net)
            net, lsb[side] = side + bits(lsb[side], pin.width), lsb[side] + pin.width
        connections.append(f".{pin.name}({net})")
    return {"name": "CORE_" + core.name.upper(), "connections": connections,
            "nets": [*reversed(nets), "1'b0"], "from_bits": lsb["from"], "to_bits": lsb["to"]}


def pads(pin):
    return [f"core_pins_{pin.direction}<{pin.lsb + bit}>" for bit in range(pin.width)]


def places(core):
    s = ""
    for pin in filter(lambda p: p.is_pin, core.pins):
        for bit, pad in enumerate(pads(pin)):
            place = pin.places[bit] if pin.places else "..."
            s += (f'{"" if pin.places else "# "}NET "{pad}" LOC = "{place}"; '
                  f"# {core.name}.{pin.name}[{bit}]\n")
    return s


def own_constraints(core):
    """Returns the timing constraints in a core's UCF file. In the file, @name@ stands for the
    instance, and @PORT@ for the list of the pads of that port."""
    s = core.constraints.replace("@name@", core.name)
    for pin in core.pins:
        s = s.replace(f"@{pin.name}@", '" : "'.join(pads(pin)) if pin.is_pin else "")
    return s


def clock_constraints(core):
    """Returns the timing constraints of the separate clock of a core: its period and its crossings.

    A path between this clock and the chip clock may take at most 8 ns, which is less than a period
    of the chip clock (10 ns). Bits that cross together, or a word and its flag, therefore arrive at
    most one clock apart.
    """
    if not core.own_clock:
        return ""
    pin, name = core.pins[-1], core.name
    net = (pads(pin)[0] if pin.is_pin else
           f"u_soc/clk_{name}" if core.multiply else "u_soc/" + source_net(pin))
    return f"""NET "{net}" TNM_NET = "{name}_clk";
TIMESPEC "TS_{name}_clk" = PERIOD "{name}_clk" {1e9 / core.clock_hz:.3f} ns HIGH 50%;
TIMESPEC "TS_{name}_to_soc" = FROM "{name}_clk" TO "soc_clk" 8 ns DATAPATHONLY;
TIMESPEC "TS_soc_to_{name}" = FROM "soc_clk" TO "{name}_clk" 8 ns DATAPATHONLY;
"""


def constraints_of(chip):
    s = f"# {HAND} Pins of cores, for ngdbuild (docs/utilisation.md).\n"
    s += "".join(places(core) for core in chip.cores)
    s += "".join(own_constraints(core) + clock_constraints(core) for core in chip.cores)
    return s + "".join(f'NET "u_soc/u_gate_{c.name}.g_gate.run" MAXDELAY = 4 ns; # to its BUFGCE\n'
                       for c in chip.cores if c.has_gate)


def waits(core):
    """Returns whether an operation of the core's servant may wait for the core."""
    return not core.servant or core.servant.get("waits", True)


def instances_of(chip, slots):
    """Returns the firmware's table of cores. A core without a servant gets the common servant,
    which accesses the core registers by name."""
    headers = set()
    for core in chip.cores:
        headers |= ({core.servant["header"]} if core.servant else
                    {core.folder + "_regs.h", "hw_registers.h"})
    return render("soc_cores.c.j2", chip=chip, slots=slots, headers=sorted(headers))


@functools.cache
def environment():
    return templates.environment(
        Path(__file__).with_name("templates"), HAND=HAND, bits=bits, declared=declared,
        signal_bits=signal_bits, recorded=recorded, parameters_of=parameters_of, net_of=net_of,
        waits=waits, contract_of=contract_of, span=span)


def render(template, **values):
    return environment().get_template(template).render(**values)


def description_of(chip, slots, registers, slices):
    """Returns the description of the chip for programs on the PC. registers: maps the name of a
    block to its *.regs.json; slices: pairs of folder and Slice file."""
    return description.Chip(
        [description.Slot(slot.number, slot.name, registers[slot.name])
         for slot in sorted(slots, key=lambda slot: slot.number)],
        [description.Object(core.identity, core.name,
                            [file for folder, file in slices if folder == core.folder],
                            registers[core.name], "" if core.servant else "::Hw::Registers")
         for core in chip.cores],
        [description.Probe(core.name, core.identity, names_of(core), core.signals)
         for core in chip.cores if core.is_probe]).text()


def files(chip, slots, base):
    """Returns all files about the chip: name -> text."""
    return {"map.regs.json": map_of(chip, base),
            "soc_pins.h": render("soc_pins.h.j2", chip=chip), "core_pins.ucf": constraints_of(chip),
            "core_pins.vh": render("core_pins.vh.j2",
                                   cores=[alone_pins(core) for core in chip.cores]),
            "soc_cores.vh": verilog_of(chip, slots), "soc_cores.c": instances_of(chip, slots)}
