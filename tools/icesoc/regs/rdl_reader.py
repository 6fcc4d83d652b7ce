# SPDX-License-Identifier: MIT
"""rdl_reader: reads SystemRDL 2.0 into a tree of components.

It reads a flat subset: addrmap, reg and field, named or not, with properties and defaults. Enums
and the declarations of properties are skipped. Everything else is an error with its line.
"""
import re
from dataclasses import dataclass, field

from icesoc.regs import rdl_properties
from icesoc.regs.model import Wrong

TOKEN = re.compile(
    r'(?P<string>"(?:[^"\\]|\\.)*")'
    r'|(?P<number>\d+\'[hbdoHBDO][\da-fA-F_]+|0[xX][\da-fA-F_]+|\d[\d_]*)'
    r'|(?P<name>\\?[A-Za-z_]\w*)|(?P<sign>->|[+%]=|[^\s])', re.A | re.S)
OTHERS = {"regfile", "mem", "signal", "struct", "constraint", "alias", "abstract"}
BASES = {"h": 16, "b": 2, "d": 10, "o": 8}


def number(text):
    """Returns the value of a number; raises ValueError with the reason."""
    expected = (f"expected a number, got {text[:40]}; the flat subset has no expressions and "
                "references")
    if len(text) > 80:
        raise ValueError(expected)
    digits = text.replace("_", "").lower()
    sized = re.fullmatch(r"(\d+)'([hbdo])([\da-f]+)", digits, re.A)
    try:
        value = (int(sized[3], BASES[sized[2]]) if sized
                 else int(digits, 16 if digits.startswith("0x") else 10))
    except ValueError:
        raise ValueError(expected) from None
    if sized and value >> int(sized[1]):
        raise ValueError(f"{text}: expected a value of {sized[1]} bits, got {value}")
    return value


def unquoted(text):
    """Returns the text of a string in one line. \\" becomes a quote, and \\\\ a backslash."""
    return re.sub(r"\s+", " ", re.sub(r'\\(["\\])', r"\1", text[1:-1])).strip()


@dataclass
class Component:
    kind: str  # kind of component: root, addrmap, reg or field
    parent: "Component"
    line: int
    properties: dict = field(default_factory=dict)  # property name -> text
    defaults: dict = field(default_factory=dict)
    lines: dict = field(default_factory=dict)  # property name -> line number
    types: dict = field(default_factory=dict)
    children: list = field(default_factory=list)
    # defaults that apply to this component, set earlier in the surrounding components
    inherited: dict = field(default_factory=dict)

    def __post_init__(self):
        if self.parent:
            self.inherited = {**self.parent.inherited, **self.parent.defaults}

    def find_type(self, name):
        return self.types.get(name) or (self.parent and self.parent.find_type(name))

    def get(self, name, otherwise=None):
        """Returns the text of a property. It is "true" if the property has no value, and
        `otherwise` or the default if the property is not set."""
        if name in self.properties:
            return self.properties[name]
        return self.inherited.get(name, otherwise)

    def is_set(self, name):
        return self.get(name, "false") == "true"


@dataclass
class Instance:
    name: str
    component: Component
    line: int
    msb: int | None = None
    lsb: int | None = None
    width: int | None = None  # width of a field that is declared by its width only
    reset: int | None = None
    address: int | None = None


class Reader:
    def __init__(self, path):
        with open(path, encoding="utf-8-sig") as f:
            text = f.read()
        # Blanks replace comments, but line ends are kept. A comment mark in a string does not begin
        # a comment.
        text = re.sub(r'"(?:[^"\\]|\\.)*"|//[^\n]*|/\*.*?\*/',
                      lambda m: m[0] if m[0][0] == '"' else re.sub(r"[^\n]", " ", m[0]), text,
                      flags=re.S)
        self.tokens = [(m.lastgroup, m[0], text.count("\n", 0, m.start()) + 1)
                       for m in TOKEN.finditer(text)]
        self.at, self.last = 0, text.count("\n") + 1
        self.declared = set()  # names of the properties that the file declares
        for n, (_, token, line) in enumerate(self.tokens):
            if token == '"':
                self.fail("this text has no closing quote", line)
            if token == "/" and self.peek(n + 1) == "*":
                self.fail("this comment has no end", line)

    @property
    def line(self):
        return self.tokens[self.at][2] if self.at < len(self.tokens) else self.last

    def peek(self, ahead=0):
        return self.tokens[self.at + ahead][1] if self.at + ahead < len(self.tokens) else ""

    def fail(self, text, line=None):
        raise Wrong(f"{line or self.line}: error: {text}")

    def expected(self, what):
        token = self.peek()
        self.fail(f"expected {what}, got " + (f"'{token}'" if token else "the end of the text"))

    def take(self, wanted=None):
        token = self.peek()
        if not token or (wanted and token != wanted):
            self.expected(f"'{wanted}'" if wanted else "more text")
        self.at += 1
        return token

    def take_name(self):
        if self.at >= len(self.tokens) or self.tokens[self.at][0] != "name":
            self.expected("a name")
        problem = rdl_properties.name_problem(self.peek())
        if problem:
            self.fail(problem)
        return self.take().lstrip("\\")

    def take_number(self):
        try:
            value = number(self.peek())
        except ValueError as error:
            self.fail(str(error))
        if value >= 1 << 64:
            self.fail(f"expected a number below 2^64, got {self.peek()}")
        self.take()
        return value

    def file(self):
        root = Component("root", None, 1)
        self.body(root, "")
        return root

    def body(self, parent, end):
        while self.peek() != end:
            line, word = self.line, self.take()
            if word in ("addrmap", "reg", "field"):
                self.component(Component(word, parent, line))
            elif word == "enum":
                self.skip()
            elif word == "property":
                name = self.take_name()
                if name in self.declared or rdl_properties.is_standard(name):
                    self.fail(f"property '{name}' already exists", line)
                self.declared.add(name)
                self.skip()
            elif word == "default":
                self.property(parent, parent.defaults, self.take())
            elif word in OTHERS:
                self.fail(f"{word} is not part of the flat subset: addrmap, reg, field", line)
            elif word in ("external", "internal") and self.peek() not in (";", "="):
                continue
            elif word == "`":
                self.fail("preprocessor directives are not part of the flat subset", line)
            elif self.peek() in ("->", ".", "["):
                self.fail(f"'{word}{self.peek()}': assignments to other components are not part of "
                          "the flat subset: set the property where the component is", line)
            elif parent.find_type(word.lstrip("\\")) and self.peek() not in ("=", ";"):
                self.instances(parent, parent.find_type(word.lstrip("\\")))
            elif word == "<":
                self.fail("the Perl preprocessor is not part of the flat subset", line)
            elif not re.match(r"[A-Za-z_\\]", word):
                self.fail(f"expected a component or a property, got '{word}'", line)
            elif re.match(r"[A-Za-z_\\]", self.peek()) and not rdl_properties.is_standard(word):
                self.fail(f"type '{word}' is not defined", line)
            elif parent.kind == "root":
                self.fail(f"'{word}': a property belongs into a component, or after 'default'",
                          line)
            else:
                self.property(parent, parent.properties, word, line)
            self.take(";")

    def skip(self):
        """Skips a declaration up to the brace that closes it; enumerators may have braces."""
        while self.take() != "{":
            pass
        depth = 1
        while depth:
            depth += {"{": 1, "}": -1}.get(self.take(), 0)

    def component(self, made):
        parent = made.parent
        if self.peek() != "{":
            line, name = self.line, self.take_name()
            if name in parent.types:
                self.fail(f"type '{name}' already exists, on line {parent.types[name].line}", line)
            parent.types[name] = made
        if self.peek() == "#":
            self.fail("parameters are not part of the flat subset")
        self.take("{")
        self.body(made, "}")
        self.take("}")
        if self.peek() in ("external", "internal"):
            self.take()
        if self.peek() != ";":
            self.instances(parent, made)
        elif made.kind == "addrmap" and parent.kind == "root":
            name = [n for n, c in parent.types.items() if c is made]
            if not name:
                self.fail("an addrmap of the file has no name")
            parent.children.append(Instance(name[0], made, made.line))

    def property(self, component, where, name, line=None):
        line = line or self.line
        value = "true"
        if self.peek() == "=":
            self.take()
            parts = []
            while self.peek() not in (";", ""):
                parts.append(self.take())
            value = " ".join(parts)
            if not parts:
                self.fail(f"{name}: expected a value")
            if name in ("name", "desc") and (len(parts) > 1 or value[0] != '"'):
                self.fail(f"{name}: expected one text in quotes, got {value[:60]}", line)
        kind = component.kind if where is component.properties else "root"
        problem = rdl_properties.problem_of(kind, name, value, self.declared)
        if problem:
            self.fail(problem, line)
        if name in where:
            self.fail(f"property '{name}' is already set in this component", line)
        where[name] = value
        component.lines[name] = line

    def instances(self, parent, component):
        while True:
            line, made = self.line, Instance(self.take_name(), component, self.line)
            if self.peek() == "[":
                if component.kind != "field":
                    self.fail("arrays are not part of the flat subset: name each register")
                self.take()
                first = self.take_number()
                if self.peek() == ":":
                    self.take()
                    made.msb, made.lsb = first, self.take_number()
                else:
                    made.width = first  # the field begins at the next free bit
                self.take("]")
            if self.peek() == "=":
                self.take()
                made.reset = self.take_number()
            if self.peek() == "@":
                self.take()
                made.address = self.take_number()
            if self.peek() in ("+=", "%="):
                self.fail("strides are not part of the flat subset: give each register its address")
            made.line = line
            if other := next((c for c in parent.children if c.name == made.name), None):
                self.fail(f"{made.name}: duplicate name, first on line {other.line}", line)
            parent.children.append(made)
            if self.peek() != ",":
                return
            self.take()
