# SPDX-License-Identifier: MIT
"""foreign_bus: writes the files of a core with registers on a bus, for new_foreign.py.

The slot has a Wishbone or an AXI4-Lite adapter. A few gates convert other buses to Wishbone. If the
core has no acknowledge, the wrapper generates it: at once, after some clocks, or in APB's access
phase.
"""
import json

from icesoc.cores.foreign_roles import AXI, LOW, is_answer
from icesoc.cores.foreign_files import connected_ports, pin_name, render, vector
from icesoc.util.spelling import option

BUSES = {"wishbone": "Wishbone", "apb": "APB", "axil": "AXI4-Lite",
         "memory": "select, address and data",
         "own": "a custom bus", "avalon": "Avalon-MM"}
WISHBONE = ["cyc", "stb", "we", "adr", "sel", "wdata", "rdata", "ack", "err", "rty", "stall"]
WIDTHS = {"sel": 4, "strobes": 4, "wdata": 32, "rdata": 32, "wstrb": 4, "bresp": 2, "rresp": 2,
          "awprot": 3, "arprot": 3}
ADDRESSES = ("adr", "words", "bytes", "awaddr", "araddr")


class Core:
    """A third-party core. `roles`: role of each port. `latency`: number of clocks after which a
    core without ack answers. `address`: "words", "bytes" or None. `macros`: names and values as
    macros_of returns them."""

    def __init__(self, name, top, bus, ports, roles, latency, params, clock, address, macros):
        # The core may have one ack for reads and another for writes, or one for both.
        acks = [n for n in ports if roles[n] == "ack"]
        self.acks = {n: f"ack_{i}" for i, n in enumerate(acks)} if len(acks) > 1 else {}
        self.name, self.top, self.bus, self.ports = name, top, bus, ports
        self.roles = {**roles, **self.acks}
        roles = self.roles
        self.latency, self.params, self.clock, self.macros = latency, params, clock, macros
        self.by_role = {r.removesuffix("_n"): p for n, p in ports.items() if (r := roles[n])}
        self.pins = [(pin_name(n, p), p) for n, p in ports.items() if not roles[n]]
        self.data_width = max(len(self.by_role[r]["bits"]) for r in ("wdata", "rdata"))
        self.signals = AXI if bus == "axil" else WISHBONE
        self.has_strobes = bus == "avalon" or {"stb", "strobe"}.isdisjoint(self.by_role)
        self.adr_bits, self.word_bits, self.unit = 6, 0, ""
        self.step = 1  # difference between the addresses of two consecutive words
        for n, p in ports.items():
            if roles[n] in ADDRESSES:
                self.count_words(roles[n], p, address)

    def pin_table(self):
        """Returns the pins in the form used in a manifest."""
        return [{"name": n, "width": len(p["bits"])} if len(p["bits"]) > 1 else {"name": n}
                for n, p in self.pins]

    def count_words(self, role, port, address):
        """Detects whether an address counts words or bytes, and how many bits of the address select
        a word. On an APB with 8 or 16 data bits, the addresses of registers are assumed to have no
        gaps."""
        width, lsb = len(port["bits"]), port.get("offset", 0)
        step, reason = 4, "as given"
        if address or role in ("words", "bytes"):
            step = 1 if (address or role) == "words" else 4
        elif lsb > 1:
            reason = f"it begins at bit {lsb}"
        elif self.bus == "apb" and self.data_width in (8, 16) and not self.macros:
            step, reason = self.data_width // 8, f"the data of this APB has {self.data_width} bits"
        elif self.bus in ("apb", "axil", "avalon"):
            step, reason = 1 if self.bus == "avalon" else 4, f"{BUSES[self.bus]} does"
        elif lsb:
            reason = f"it begins at bit {lsb}"
        elif self.macros:
            reason = f"{', '.join(self.macros)} are multiples of 4"
        elif width < 16 or width == 30:
            step, reason = 1, f"it has {width} bits"
        elif width < 30 and self.data_width < 32:
            step, reason = 1, f"it has {width} bits, and data {self.data_width}"
        else:
            reason = f"it has {width} bits"
        unit, other = ("words", "bytes") if step == 1 else ("bytes", "words")
        if step == 1 and self.bus == "apb" and not address and role not in ("words", "bytes"):
            # byte addresses, with a word of four bytes for each register
            unit, other = "bytes, each a register", "bytes"
        self.unit = f"counts {unit}: {reason}" + (
            "" if reason == "as given" else f"; if not, {option('address', other)}")
        lsb = lsb if step > 1 else 0
        self.step, gap = step, step.bit_length() - 1
        self.word_bits = max(0, width + lsb - gap)
        self.adr_bits = max(self.adr_bits, self.word_bits + 2, width + lsb)
        self.slice = f"[{width + lsb + 1 - gap}:{lsb + 2 - gap}]"

    def width(self, signal):
        return self.adr_bits if signal in ADDRESSES else WIDTHS.get(signal, 1)


def connection(core, role, port, interrupts):
    """Returns the expression that is connected to a port with a role. For an interrupt, also
    appends (width, wire, value) to `interrupts`."""
    width = len(port["bits"])
    if role in LOW:
        return f"{{{width}{{!({connection(core, role[:-2], {'bits': [0]}, interrupts)})}}}}"
    # True: the core has no select, so its read and write signals start an access
    strobes = core.has_strobes
    own = {"strobe": "stb", "re": "stb && !we" if strobes else "!we",
           "we": "stb && we" if strobes else "we"}
    # such a port may have one bit per byte; all bits get the same value
    if role in ("stb", "strobe", "re", "we"):
        to = own.get(role, role) if core.bus in ("own", "avalon") else role
        return f"{{{width}{{{to}}}}}" if width > 1 else to
    if role in ("interrupt", "interruptn"):
        wire, of_many = f"interrupt_{len(interrupts)}", width > 1
        value = "|" * of_many + wire if role == "interrupt" else "!" + "&" * of_many + wire
        interrupts.append((width, wire, value))
        return wire
    if role in ADDRESSES:
        return ("adr" if role in ("words", "bytes") else role) + core.slice
    if "enable" in core.by_role:
        role = {"ack": "ready", "err": "refused", "sel": "strobes"}.get(role, role)
    if role in ("wdata", "sel", "strobes", "wstrb", "rdata") and width < core.width(role):
        return f"{role}[{width - 1}:0]"
    fixed = {"clock": "clk_i", "reset": "rst_i", "resetn": "!rst_i", "low": f"{width}'d0",
             "open": "",
             "high": f"{{{width}{{1'b1}}}}", "1": f"{width}'d1", "2": f"{width}'d2"}
    return fixed.get(role, role)


def answers(core):
    """Returns declarations, lines, and the expressions of ack and err. For a core without an
    acknowledge, the lines generate it."""
    if core.acks:
        acks = list(core.acks.values())
        return [f"    wire {', '.join(acks)};"], [], {"ack": " || ".join(acks)}
    taken = "stb && !stall" if "stall" in core.by_role else "stb"
    if "valid" in core.by_role:
        return ["    wire valid;"], [], {"ack": f"{taken} && we || valid"}
    if core.latency:
        last = core.latency - 1
        shift = f"{{answered[{last - 1}:0], {taken}}}" if last else taken
        return ([f"    reg [{last}:0] answered; // the core answers {core.latency} clocks after the"
                 " strobe"],
                [f"    always @(posedge clk_i) answered <= rst_i ? {core.latency}'d0 : {shift};"],
                {"ack": f"answered[{last}]"})
    if "enable" in core.by_role:
        made = [f"    assign {signal} = {value};"
                for role, signal, value in (("ack", "ready", "1'b1"), ("err", "refused", "1'b0"))
                if role not in core.by_role]
        return (["    reg access; // APB's access phase, from a transfer's second clock on; ready "
                 "counts only in it",
                 "    wire enable, ready, refused;",
                 "    wire [3:0] strobes;"],
                ["    always @(posedge clk_i) access <= stb && !rst_i;",
                 "    assign enable = stb && access;",
                 "    assign strobes = sel & {4{we}}; // none in a read", *made],
                {"ack": "enable && ready && !refused", "err": "enable && ready && refused"})
    return [], [], {"ack": taken} if core.bus in (
        "memory", "own", "avalon") and "ack" not in core.by_role else {}


def connected(core, name, port, interrupts):
    """Returns the expression that is connected to a port. A port without a role is connected to a
    pin."""
    role = core.roles[name]
    return connection(core, role, port, interrupts) if role else pin_name(name, port)


def module(core):
    """Returns the slot's Verilog."""
    interrupts = []
    connections, unused = connected_ports(
        core.ports, lambda name, port: connected(core, name, port, interrupts))
    wires, lines, made = answers(core)
    wires += unused
    for s in core.signals:
        value = made.get(s) or (f"{core.width(s)}'d0" if is_answer(s)
                                and s not in core.by_role else "")
        wires.append(f"    wire {vector(core.width(s))}{s}{' = ' + value if value else ''};")
    wires += [f"    wire {vector(width)}{wire};" for width, wire, _ in interrupts]
    irq = " || ".join(value for *_, value in interrupts) or "1'b0"
    rdata = len(core.by_role["rdata"]["bits"])
    if rdata < 32:
        lines.append(f"    assign rdata[31:{rdata}] = {32 - rdata}'d0;")
    names = {s: ("axi_" if core.bus == "axil" else "wb_") + s for s in core.signals}
    if core.bus != "axil":
        names["wdata"] = names["rdata"] = "wb_dat"
    adapter = [f".{names[s]}_{'i' if is_answer(s) else 'o'}({s})" for s in core.signals]
    takes_strobes = core.bus == "own" and core.has_strobes or {"stall", "valid", "strobe"} & set(
        core.by_role)
    options = ", .PIPELINED(1)" if takes_strobes or core.latency else ""
    # the adapter aborts an access after 250 chip clocks, earlier than bus_crossing would
    if core.clock:
        options += f", .TIMEOUT({max(2, 250 * core.clock // 100000000 - 6)})"
    kind = "bus_to_axi4lite" if core.bus == "axil" else "bus_to_wishbone"
    return render("bus.v.j2", name=core.name, what=f"{core.top} behind {kind}", pins=core.pins,
                  has_memory=False, core=core, kind=kind, lines=wires + lines, irq=irq,
                  options=options, adapter=adapter, connections=connections,
                  unused=[s for s in core.signals if not is_answer(s)])


def description(core, words):
    """Returns the register description (*.regs.json). `words`: names of registers by word
    address."""
    letters = (core.name.replace("_", "") + "x").upper()
    width = {} if core.data_width >= 32 else {"width": core.data_width}
    registers = [{"word": 3, "name": "PAGE", "access": "rw",
                  "doc": "byte address in the core of word 8", "fields": [
        {"name": "ADDRESS", "lsb": 0, "width": core.adr_bits, "doc": "a multiple of 32"}]}]
    registers += [{"word": 8 + a % 8, "page": a // 8 * 32, "name": n, "access": "rw", **width,
                   "doc": f"at {core.step * a:#x} in the core"} for a, n in words.items()]
    return {"block": core.name, "doc": f"The third-party core {core.top}, by {BUSES[core.bus]}.",
            "type": f"0x{ord(letters[0]):02X}{ord(letters[1]):02X}", "version": "0x0100",
            "registers": registers,
            "events": [{"name": "CORE", "bit": 0, "doc": "the core's interrupt line was high"},
                       {"name": "TIMEOUT", "bit": 1, "doc": "the core did not answer"}]}


def texts(core, words):
    """Returns the files by name. `words`: names of registers by word address; may be empty."""
    words = words or {a: f"REG{a}" for a in range(min(32, 1 << core.word_bits))}
    first = next(iter(words.values()))
    suite = "".join(w.capitalize() for w in core.name.split("_"))
    named = {"name": core.name, "first": first, "suite": suite}
    return {f"{core.name}.v": module(core),
            f"{core.name}_test.cpp": render("bus_test.cpp.j2", **named),
            f"{core.name}.regs.json": json.dumps(description(core, words), indent=2) + "\n",
            "ground.py": render("bus_ground.py.j2", **named)}, "registers: " + " ".join(
                words.values())
