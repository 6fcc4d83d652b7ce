# SPDX-License-Identifier: MIT
"""core_exchange: writes the registers of the chip in formats of other tools: CMSIS-SVD 1.3,
SystemRDL 2.0 and IP-XACT (IEEE 1685-2014).

A slot is a chip.model.Slot.
"""
import xml.etree.ElementTree as ET

from icesoc.regs import names
from icesoc.regs.model import Field

HAND = "Generated from ip/cores.list: do not edit."
TITLE = "Registers of the FPGA in the FSMC window NE2"
XML_ACCESS = {"ro": "read-only", "ws": "write-only", "rw": "read-write", "w1c": "read-write",
              "w1s": "read-write"}
RDL_ACCESS = {"ro": "sw=r; hw=w;", "ws": "sw=w; hw=r;", "rw": "sw=rw; hw=r;",
              "w1c": "sw=rw; hw=w; onwrite=woclr;", "w1s": "sw=rw; hw=w; onwrite=woset;"}
MODIFIED = {"w1c": "oneToClear", "w1s": "oneToSet"}


def element(tag, *content, **attributes):
    """Returns an XML element of text, (tag, text) pairs and elements; false values are omitted."""
    made = ET.Element(tag, attributes)
    for part in filter(None, content):
        if isinstance(part, str):
            made.text = part
        else:
            made.append(element(*part) if isinstance(part, tuple) else part)
    return made


def xml(root):
    root.insert(0, ET.Comment(f" {HAND} "))
    ET.indent(root)
    return '<?xml version="1.0" encoding="utf-8"?>\n' + ET.tostring(root, "unicode") + "\n"


def svd_register(r):
    fields = [element("field", ("name", f.name), ("description", f.doc),
                      ("bitOffset", str(f.lsb)), ("bitWidth", str(f.width)),
                      f.access != r.access and ("access", XML_ACCESS[f.access]))
              for f in r.fields]
    return element("register", ("name", r.name), ("description", r.doc),
                   r.page >= 0 and ("alternateGroup", f"PAGE_0x{r.page:X}"),
                   ("addressOffset", f"0x{4 * r.word:X}"), ("access", XML_ACCESS[r.access]),
                   r.access in MODIFIED and ("modifiedWriteValues", MODIFIED[r.access]),
                   fields and ("fields", *fields))


def svd_of(slots):
    peripherals = [element(
        "peripheral", ("name", s.name.upper()), ("description", s.block.doc),
        ("baseAddress", f"0x{s.address:08X}"),
        ("addressBlock", ("offset", "0"), ("size", f"0x{s.bytes:X}"), ("usage", "registers")),
        ("registers", *map(svd_register, s.block.registers))) for s in slots]
    return xml(element(
        "device", ("name", "IceSoC"), ("version", "1.0"), ("description", f"{TITLE}."),
        ("addressUnitBits", "8"), ("width", "32"), ("size", "32"), ("resetValue", "0"),
        ("resetMask", "0xFFFFFFFF"), ("peripherals", *peripherals), schemaVersion="1.3",
        **{"xmlns:xs": "http://www.w3.org/2001/XMLSchema-instance",
           "xs:noNamespaceSchemaLocation": "CMSIS-SVD.xsd"}))


def fields_of(r):
    """Returns a register's fields. A register without fields gets one field, named WORD."""
    return r.fields or [Field("WORD", 0, r.width, r.doc, r.access, r.reset)]


def address_of(r):
    return 4 * r.word if r.page < 0 else r.page + 4 * (r.word - 8)


def split(slot):
    """Returns two lists: the registers that are in the slot, and those that are accessed through an
    adapter.

    All registers behind an adapter share a few addresses in the slot. They are therefore described
    in a separate address map, <SLOT>_PAGES, with their byte addresses in the core.
    """
    registers = slot.block.registers
    return ([r for r in registers if r.page < 0], [r for r in registers if r.page >= 0])


def quoted(text):
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def rdl_register(r):
    s = f"        reg {{\n            desc = {quoted(r.doc)};\n"
    for f in fields_of(r):
        reset = f" = 0x{f.reset:X}" if f.has_reset or f.reset else ""
        s += (f"            field {{ {rdl_access(r, f)} desc = {quoted(f.doc)}; }} "
              f"{names.rdl(f.name)}[{f.msb}:{f.lsb}]{reset};\n")
    return s + f"        }} {names.rdl(r.name)} @ 0x{address_of(r):X};\n"


def rdl_access(r, f):
    """Returns the access to a field as properties of SystemRDL. If the core stores the register,
    the core may also change the value, so the field has hw=rw."""
    more = "".join(f" {flag};" for flag in ("hwset", "hwclr") if getattr(f, flag))
    if f.access == "rw" and r.storage == "core":
        return "sw=rw; hw=rw;" + more
    return RDL_ACCESS[f.access] + more


def rdl_of(slots):
    words = "    default regwidth = 32;\n    default accesswidth = 32;\n"
    maps, pages = "", ""
    for slot in slots:
        own, paged = split(slot)
        name, block = names.rdl(slot.name.upper()), slot.block
        if paged:
            pages += (f'addrmap {name}_PAGES {{\n    desc = "By byte address in the core.";\n'
                      f"{words}{''.join(map(rdl_register, paged))}}};\n")
        maps += f"    addrmap {{\n        desc = {quoted(block.doc)};\n"
        if block.memory_bytes:
            maps += f"        memory_bytes = {block.memory_bytes};\n"
        maps += f"{''.join(map(rdl_register, own))}    }} {name} @ 0x{slot.address:X};\n"
    return (f"// {TITLE} (SystemRDL 2.0). {HAND}\n"
            "property memory_bytes { type = longint unsigned; component = addrmap; };\n"
            f"{pages}addrmap icesoc {{\n{words}{maps}}};\n")


def ipxact_field(f):
    reset = (f.has_reset or f.reset) and ("resets", ("reset", ("value", f"'h{f.reset:X}")))
    return element("field", ("name", f.name), ("description", f.doc),
                   ("bitOffset", str(f.lsb)), reset, ("bitWidth", str(f.width)),
                   ("access", XML_ACCESS[f.access]),
                   f.access in MODIFIED and ("modifiedWriteValue", MODIFIED[f.access]))


def ipxact_block(slot, registers, address):
    parts = [element("register", ("name", r.name), ("description", r.doc),
                     ("addressOffset", f"'h{address_of(r):x}"), ("size", "32"),
                     *map(ipxact_field, fields_of(r))) for r in registers]
    size = max(slot.bytes, *(address_of(r) + 4 for r in registers))
    return element("addressBlock", ("name", slot.name.upper()),
                   ("description", slot.block.doc), ("baseAddress", f"'h{address:x}"),
                   ("range", str(size)), ("width", "32"), *parts)


def ipxact_of(slots):
    def memory_map(name, *blocks):
        return element("memoryMap", ("name", name), *blocks, ("addressUnitBits", "8"))

    maps = [memory_map("registers", *(ipxact_block(s, split(s)[0], s.address) for s in slots))]
    maps += [memory_map(f"{s.name.upper()}_PAGES", ipxact_block(s, split(s)[1], 0))
             for s in slots if split(s)[1]]
    root = element("component", ("vendor", "icesoc"), ("library", "icesoc"), ("name", "icesoc"),
                   ("version", "1.0"), ("memoryMaps", *maps),
                   **{"xmlns:ipxact": "http://www.accellera.org/XMLSchema/IPXACT/1685-2014"})
    for part in root.iter():
        part.tag = "ipxact:" + part.tag
    return xml(root)


def files(slots):
    """Returns the files as {name: text}."""
    return {"icesoc.svd": svd_of(slots), "icesoc.rdl": rdl_of(slots),
            "icesoc.ipxact.xml": ipxact_of(slots)}
