# SPDX-License-Identifier: MIT
"""core_output: the chip's cores as address map, as instances in soc.v, and as the firmware's table.

The chip is coremap.Chip, slots are coremap.Slot.
"""
import copy
import json

CORE_PINS = 32  # pins in each direction
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
    """Returns the wire of the output, core.pin, that drives this input."""
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
    """Returns the hash of the register properties that software relies on."""
    lines = [json.dumps(block.description["type"])]
    for r in block.own_registers:
        lines.append(f"{r.word} {r.page} {r.name} {r.access} {r.width}")
        lines += [f"{r.name}.{f.name} {f.lsb} {f.width}"
                  f"{'' if f.access == r.access else ' ' + f.access}" for f in r.fields]
    lines += [f"{e.name} {e.bit}" for e in block.events]
    # The order in the file does not matter.
    return hash_of("".join(line + "\n" for line in sorted(lines)))


def change_words(probe):
    """Returns the 64-bit words of a probe's change: for 31, 95 or 223 bits (ip/probe/probe.v)."""
    recorded = sum(width for _, width in probe.signals)
    return 1 if recorded <= 31 else 2 if recorded <= 95 else 4


def names_of(probe):
    """Returns the hash of the names and widths of a probe's signals."""
    return hash_of("".join(f"{name}:{width}\n" for name, width in probe.signals))


def probes_of(chip):
    probes = {c.name: {"identity": c.identity, "names": names_of(c), "signals": c.signals}
              for c in chip.cores if c.is_probe}
    return json.dumps(probes, separators=(",", ":")) + "\n"


def probed(chip):
    """Returns the signals of probes by hierarchical names.

    Yosys joins a wire of such a name with the signal when it flattens the chip.
    """
    probes = [c for c in chip.cores if c.is_probe]
    if not probes:
        return ""
    joined, in_yosys, elsewhere, ends = {}, "", "", ""
    for c in probes:
        taps = [(f"{c.name}_{i}", *s, s[1]) for i, s in enumerate(c.signals)]
        count = (f"cycles_{c.name}", "u_system_slot.cycles", 64, 32)
        for wire, signal, of, width in [*taps, count]:
            joined.setdefault(signal, of)
            part = f"[{width - 1}:0]" if width < of else ""
            in_yosys += f"    {declared(width, wire)} = \\{signal} {part};\n"
            elsewhere += f"    {declared(width, wire)} = {signal}{part};\n"
        width = 64 * change_words(c) - 33
        spare = width - sum(w for _, w in c.signals)
        wires = ([f"{spare}'d0"] if spare else []) + [wire for wire, *_ in reversed(taps)]
        ends += f"    {declared(width, 'signals_' + c.name)} = {{{', '.join(wires)}}};\n"
    joins = "".join(f"    (* hierconn *) {declared(of, chr(92) + signal)} ;\n"
                    for signal, of in joined.items())
    return (f"    // What probes record.\n`ifdef YOSYS\n{joins}{in_yosys}`else\n{elsewhere}`endif\n"
            f"{ends}\n")


def parameters_of(core):
    hz = ("CLK_HZ" if not core.own_clock else
          f"CLK_HZ / {core.divide} * {core.multiply}" if core.multiply else core.own_clock)
    given = [f".CLK_HZ({hz})"] if core.has_clock else []
    if core.is_probe:
        given += [f".WORDS({change_words(core)})", f".NAMES(32'h{names_of(core):08X})"]
    return f"#({', '.join(given)}) " if given else ""


def net_of(core, pin):
    """Returns the connection of a core's pin."""
    if pin.source:
        return source_net(pin)
    if core.multiply and pin.name == "clock_i":
        return "clk_" + core.name
    if pin.direction == "o":
        return f"pin_{core.name}_{pin.name}"
    return f"{pin.width}'d0" if pin.internal else "core_pins_i" + bits(pin.lsb, pin.width)


def slot_of(n):
    """Returns the connections of the register bus of slot n."""
    return f"""        .bus_valid_i(slot_valid[{n}]), .bus_write_i(slot_write),
        .bus_addr_i(slot_addr[{4 * n} +: 4]), .bus_wdata_i(slot_wdata),
        .bus_ready_o(slot_ready[{n}]), .bus_rdata_o(slot_rdata[{32 * n} +: 32]),
        .bus_error_o(slot_error[{n}]),
"""


def port_of(n):
    """Returns the connections of memory port n, without a comma at the end."""
    return f"""        .npi_addr_o(npi_addr[{32 * n} +: 32]), .npi_addr_req_o(npi_addr_req[{n}]),
        .npi_addr_ack_i(npi_addr_ack[{n}]), .npi_rnw_o(npi_rnw[{n}]),
        .npi_size_o(npi_size[{4 * n} +: 4]), .npi_rmw_o(npi_rmw[{n}]),
        .npi_wr_data_o(npi_wr_data[{64 * n} +: 64]), .npi_wr_be_o(npi_wr_be[{8 * n} +: 8]),
        .npi_wr_push_o(npi_wr_push[{n}]), .npi_wr_empty_i(npi_wr_empty[{n}]),
        .npi_wr_almost_full_i(npi_wr_almost_full[{n}]), .npi_wr_flush_o(npi_wr_flush[{n}]),
        .npi_rd_data_i(npi_rd_data[{64 * n} +: 64]), .npi_rd_word_i(npi_rd_word[{4 * n} +: 4]),
        .npi_rd_pop_o(npi_rd_pop[{n}]), .npi_rd_empty_i(npi_rd_empty[{n}]),
        .npi_rd_flush_o(npi_rd_flush[{n}]), .npi_init_done_i(npi_init_done[{n}])"""


def instance(core):
    name, slot = core.name, core.slot
    s = f"    // {name}: ip/{core.folder}\n"
    if core.multiply:
        s += (f"    wire clk_{name};\n    core_clock #(.MULTIPLY({core.multiply}), "
              f".DIVIDE({core.divide})) u_clock_{name} (.clk_i(clk_i), .clk_o(clk_{name}));\n")
    if core.says_idle:
        s += (f"    wire clk_{name}, idle_{name};\n    core_gate #(.GATED("
              f"{'1' if core.has_gate else 'GATES'})) u_gate_{name} (.clk_i(clk_i), .rst_i(rst), "
              f".access_i(slot_valid[{slot}]), .idle_i(idle_{name}), .clk_o(clk_{name}));\n")
    clock = f"clk_{name}" if core.says_idle else "clk_i"
    module = core.folder + ("_clocked" if core.own_clock else "")
    s += (f"    {module} {parameters_of(core)}u_{name} (\n        .clk_i({clock}), .rst_i(rst),\n"
          f"{slot_of(slot)}        .irq_o(slot_irq[{slot}])")
    s += ",\n" + port_of(core.port) if core.port >= 0 else ""
    s += f",\n        .idle_o(idle_{name})" if core.says_idle else ""
    if core.is_probe:
        s += f",\n        .cycles_i(cycles_{name}), .signals_i(signals_{name})"
    for pin in core.pins:
        s += f",\n        .{pin.name}({net_of(core, pin)})"
    return s + "\n    );\n"


def empty(slot):
    return f"""    // slot {slot} is empty
    assign slot_ready[{slot}] = slot_valid[{slot}];
    assign slot_rdata[32*{slot} +: 32] = 32'd0;
    assign slot_error[{slot}] = 1'b1;
    assign slot_irq[{slot}]   = 1'b0;

"""


def verilog_of(chip, slots):
    contracts = [0] * chip.slots
    for slot in slots:
        contracts[slot.number] = contract_of(slot.block)
    hashes = ", ".join(f"32'h{contract:08X}" for contract in reversed(contracts))
    outputs = [(f"pin_{c.name}_{p.name}", p) for c in chip.cores for p in c.pins
               if p.direction == "o"]
    s = (f"// {HAND} Cores in their slots, for soc.v.\n\n"
         f"    localparam [32*{chip.slots}-1:0] CONTRACTS = {{{hashes}}};\n"
         "\n")
    s += "".join(f"    {declared(pin.width, net)};\n" for net, pin in outputs)
    s += probed(chip)
    s += "".join(instance(core) + "\n" for core in chip.cores)
    used = [core.slot for core in chip.cores]
    s += "".join(empty(slot) for slot in range(chip.first, chip.slots) if slot not in used)
    s += "".join(f"    assign core_pins_o{bits(pin.lsb, pin.width)} = {net};\n"
                 for net, pin in outputs if not pin.internal)
    spare = CORE_PINS - chip.pins["o"]
    if spare:
        s += f"    assign core_pins_o{bits(chip.pins['o'], spare)} = {spare}'d0;\n"
    unused = "".join(f", {net}" for net, pin in outputs if pin.internal)
    return s + f"    wire unused_pins = &{{1'b0, core_pins_i, GATES != 0{unused}, 1'b0}};\n"


def pin_table_of(chip):
    rows = "".join(f'    {{"{c.name}.{p.name}", {p.lsb}, {p.width}, '
                   f'{"true" if p.direction == "o" else "false"}}},\n'
                   for c in chip.cores for p in c.pins if p.is_pin)
    return f"""// {HAND} Pins of cores, by name.
struct CorePin {{
    const char* name; // instance.port
    unsigned lsb, width; // in core_pins_i or core_pins_o
    bool isOut;
}};
constexpr CorePin corePins[] = {{
{rows}    {{nullptr, 0, 0, false}}}};
"""


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
    """Returns the core's timing constraints: @name@ is the instance, @port@ its pads, a list for a
    bus."""
    s = core.constraints.replace("@name@", core.name)
    for pin in core.pins:
        s = s.replace(f"@{pin.name}@", '" : "'.join(pads(pin)) if pin.is_pin else "")
    return s


def clock_constraints(core):
    """Returns the period of a core's separate clock.

    Between it and the chip's a path has 8 ns, so two bits, or a word and its flag, arrive at most a
    clock of 10 ns apart.
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


def servant_of(core):
    """Returns the C of one core's servant: its own, or the one for a core without its own."""
    name, upper = f"core_{core.name}", core.name.upper()
    if core.servant:
        table, kind, arguments = "", core.servant["type"], f"MAP_MEMORY_{upper}"
    else:
        block, kind = core.folder.upper(), "Hw_Registers_Core"
        table = f"static const Hw_Register {name}_table[] = {{{block}_TABLE}};\n"
        arguments = (f"{block}_ID_VALUE, {name}_table,\n"
                     f"        (Ice_Int)(sizeof {name}_table / sizeof {name}_table[0])")
    if core.servant and not core.servant.get("waits", True):  # no call of its waits for the core
        interrupt, poll = f"Hw_Core_interrupt(&{name}.core)", "(void)nowMs;\n    return HW_NEVER"
    else:
        interrupt, poll = f"{kind}_interrupt(&{name})", f"return {kind}_poll(&{name}, nowMs)"
    return f"""
{table}static {kind} {name};
static Hw_Status {name}_start(const Hw_Port *port, void *context) {{
    return {kind}_init(&{name}, MAP_SLOT_{upper}, {arguments}, port, context);
}}
static void {name}_interrupt(void) {{
    {interrupt};
}}
static U32 {name}_poll(U32 nowMs) {{
    {poll};
}}
"""


def instances_of(chip, slots):
    headers = set()
    table = ""
    for core in chip.cores:
        headers |= ({core.servant["header"]} if core.servant else
                    {core.folder + "_regs.h", "hw_registers.h"})
        own = "core_" + core.name
        table += (f'    {{"{core.identity}", MAP_SLOT_{core.name.upper()}, '
                  f"(Ice_ObjectPtr)&{own}.servant, {own}_start, {own}_interrupt, {own}_poll}},\n")
    contracts = ",".join(f'\n    {{{{{len(slot.name)}, "{slot.name}"}}, {slot.number}, 0, '
                         f"(Ice_Int)0x{contract_of(slot.block):08X}U}}" for slot in slots)
    includes = "".join(f'#include "{header}"\n' for header in sorted(headers))
    return f"""/* {HAND}
 * The firmware's cores: what hw_instance.h declares. */
#include "hw_instance.h"
#include "map_regs.h"
{includes}{"".join(map(servant_of, chip.cores))}
const Hw_Instance hw_instances[] = {{
{table}    {{0, 0, 0, 0, 0, 0}}}};

const Hw_Contract hw_contracts[MAP_CONTRACTS] = {{{contracts}}};
"""


def objects_of(chip, registers, slices):
    """Returns the cores' objects as JSON: identity, Slice files, and register description.
    registers: file by folder; slices: pairs of folder and file."""
    return json.dumps([
        {"identity": core.identity, "core": core.name, "registers": registers[core.folder],
         "slice": [file for folder, file in slices if folder == core.folder],
         **({} if core.servant else {"interface": "::Hw::Registers"})}
        for core in chip.cores], indent=1) + "\n"


def files(chip, slots, base):
    """Returns the chip's files: name -> text."""
    return {"map.regs.json": map_of(chip, base), "probes.json": probes_of(chip),
            "soc_pins.h": pin_table_of(chip), "core_pins.ucf": constraints_of(chip),
            "soc_cores.vh": verilog_of(chip, slots), "soc_cores.c": instances_of(chip, slots)}
