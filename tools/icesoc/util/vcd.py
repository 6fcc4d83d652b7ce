# SPDX-License-Identifier: MIT
"""vcd: reads waveforms in the format VCD (IEEE 1364-2005, section 18.2)."""
import dataclasses
import re


# matches names that GHDL and Yosys invent for wires
NAMELESS = re.compile(r"(^|[.])(n\d+(_o)?|_\d+_|\$\S*)$")


@dataclasses.dataclass
class Variable:
    """The declaration of a signal. A signal with several names has several declarations, with the
    same key."""
    key: str
    scopes: list  # names of the instances that contain the signal, the outermost first
    name: str
    width: int  # bits
    kind: str  # kind of signal: "wire", "reg", "string", ...

    @property
    def row(self):
        """Returns the signal's row in a save file of GTKWave."""
        bits = f"[{self.width - 1}:0]" if self.width > 1 and "[" not in self.name else ""
        return ".".join([*self.scopes, self.name + bits])

    @property
    def is_shown(self):
        """Returns whether the signal is of interest to a reader: it is not a parameter, not a word
        of a memory, and its name is not from a converter."""
        return not (self.kind == "parameter" or NAMELESS.search(self.name)
                    or re.search(r"\[\d+\]$", self.name))


def read(text):
    """Returns the head of a VCD file, its variables, and a generator of (time, key, value). An item
    with the key None begins a new time; every other item is a change. A value is the bits without
    "b", or the text without "s"."""
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
