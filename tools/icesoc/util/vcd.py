# SPDX-License-Identifier: MIT
"""vcd: reads waveforms in the format VCD (IEEE 1364-2005, section 18.2)."""
import dataclasses
import re


NAMELESS = re.compile(r"(^|[.])(n\d+(_o)?|_\d+_|\$\S*)$")  # names that GHDL and Yosys give to wires


@dataclasses.dataclass
class Variable:
    """A signal's declaration; several may share a key."""
    key: str
    scopes: list  # names of the instances around it, the outermost first
    name: str
    width: int  # bits
    kind: str  # "wire", "reg", "string", ...

    @property
    def row(self):
        """Its row in a save file of GTKWave."""
        bits = f"[{self.width - 1}:0]" if self.width > 1 and "[" not in self.name else ""
        return ".".join([*self.scopes, self.name + bits])

    @property
    def is_shown(self):
        """Whether a reader looks for it: it is neither a parameter, nor a word of a memory, nor
        named by a converter."""
        return not (self.kind == "parameter" or NAMELESS.search(self.name)
                    or re.search(r"\[\d+\]$", self.name))


def read(text):
    """Returns the head of a VCD file, its variables, and a generator of (time, key, value). An item
    with the key None is a new time; every other item is a change. A value is the bits without "b",
    or the text without "s"."""
    head, _, body = text.partition("$enddefinitions")
    variables, scopes = [], []
    for kind, rest in re.findall(r"\$(scope|upscope|var)\s+(.*?)\s*\$end", head, re.S):
        words = rest.split()
        if kind == "scope":
            scopes.append(words[1])
        elif kind == "upscope":
            scopes.pop()
        else:
            variables.append(Variable(words[2], [*scopes], words[3], int(words[1]), words[0]))
    return head, variables, changes(body)


def changes(body):
    now = 0
    words = (word for line in body.splitlines() for word in line.split())
    for word in words:
        kind, value = word[0], word[1:]
        if kind == "#":
            now = int(value)
            yield now, None, ""
        elif kind in "bs":
            yield now, next(words), value
        elif kind in "01xz" and value:
            yield now, value, kind
