# SPDX-License-Identifier: MIT
"""rdl: makes register descriptions (*.regs.json) of SystemRDL 2.0: make from-rdl RDL=spi.rdl
OUT=folder.

    rdl.py spi.rdl FOLDER [--first 3]

Reads a flat subset: addrmap, reg and field, named or not, defaults, addresses, resets; enums and
properties of others are passed over. Register n of an addrmap gets word FIRST + n, behind the three
words that every slot has; one that begins with ID, EVENT and MASK, as those of icesoc.rdl, has them
already; <SLOT>_PAGES has the words behind the slot's PAGE. Regfiles, memories, arrays and
parameters, which have no words of their own, are errors.
"""
import argparse
import json
import os
import re
import sys

sys.dont_write_bytecode = True
from icesoc.regs.regmap import Block, Wrong, check

TOKEN = re.compile(r'(?P<string>"(?:[^"\\]|\\.)*")|(?P<number>\d+\'[hbdoHBDO][\da-fA-F_]+|0[xX][\da-fA-F_]+|\d+)'
                   r'|(?P<name>\\?[A-Za-z_]\w*)|(?P<sign>->|[+%]=|[^\s])', re.A)
ACCESS = {"r": "ro", "w": "ws", "rw": "rw", "wr": "rw", "rw1": "rw", "w1": "ws"}


def number(text):
    check(len(text) <= 80, f"a number of {len(text)} digits")
    text = text.replace("_", "").lower()
    if "'" in text:
        digits = text.split("'")[1]
        return int(digits[1:], {"h": 16, "b": 2, "d": 10, "o": 8}[digits[0]])
    return int(text, 16 if text.startswith("0x") else 10)


def bytes_in(width):
    check(width in ("8", "16", "32", "64"), f"regwidth is 8, 16, 32 or 64, not '{width}'")
    return int(width) // 8


class Component:
    def __init__(self, kind, parent):
        self.kind, self.parent, self.properties, self.defaults, self.types, self.children = kind, parent, {}, {}, {}, []

    def find_type(self, name):
        return self.types.get(name) or (self.parent and self.parent.find_type(name))

    def default(self, name):
        return self.defaults[name] if name in self.defaults else self.parent and self.parent.default(name)

    def get(self, name, otherwise=None):
        if name in self.properties:
            return self.properties[name]
        value = self.parent and self.parent.default(name)
        return otherwise if value is None else value


class Reader:
    """Reads a file as a tree: each component's children are (instance's name, msb, lsb, reset,
    address, component)."""

    def __init__(self, path):
        with open(path) as f:
            text = f.read()
        # Comments keep their lines; those within strings are text.
        text = re.sub(r'"(?:[^"\\]|\\.)*"|//[^\n]*|/\*.*?\*/',
                      lambda m: m[0] if m[0][0] == '"' else re.sub(r"[^\n]", " ", m[0]), text,
                      flags=re.S)
        self.tokens = [(m.lastgroup, m[0], text.count("\n", 0, m.start()) + 1)
                       for m in TOKEN.finditer(text)]
        self.at, self.last = 0, text.count("\n") + 1

    def peek(self, ahead=0):
        return self.tokens[self.at + ahead][1] if self.at + ahead < len(self.tokens) else ""

    def fail(self, text):
        line = self.tokens[self.at][2] if self.at < len(self.tokens) else self.last
        raise Wrong("%d: error: %s" % (line, text))

    def take(self, wanted=None):
        token = self.peek()
        if not token or (wanted and token != wanted):
            self.fail("'%s' comes where '%s' is to come" % (token or "the end", wanted or "more"))
        self.at += 1
        return token

    def take_number(self):
        try:
            isNumber = self.at < len(self.tokens) and self.tokens[self.at][0] == "number"
            value = number(self.peek()) if isNumber else 1 << 64
        except ValueError:  # 2'b3
            value = 1 << 64
        if value >= 1 << 64:
            self.fail("'%s' is no number; expressions and parameters are not of the flat subset" %
                      self.peek()[:80])
        self.take()
        return value

    def file(self):
        root = Component("root", None)
        self.body(root, "")
        return root

    def body(self, parent, end):
        while self.peek() != end:
            word = self.take()
            if word in ("addrmap", "reg", "field"):
                component = Component(word, parent)
                if self.peek() != "{":
                    parent.types[self.take()] = component
                if self.peek() == "#":
                    self.fail("parameters are not of the flat subset")
                self.take("{")
                self.body(component, "}")
                self.take("}")
                if self.peek() in ("external", "internal"):
                    self.take()
                if self.peek() != ";":
                    self.instances(parent, component)
                elif word == "addrmap" and parent.kind == "root":
                    name = [n for n, c in parent.types.items() if c is component]
                    if not name:
                        self.fail("an addrmap of the file has no name")
                    parent.children.append((name[0], 0, 0, None, 0, component))
            elif word in ("enum", "property"):
                while self.take() != "}":
                    pass
            elif word == "default":
                self.property(parent.defaults, self.take())
            elif word in ("regfile", "mem", "signal", "struct", "constraint"):
                self.at -= 1
                self.fail("%s is not of the flat subset: addrmap, reg, field" % word)
            elif word in ("external", "internal"):
                continue
            elif parent.find_type(word) and self.peek() not in ("=", ";"):
                self.instances(parent, parent.find_type(word))
            else:
                self.property(parent.properties, word)
            self.take(";")

    def property(self, where, name):
        value: object = True
        if self.peek() == "=":
            self.take()
            words = []
            while self.peek() not in (";", ""):
                words.append(self.take())
            value = words[0] if len(words) == 1 else " ".join(words)
        where[name.split()[0]] = value

    def instances(self, parent, component):
        while True:
            name, msb, lsb, reset, address = self.take().lstrip("\\"), None, None, None, None
            if self.peek() == "[":
                if component.kind != "field":
                    self.fail("arrays are not of the flat subset: name each register")
                self.take()
                msb, lsb = self.take_number(), 0
                if self.peek() == ":":
                    self.take()
                    lsb = self.take_number()
                else:
                    msb, lsb = msb - 1, None  # a width: from the next free bit on
                self.take("]")
            if self.peek() == "=":
                self.take()
                reset = self.take_number()
            if self.peek() == "@":
                self.take()
                address = self.take_number()
            if self.peek() in ("+=", "%="):
                self.fail("strides are not of the flat subset: give each register its address")
            parent.children.append((name, msb, lsb, reset, address, component))
            if self.peek() != ",":
                return
            self.take()


def text_of(component):
    text = component.get("desc") or component.get("name") or ""
    return re.sub(r"\s+", " ", re.sub(r"\\(.)", r"\1", str(text).strip('"'))).strip()


def register_of(name, reg, word):
    """Returns a register of a description, and the resets of its fields."""
    fields, resets, accesses, used, next_bit = [], {}, set(), 0, 0
    overlap = False
    for field_name, msb, lsb, reset, _, field in reg.children:
        if lsb is None:  # a width, or one bit
            lsb = next_bit
            msb = lsb + (msb or 0)
        if msb > 31 or msb < lsb:
            raise Wrong("%s.%s is at bits %d to %d: a word has bits 31 to 0" %
                        (name, field_name, msb, lsb))
        bits = (1 << msb - lsb + 1) - 1 << lsb
        overlap |= bool(used & bits)
        used, next_bit = used | bits, msb + 1
        access = ACCESS.get(field.get("sw", "rw"), "rw")
        if access == "rw" and (field.get("onwrite") == "woclr" or field.get("woclr")):
            access = "w1c"
        accesses.add(access)
        resets[field_name] = reset
        fields.append({"name": field_name, "lsb": lsb, "width": msb - lsb + 1,
                       "doc": text_of(field)})
    if not fields:
        raise Wrong("%s has no field" % name)
    access = accesses.pop() if len(accesses) == 1 else "rw"
    register = {"word": word, "name": name, "access": access, "doc": text_of(reg)}
    if overlap or (len(fields) == 1 and fields[0]["name"] == "WORD" and fields[0]["lsb"] == 0):
        if used != 0xFFFFFFFF:
            register["width"] = used.bit_length()
    else:
        register["fields"] = sorted(fields, key=lambda f: f["lsb"])
    return register, resets


def block_of(name, component, first):
    bytes_of, next_address = bytes_in(component.default("regwidth") or "32"), 0
    registers, resets = [], {}
    for reg_name, _, _, _, address, reg in component.children:
        bytes_of = bytes_in(reg.get("regwidth", str(8 * bytes_of)))
        address = next_address if address is None else address
        next_address = address + bytes_of
        register, found = register_of(reg_name, reg, address // bytes_of)
        registers.append(register)
        resets[reg_name] = found
    block = {"block": name.lower(), "doc": text_of(component)}
    letters = (re.sub(r"[^A-Za-z]", "", name) + "XX")[:2].upper()
    if "memory_bytes" in component.properties:
        block.update(memory_port=True, memory_bytes=int(component.get("memory_bytes")))
    block["type"], block["version"], events = "0x%04X" % int.from_bytes(letters.encode(),
                                                                        "big"), "0x0100", []
    if [r["name"] for r in registers[:3]] == ["ID", "EVENT", "MASK"]:
        for key, field in (("type", "TYPE"), ("version", "VERSION")):
            if resets["ID"].get(field) is not None:
                block[key] = "0x%04X" % resets["ID"][field]
        events = [{"name": f["name"], "bit": f["lsb"], "doc": f["doc"]}
                  for f in registers[1].get("fields", [])]
        registers = registers[3:]
    else:
        for register in registers:
            register["word"] += first
    for register in registers:
        if register["word"] > 15:
            raise Wrong("%s would be word %d of its slot, which has 16" %
                        (register["name"], register["word"]))
    return dict(block, registers=registers, **({"events": events} if events else {}))


def blocks_of(path, first):
    """Returns the descriptions of the file's blocks, each one that regmap.py takes."""
    root = Reader(path).file()
    maps = [(n, c) for n, _, _, _, _, c in root.children if c.kind == "addrmap"]
    inner = [(n, c) for _, top in maps for n, _, _, _, _, c in top.children if c.kind == "addrmap"]
    blocks = [block_of(n, c, first) for n, c in inner or maps]
    pages = {n[:-6]: c for n, c in maps if n.endswith("_PAGES")} if inner else {}
    for (name, _), block in zip(inner, blocks):
        for reg_name, _, _, _, address, reg in pages[name].children if name in pages else []:
            check(address is not None, f"{reg_name} of {name}_PAGES has no address")
            register, _ = register_of(reg_name, reg, 8 + address // 4 % 8)
            block["registers"].append(dict(register, page=address // 32 * 32))
    check(blocks, "1: error: there is no addrmap in it")
    names = [Block(block).name for block in blocks]
    check(len(names) == len(set(names)), "two addrmaps have one name")
    return blocks


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", help="SystemRDL")
    parser.add_argument("folder", help="where <block>.regs.json go")
    parser.add_argument("--first", type=int, default=3, help="word of the first register (3)")
    args = parser.parse_args()
    if not args.file or not args.folder:
        sys.exit("usage: make from-rdl RDL=spi.rdl OUT=ip/spi")
    try:
        files = {os.path.join(args.folder, block["block"] + ".regs.json"): block
                 for block in blocks_of(args.file, args.first)}
        os.makedirs(args.folder, exist_ok=True)
        for path, block in files.items():
            with open(path, "w") as f:
                f.write(json.dumps(block, indent=2) + "\n")
    except RecursionError:
        sys.exit("%s:1: error: its components are nested too deep" % args.file)
    except UnicodeDecodeError:
        sys.exit("%s:1: error: it is no text in UTF-8" % args.file)
    except (Wrong, OSError) as e:
        text = str(e)
        sys.exit("%s:%s%s" % (args.file, "" if text[0].isdigit() else " error: ", text))
    print("\n".join(files))


if __name__ == "__main__":
    main()
