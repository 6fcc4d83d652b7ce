# SPDX-License-Identifier: MIT
"""verilog: returns Verilog expressions for register blocks; the templates *.v.j2 use them."""
import textwrap

COLUMNS = 100


def span(width):
    """Returns the range of a vector, such as [31:0]; empty for one bit."""
    return "" if width == 1 else f"[{width - 1}:0]"


def cut(vector, lsb, width, of=32):
    """Returns the expression for `width` bits of a vector, starting with bit `lsb`. `of`: width of
    the vector."""
    if width == of:
        return vector
    return f"{vector}[{lsb}]" if width == 1 else f"{vector}[{lsb + width - 1}:{lsb}]"


def number(value, width):
    return f"{width}'d0" if value == 0 else f"{width}'h{value:0{(width + 3) // 4}X}"


def padded(parts, width=32, indent=0):
    """Returns a concatenation of (lsb, width, expression) parts, with zeros between them. If the
    result would be too long for one line, starting at column `indent`, it has several lines."""
    texts, top = [], width
    for lsb, wide, text in sorted(parts, reverse=True):
        if lsb + wide < top:
            texts.append(f"{top - lsb - wide}'d0")
        texts.append(text)
        top = lsb
    if top:
        texts.append(f"{top}'d0")
    if len(texts) == 1:
        return texts[0]
    if indent + len(", ".join(texts)) + 3 <= COLUMNS:
        return "{" + ", ".join(texts) + "}"
    return "{\n" + "\n".join(wrapped(", ".join(texts), " " * 16, " " * 16)) + "}"


def shown(r, indent=0):
    """Returns the expression for the read value of a register."""
    return padded([(p.lsb, p.width, r.port(p) + ("_o" if r.holds(p) else "_i")) for p in r.parts],
                  32, indent)


def event_inputs(b, indent=0):
    return padded([(e.bit, 1, f"{e.lower}_event_i") for e in b.events], b.event_bits, indent)


def aligned(rows, mark):
    """Returns a line for each pair of texts: the left text, the mark, the right text. All marks are
    in the same column."""
    broad = max((len(left) for left, _ in rows), default=0)
    return [f"{left:{broad}}{mark}{right}" for left, right in rows]


def write_signals(b):
    """Returns (name, register, lock) for each register that software can write. The register block
    has a signal NAME_write, which is high in the clock of a write."""
    return [("event", "EVENT", ""), ("mask", "MASK", "")] + [
        (r.lower, r.name, r.lock) for r in b.own_registers if r.is_written]


def write_wires(b):
    """Returns the declarations of the signals NAME_write (see write_signals)."""
    rows = [(f"{name}_write", f"write && bus_addr_i == {b.prefix}_{word}"
             f"{f' && !{lock}_i' if lock else ''};") for name, word, lock in write_signals(b)]
    return ["    wire " + line for line in aligned(rows, " = ")]


def outputs(b):
    """Returns the assignments of outputs that are not registers."""
    rows = []
    for r in b.own_registers:
        if r.has_write_strobe:
            rows.append((f"{r.lower}_write_o", f"{r.lower}_write;"))
        if r.reads:
            rows.append((f"{r.lower}_read_o",
                         f"bus_valid_i && !bus_write_i && bus_addr_i == {b.prefix}_{r.name};"))
        for p in r.parts:
            bits = cut("bus_wdata_i", p.lsb, p.width)
            if r.is_pulse(p) and not r.registered:
                rows.append((f"{r.port(p)}_o", f"{r.lower}_write && {bits};"))
            elif r.written_bits(p):
                rows.append((f"{r.port(p)}_o", f"{bits};"))
    memory = [f"{r.lower}_write" for r in b.stored_in("memory")]
    if memory:
        rows.append(("memory_write_o", " || ".join(memory) + ";"))
    return ["    assign " + line for line in aligned(rows, " = ")]


def read_cases(b):
    """Returns the cases of the read multiplexer. All words in the RAM share one case."""
    label = b.prefix + "_"
    short = [("ID:", f"{label}ID_VALUE"), ("EVENT:", padded([(0, b.event_bits, "events")])),
             ("MASK:", padded([(0, b.event_bits, "mask")]))]
    short += [(r.name + ":", shown(r, 40)) for r in b.own_registers
              if r.is_read and r.storage != "ram"]
    ram = [label + r.name for r in b.stored_in("ram")]
    rows = [(label + name, f"rdata = {value};") for name, value in short]
    lines = aligned(rows + [("default:", "rdata = 32'd0;")], " ")
    if ram:
        lines[-1:-1] = [*wrapped(", ".join(ram) + ":", "", ""), "    rdata = kept;"]
    return [" " * 12 + line for line in lines]


def declared(port, is_last):
    """Returns the lines that declare a port."""
    kind = "input  wire" if not port.is_out else "output reg " if port.is_reg else "output wire"
    line = f"    {kind} {span(port.width):6} {port.name}{'' if is_last else ','}"
    return commented(line, port.group, port.doc, "// ")


def commented(line, group, doc, mark):
    """Returns the lines of a port: the title of the group if the port begins one, the port, and the
    port's comment. The comment follows the port on the same line, or precedes the port if the
    comment is too long."""
    doc, before = plain(doc), "    " + mark
    lines = wrapped(group, before, before) if group else []
    if doc and len(line) + 1 + len(mark) + len(doc) > COLUMNS:
        return [*lines, *wrapped(doc, before, before), line]
    return [*lines, f"{line} {mark}{doc}" if doc else line]


def wrapped(text, first, others):
    return textwrap.wrap(plain(text), COLUMNS, initial_indent=first, subsequent_indent=others,
                         break_long_words=False, break_on_hyphens=False)


def plain(text):
    """Returns a text that is safe in a comment: tools do not take it as a directive, and no
    backslash at its end continues the line."""
    text = text.replace("/*", "/ *").replace("*/", "* /")
    if text.split(" ")[0].lower() in ("verilator", "synopsys", "synthesis", "pragma", "psl",
                                      "xilinx", "altera", "coverage", "lint_checking"):
        text = "'" + text
    return text + "." if text.endswith("\\") else text


def tail(text, mark):
    """Returns a comment to append to a line; "" for an empty text."""
    return mark + plain(text) if text else ""


def table(b, mark):
    """Returns the list of registers for the comment at the head of a file."""
    broad = max(len(r.name) for r in b.registers)
    lines = []
    for r in b.registers:
        head = f"{mark}  {r.word:2}  {r.name:{broad}}  {r.access:3}  "
        lines += wrapped(r.doc, head, mark + " " * (len(head) - len(mark)))
    return lines


GLOBALS = {function.__name__: function for function in (
    span, shown, plain, cut, number, padded, event_inputs, declared, wrapped, tail, table,
    write_wires, outputs, read_cases)}
