# SPDX-License-Identifier: MIT
"""vhdl: returns VHDL expressions for register blocks; the templates *.vhd.j2 use them."""
from icesoc.regs.names import SLOT_PORTS
from icesoc.regs.verilog import aligned, commented, write_signals


def kind(width):
    return "std_logic" if width == 1 else f"std_logic_vector({width - 1} downto 0)"


def part(vector, lsb, width, of=32):
    if width == of:
        return vector
    return f"{vector}({lsb})" if width == 1 else f"{vector}({lsb + width - 1} downto {lsb})"


def bits(value, width):
    """Returns a constant of `width` bits."""
    if width == 1:
        return f"'{value}'"
    return "(others => '0')" if value == 0 else f'"{value:0{width}b}"'


def vhdl_ports(b):
    """Returns the lines of the port list."""
    ports = [(name, is_out, width, "", "") for name, is_out, width in SLOT_PORTS]
    ports += [(p.name, p.is_out, p.width, p.doc, p.group) for p in b.ports]
    broad, lines = max(len(p[0]) for p in ports), []
    for n, (name, is_out, width, doc, group) in enumerate(ports):
        line = f"    {name:{broad}} : {'out' if is_out else 'in '} {kind(width)}"
        line += ";" if n + 1 < len(ports) else ""
        lines += commented(line, group, doc, "-- ")
    return lines


def signals_of(b):
    """Returns (name of the signal, field) for each field that flip-flops of the block hold."""
    return [(r.port(p) + "_value", p) for r in b.own_registers for p in r.held_parts]


def vhdl_writes(b):
    rows = []
    for name, word, lock in write_signals(b):
        held = f" and {lock}_i = '0'" if lock else ""
        rows.append((f"{name}_write", f"'1' when write = '1' and word = {b.prefix}_{word}{held} "
                     "else '0';"))
    return ["  " + line for line in aligned(rows, " <= ")]


def vhdl_outputs(b):
    rows = []
    for r in b.own_registers:
        if r.has_write_strobe:
            rows.append((f"{r.lower}_write_o", f"{r.lower}_write;"))
        if r.reads:
            rows.append((f"{r.lower}_read_o",
                         "'1' when bus_valid_i = '1' and bus_write_i = '0' and "
                         f"word = {b.prefix}_{r.name} else '0';"))
        for p in r.parts:
            source = part("bus_wdata_i", p.lsb, p.width)
            if r.is_pulse(p) and r.registered:
                continue
            if r.is_pulse(p):
                rows.append((f"{r.port(p)}_o", f"{r.lower}_write and {source};"))
            elif r.written_bits(p):
                rows.append((f"{r.port(p)}_o", f"{source};"))
            elif r.holds(p):
                rows.append((f"{r.port(p)}_o", f"{r.port(p)}_value;"))
    memory = [f"{r.lower}_write" for r in b.stored_in("memory")]
    if memory:
        rows.append(("memory_write_o", " or ".join(memory) + ";"))
    return ["  " + line for line in aligned(rows, " <= ")]


def vhdl_reads(b):
    """Returns (label, [(target, value)]) for each case of the read multiplexer."""
    n, arms = b.event_bits, []
    data = f"bus_rdata_o({n - 1} downto 0)"
    arms.append(("ID", [("bus_rdata_o",
                         f'x"{b.type:04X}{b.version:04X}"')]))
    arms += [("EVENT", [(data, "events")]), ("MASK", [(data, "mask")])]
    for r in b.own_registers:
        if r.is_read and r.storage in ("core", "flip-flops"):
            arms.append((r.name, [(part("bus_rdata_o", p.lsb, p.width),
                                   r.port(p) + ("_value" if r.holds(p) else "_i"))
                                  for p in r.parts]))
    return arms


def word_cover(b):
    """Returns the words of the registers in the block as a choice of a VHDL case, such as 0 to 10 |
    13."""
    words, runs = sorted(r.word for r in b.registers), []
    for word in words:
        if runs and runs[-1][1] == word - 1:
            runs[-1][1] = word
        else:
            runs.append([word, word])
    return " | ".join(str(a) if a == z else f"{a} to {z}" for a, z in runs)


GLOBALS = {function.__name__: function for function in (
    kind, part, bits, vhdl_ports, signals_of, write_signals, vhdl_writes, vhdl_outputs, vhdl_reads,
    word_cover)}
