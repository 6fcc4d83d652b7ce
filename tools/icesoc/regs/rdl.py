# SPDX-License-Identifier: MIT
"""rdl: makes register descriptions (*.regs.json) from SystemRDL 2.0.

    ./icesoc contract from-rdl spi.rdl --out FOLDER

Reads a flat subset: addrmap, reg and field. Register n of an addrmap gets word FIRST + n, after the
three words that every slot has. An addrmap that begins with ID, EVENT and MASK, as in icesoc.rdl,
already contains these words. An addrmap <SLOT>_PAGES contains the words that are reached through
the slot's register PAGE. If a register description cannot express something, this is an error with
its line (rdl_properties.py).
"""
import argparse
import json
import os
import re
import sys

from icesoc.regs.model import Block, Wrong, check
from icesoc.regs.rdl_reader import Reader, number, unquoted

HARDWARE_WRITES = {"w", "rw", "wr", "w1", "rw1"}


def fail(line, text):
    raise Wrong(f"{line}: error: {text}")


def number_of(component, name, otherwise):
    """Returns the value of a property that is a number."""
    text = component.get(name)
    if text is None:
        return otherwise
    try:
        return number(text)
    except ValueError as error:
        fail(component.lines.get(name, component.line), f"{name}: {error}")


def text_of(component):
    text = unquoted(component.get("desc") or component.get("name") or '""')
    if "*/" in text:
        fail(component.lines.get("desc", component.line),
             f"expected a text without */, which would end a comment, got \"{text[:60]}\"")
    return text


def present(instances):
    return [i for i in instances if i.component.get("ispresent", "true") == "true"]


def access_of(field, name, line):
    """Returns the access of software to a field."""
    software, writes = field.get("sw", "rw"), []
    if field.is_set("woclr") or field.get("onwrite") == "woclr":
        writes.append("w1c")
    if field.is_set("woset") or field.get("onwrite") == "woset":
        writes.append("w1s")
    if field.is_set("singlepulse"):
        writes.append("ws")
    if len(writes) > 1 or (writes and software not in ("rw", "wr", "w")):
        fail(line, f"{name}: sw = {software} with {' and '.join(writes) or 'nothing'}: a register "
             "description cannot express it")
    if software == "r":
        return "ro"
    if software == "w" and writes != ["ws"]:
        if writes:
            fail(line, f"{name}: sw = w with {writes[0]}: a field that cannot be read has no bits "
                 "to show")
        return "ws"
    return writes[0] if writes else "rw"


def bits_of(instance, name, next_bit):
    """Returns the lowest bit and the width of a field."""
    given = number_of(instance.component, "fieldwidth", None)
    if instance.msb is not None:
        msb, lsb = instance.msb, instance.lsb
    else:
        width = instance.width or (given if instance.width is None else 0)
        width = 1 if width is None else width
        lsb, msb = next_bit, next_bit + width - 1
    top = min(31, number_of(instance.component.parent, "regwidth", 32) - 1)
    if msb > top or msb < lsb:
        fail(instance.line, f"{name} is at bits {msb} to {lsb}: a word has bits {top} to 0")
    if given is not None and given != msb - lsb + 1:
        fail(instance.line, f"{name}: fieldwidth is {given}, its bits are {msb} to {lsb}")
    return lsb, msb - lsb + 1


class Fields:
    """The fields of a register, in the form used in a description."""

    def __init__(self, register, name):
        self.fields, self.accesses, self.strobes = [], [], set()
        self.used, self.written_by_core, self.overlap = 0, False, False
        next_bit = 0
        for instance in present(register.children):
            if instance.component.kind != "field":
                fail(instance.line, f"{name}: expected fields, got {instance.component.kind}")
            lsb, width = bits_of(instance, f"{name}.{instance.name}", next_bit)
            next_bit = lsb + width
            self.add(instance, f"{name}.{instance.name}", lsb, width)

    def add(self, instance, name, lsb, width):
        field, line = instance.component, instance.line
        check_name(instance.name, line)
        access = access_of(field, name, line)
        bits = (1 << width) - 1 << lsb
        if self.used & bits:
            self.overlap = True
            if {access, *self.accesses} != {"ro", "ws"}:
                fail(line, f"{name}: overlaps another field")
        self.used |= bits
        self.accesses.append(access)
        if field.is_set("swmod") or field.is_set("swacc"):
            self.strobes |= {"write"} if access != "ro" else set()
            self.strobes |= {"read"} if field.is_set("swacc") else set()
        made = {"name": instance.name, "lsb": lsb, "width": width, "doc": text_of(field)}
        reset = instance.reset if instance.reset is not None else number_of(field, "reset", None)
        if field.is_set("singlepulse") and (width > 1 or reset):
            fail(line, f"{name}: expected one bit with reset 0, because it is a single pulse")
        if reset:
            if reset >> width:
                fail(line, f"{name}: reset {reset} does not fit {width} bits")
            made["reset"] = f"0x{reset:X}"
        for flag in ("hwset", "hwclr"):
            if field.is_set(flag):
                if access != "rw":
                    fail(line, f"{name}: {flag} is for a field that software reads and writes")
                made[flag] = True
        if access == "rw" and field.get("hw") in HARDWARE_WRITES and not (
                "hwset" in made or "hwclr" in made):
            self.written_by_core = True
        self.fields.append(made)


def check_name(name, line):
    if not re.fullmatch("[A-Za-z][A-Za-z0-9]*(_[A-Za-z0-9]+)*", name):
        fail(line, f"'{name[:60]}': expected a name of letters, digits and single _ between them")


def register_of(instance, word):
    name, register = instance.name, instance.component
    check_name(name, instance.line)
    found = Fields(register, name)
    if not found.fields:
        fail(instance.line, f"{name} has no field")
    kinds = set(found.accesses)
    made = {"word": word, "name": name, "access": kinds.pop() if len(kinds) == 1 else "rw",
            "doc": text_of(register)}
    if set(found.accesses) == {"ro", "ws"} and found.overlap:
        # ro and ws fields overlap: software reads another value than it has written
        made["storage"] = "core"
    elif len(found.accesses) > 1 and len(set(found.accesses)) > 1:
        others = set(found.accesses) - {"ro"}
        if len(others) > 1 or others == {"ws"}:
            fail(instance.line, f"{name} has fields with access {', '.join(found.accesses)}: a "
                 "register has one access, and may also have ro fields")
        made["access"] = others.pop()
        for field, access in zip(found.fields, found.accesses):
            if access == "ro":
                field["access"] = "ro"
    if found.written_by_core and made["access"] == "rw":
        made["storage"] = "core"
    if found.strobes:
        made["strobes"] = sorted(found.strobes)
    whole = found.fields[0]
    if found.overlap or (len(found.fields) == 1 and whole["name"] == "WORD" and whole["lsb"] == 0):
        if found.used != 0xFFFFFFFF:
            made["width"] = found.used.bit_length()
        if not found.overlap and "reset" in whole:
            made["reset"] = whole["reset"]
    else:
        made["fields"] = sorted(found.fields, key=lambda f: f["lsb"])
    return made


def addresses_of(component):
    """Returns (instance, byte address, number of bytes) for each register of an addrmap."""
    alignment = number_of(component, "alignment", 1)
    if alignment < 1 or alignment & alignment - 1:
        fail(component.lines.get("alignment", component.line),
             f"alignment: expected a power of two, got {alignment}")
    found, next_address = [], 0
    for instance in present(component.children):
        register = instance.component
        if register.kind != "reg":
            fail(instance.line, f"expected a reg in an addrmap, got {register.kind}")
        size = number_of(register, "regwidth", 32) // 8
        step = size
        if number_of(register, "accesswidth", 8 * size) > 8 * size:
            fail(register.lines.get("accesswidth", register.line),
                 f"accesswidth: expected at most {8 * size}, the width of {instance.name}")
        if component.get("addressing") == "compact":
            step = min(size, number_of(register, "accesswidth", 8 * size) // 8)
        step = max(step, alignment)
        address = instance.address
        if address is None:
            address = -(-next_address // step) * step
        elif address % size:
            fail(instance.line, f"{instance.name} @ 0x{address:X}: not a multiple of its {size} "
                 "bytes")
        next_address = address + size
        found.append((instance, address, size))
    return found


def unit_of(placed, component):
    """Returns the distance between consecutive words in bytes, which is the same for all registers
    of an addrmap."""
    sizes = {size for *_, size in placed}
    if all(address % 4 == 0 for _, address, _ in placed) and max(sizes) <= 4:
        return 4 if len(placed) > 1 else min(sizes)
    if len(sizes) > 1:
        fail(component.line, f"registers of {' and '.join(str(8 * s) for s in sorted(sizes))} bits "
             "share words of 32 bits: give them one regwidth, or addresses that are multiples of 4")
    return sizes.pop()


def check_common(found, line):
    """Checks the registers ID, EVENT and MASK, which each slot has in words 0, 1 and 2."""
    if [r["word"] for r in found] != [0, 1, 2]:
        fail(line, "ID, EVENT and MASK: expected words 0, 1 and 2")
    ident, events, masks = ([(f["name"], f["lsb"], f["width"]) for f in r.get("fields", [])]
                            for r in found)
    if ident and ident != [("VERSION", 0, 16), ("TYPE", 16, 16)]:
        fail(line, "ID: expected the fields VERSION[15:0] and TYPE[31:16]")
    if events != masks or any(width != 1 for *_, width in events):
        fail(line, "EVENT and MASK: expected the same fields of one bit in both")


def block_of(name, component, first):
    check_name(name, component.line)
    placed = addresses_of(component)
    unit = unit_of(placed, component) if placed else 4
    registers = [register_of(instance, address // unit) for instance, address, _ in placed]
    lines = {instance.name: instance.line for instance, *_ in placed}
    letters = (re.sub(r"[^A-Za-z]", "", name) + "XX")[:2].upper()
    block = {"block": name.lower(), "doc": text_of(component)}
    if "memory_bytes" in component.properties:
        block.update(memory_port=True, memory_bytes=number_of(component, "memory_bytes", 0))
    block.update(type=f"0x{int.from_bytes(letters.encode(), 'big'):04X}", version="0x0100")
    events = []
    if [r["name"] for r in registers[:3]] == ["ID", "EVENT", "MASK"]:
        check_common(registers[:3], lines["ID"])
        resets = {f["name"]: f.get("reset") for f in registers[0].get("fields", [])}
        for key, field in (("type", "TYPE"), ("version", "VERSION")):
            if resets.get(field):
                block[key] = f"0x{int(resets[field], 16):04X}"
        events = [{"name": f["name"], "bit": f["lsb"], "doc": f["doc"]}
                  for f in registers[1].get("fields", [])]
        registers = registers[3:]
    else:
        for register in registers:
            register["word"] += first
    for register in registers:
        if register["word"] > 15:
            fail(lines[register["name"]], f"{register['name']}: expected a word from 0 to 15, got "
                 f"{register['word']}; a slot has 16 words")
        other = next(r["name"] for r in registers if r["word"] == register["word"])
        if other != register["name"]:
            fail(lines[register["name"]],
                 f"{register['name']} has the address of {other}: give one of them another address")
    return dict(block, registers=registers, **({"events": events} if events else {}))


def add_pages(block, name, component):
    for instance in present(component.children):
        address = instance.address
        if address is None:
            fail(instance.line, f"{instance.name} of {name}_PAGES has no address")
        if address % 4:
            fail(instance.line, f"{instance.name} @ 0x{address:X}: not a multiple of 4")
        register = register_of(instance, 8 + address // 4 % 8)
        block["registers"].append(dict(register, page=address // 32 * 32))


def blocks_of(path, first):
    """Returns the descriptions of the file's blocks."""
    root = Reader(path).file()
    maps = [i for i in present(root.children) if i.component.kind == "addrmap"]
    stray = [i for i in root.children if i.component.kind != "addrmap"]
    if stray:
        fail(stray[0].line, f"{stray[0].name} is outside of an addrmap")
    inner = [i for top in maps for i in present(top.component.children)
             if i.component.kind == "addrmap"]
    for top in maps:
        others = [i for i in top.component.children if i.component.kind != "addrmap"]
        if others and any(i.component.kind == "addrmap" for i in top.component.children):
            fail(others[0].line, f"{others[0].name} is outside the addrmaps: put it in one")
    pages = {i.name[:-6]: i.component for i in maps if i.name.endswith("_PAGES")} if inner else {}
    unused = [i for i in maps if inner and not i.name.endswith("_PAGES") and not any(
        c.component.kind == "addrmap" for c in i.component.children)]
    blocks = [block_of(i.name, i.component, first) for i in (inner or maps)]
    blocks += [block_of(i.name, i.component, first) for i in unused]
    for instance, block in zip(inner, blocks):
        if instance.name in pages:
            add_pages(block, instance.name, pages[instance.name])
    check(blocks, "1: error: expected an addrmap")
    names = [Block(block).name for block in blocks]
    check(len(names) == len(set(names)), "two addrmaps have the same name")
    return blocks


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", help="SystemRDL file")
    parser.add_argument("folder", help="folder of the <block>.regs.json")
    parser.add_argument("--first", type=int, default=3,
                        help="word of the first register (default 3)")
    args = parser.parse_args()
    try:
        files = {os.path.join(args.folder, block["block"] + ".regs.json"): block
                 for block in blocks_of(args.file, args.first)}
        os.makedirs(args.folder, exist_ok=True)
        for path, block in files.items():
            with open(path, "w") as f:
                f.write(json.dumps(block, indent=2) + "\n")
    except RecursionError:
        sys.exit(f"{args.file}:1: error: components are nested too deeply")
    except UnicodeDecodeError:
        sys.exit(f"{args.file}:1: error: expected text in UTF-8")
    except OSError as e:
        sys.exit(f"{e.filename or args.file}: error: {e.strerror}")
    except Wrong as e:
        text = str(e)
        sys.exit(f"{args.file}:{'' if text[0].isdigit() else ' error: '}{text}")
    print("\n".join(files))


if __name__ == "__main__":
    main()
