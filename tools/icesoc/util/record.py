# SPDX-License-Identifier: MIT
"""record: describes a binary record that C, C++ and Python share.

    python -m icesoc.util.record DESCRIPTION.toml    writes the C header to standard output

The description is a TOML file with these keys:

    name = "SimStatus"            name of the C struct
    include = "base.h"            optional: the header with U8, U16 and U32; default <stdint.h>
    [constants]                   optional: numbers and texts, macros in C
    MAGIC = "ICESOC1"
    [fields]                      in order, little-endian, at their natural alignment
    ns = ["u64", "simulated time, ns"]
    seen = ["u8[1024]", "..."]

Types are char, u8, u16, u32 and u64, and arrays of these. A layout with padding is rejected, so
that every compiler uses the same layout. Python programs call load() or of_tree().
"""
import os
import re
import struct
import sys
import tomllib

BYTES = {"char": 1, "u8": 1, "u16": 2, "u32": 4, "u64": 8}
FORMATS = {"char": "s", "u8": "B", "u16": "H", "u32": "I", "u64": "Q"}


class Field:
    """One field: its name, type, number of elements (None: not an array), offset and comment."""

    def __init__(self, name, kind, text, offset):
        parts = re.fullmatch(r"(char|u8|u16|u32|u64)(?:\[([1-9]\d*)\])?", kind)
        if not parts:
            raise ValueError(f"{name}: expected a type such as u32 or u8[64], got '{kind}'")
        self.name, self.text, self.offset = name, text, offset
        self.type = parts[1]
        self.count = int(parts[2]) if parts[2] else None
        self.bytes = BYTES[self.type] * (self.count or 1)
        if offset % BYTES[self.type]:
            raise ValueError(f"{name}: offset {offset} is not aligned to its type {self.type}; "
                             "reorder the fields, or add one that fills the gap")

    @property
    def format(self):
        return f"<{self.count or 1}{FORMATS[self.type]}"


class Record:
    """A record, as described in a file."""

    def __init__(self, description):
        self.name = description["name"]
        self.include = description.get("include")
        self.constants = description.get("constants", {})
        self.fields, self.size = {}, 0
        for name, (kind, text) in description["fields"].items():
            self.fields[name] = Field(name, kind, text, self.size)
            self.size += self.fields[name].bytes
        largest = max(BYTES[field.type] for field in self.fields.values())
        if self.size % largest:
            raise ValueError(f"{self.name}: its size {self.size} is not a multiple of {largest}; "
                             "add a field that fills the gap")

    def unpack(self, data, *names):
        """Returns {name: value} of the fields, or only of the named fields. A value is the bytes of
        a char array, a number, or a tuple for any other array. Raises struct.error if `data` is too
        short."""
        values = {}
        for name in names or self.fields:
            field = self.fields[name]
            value = struct.unpack_from(field.format, data, field.offset)
            values[name] = value[0] if field.type == "char" or not field.count else value
        return values

    def pack(self, **values):
        """Returns the bytes of a record; fields without a value are 0."""
        data = bytearray(self.size)
        for name, value in values.items():
            field = self.fields[name]
            is_list = field.count and field.type != "char"
            struct.pack_into(field.format, data, field.offset, *(value if is_list else [value]))
        return bytes(data)

    def header(self, source):
        """Returns the text of the C header."""
        types = {kind: "char" if kind == "char" else
                 kind.upper() if self.include else f"uint{8 * BYTES[kind]}_t" for kind in BYTES}
        include = f'"{self.include}"' if self.include else "<stdint.h>"
        lines = [f"/* Generated from {source} by tools/icesoc/util/record.py: do not edit. */",
                 "#pragma once",
                 f"#include {include}", ""]
        for name, value in self.constants.items():
            text = f'"{value}"' if isinstance(value, str) else f"0x{value:X}U"
            lines.append(f"#define {name} {text}")
        lines += ["", f"typedef struct {self.name} {{"]
        for field in self.fields.values():
            array = f"[{field.count}]" if field.count else ""
            lines.append(f"    {types[field.type]} {field.name}{array}; /* {field.text} */")
        # If a compiler uses a different layout, the size of this array is -1, which is an error.
        lines += [f"}} {self.name};", f"typedef char {self.name}_hasItsSize"
                  f"[sizeof({self.name}) == {self.size} ? 1 : -1];", ""]
        return "\n".join(lines)


def load(path):
    """Returns the record that a file describes. Raises ValueError if the file is invalid."""
    with open(path, "rb") as file:
        try:
            return Record(tomllib.load(file))
        except (KeyError, TypeError, ValueError) as wrong:
            raise ValueError(f"{path}: {wrong}") from wrong


def of_tree(path):
    """Returns the record that a file of this source tree describes."""
    return load(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../..", path))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    try:
        sys.stdout.write(load(sys.argv[1]).header(os.path.basename(sys.argv[1])))
    except OSError as error:
        sys.exit(f"record: error: {sys.argv[1]}: {error.strerror}")
    except ValueError as error:
        sys.exit(f"record: error: {error}")
