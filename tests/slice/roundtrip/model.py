# SPDX-License-Identifier: MIT
"""model: generates random Slice types from a seed, their Slice text, and random values of these
types."""

import random
import string
import struct

import Ice

SCALARS = ["bool", "byte", "short", "int", "long", "float", "double", "string"]
KEYS = ["bool", "byte", "short", "int", "long", "string"]


class Type:
    """A Slice type. `kind` is the name of a scalar, or enum, struct, sequence, dictionary, class,
    proxy or exception."""

    def __init__(self, kind, name=None):
        self.kind, self.name = kind, name
        self.fields = []  # members of a struct, class or exception: (name, type, tag or None)
        self.base = None
        self.element = self.key = self.maximum = None
        self.values = []  # enum
        self.compact = None
        self.preserve = False

    def slice(self):
        return {"proxy": "Object*"}.get(self.kind, self.name or self.kind)

    def all_fields(self):
        return (self.base.all_fields() if self.base else []) + self.fields

    def preserves(self):
        """Returns True if slices of unknown derived types are preserved."""
        return self.preserve or (self.base is not None and self.base.preserves())

    def legal_key(self):
        return self.kind in KEYS or self.kind == "enum" or (
            self.kind == "struct" and all(t.legal_key() for _, t, _ in self.fields))

    def has_class(self):
        return self.kind == "class" or (self.element is not None and self.element.has_class()) or (
            self.kind == "struct" and any(t.has_class() for _, t, _ in self.fields))


class Model:
    def __init__(self, seed, count=40):
        self.random = r = random.Random(seed)
        self.types = [Type(k) for k in SCALARS] + [Type("proxy")]
        self.declared, self.exceptions = [], []
        makers = [self.enum, self.struct, self.struct, self.sequence, self.sequence,
                  self.dictionary, self.klass]
        for i in range(count):
            t = makers[i](i) if i < len(makers) else r.choice(makers)(i)
            self.declared.append(t)
            self.types.append(t)
        for i in range(8):
            e = Type("exception", "E%d" % i)
            if self.exceptions and r.random() < 0.6:
                e.base = r.choice(self.exceptions)
            e.preserve = r.random() < 0.4
            self.fields_of(e, optionals=True)
            self.exceptions.append(e)

    def any(self, keys=False, small=False):
        choices = [t for t in self.types if (not keys or t.legal_key()) and
                   (not small or t.kind not in ("sequence", "dictionary"))]
        return self.random.choice(choices)

    def fields_of(self, t, optionals):
        taken = len(t.base.all_fields()) if t.base else 0
        tags = self.random.sample(list(range(29)) + [30, 31, 254, 255, 70000], 5)
        for i in range(self.random.randint(0 if optionals else 1, 5)):
            tag = tags[i] if optionals and self.random.random() < 0.5 else None
            t.fields.append(("m%d" % (taken + i), self.any(), tag))

    def enum(self, i):
        t = Type("enum", "Enum%d" % i)
        value = 0
        top = self.random.choice([2, 60, 20000, 2**20])
        for _ in range(self.random.randint(1, 5)):
            t.values.append(value)
            value += self.random.randint(1, top)
        return t

    def struct(self, i):
        t = Type("struct", "Struct%d" % i)
        self.fields_of(t, optionals=False)
        return t

    def sequence(self, i):
        t = Type("sequence", "Sequence%d" % i)
        t.element = self.any()
        t.maximum = self.random.choice([None, None, 5])
        return t

    def dictionary(self, i):
        t = Type("dictionary", "Dictionary%d" % i)
        t.key, t.element = self.any(keys=True), self.any()
        t.maximum = self.random.choice([None, None, 5])
        return t

    def klass(self, i):
        t = Type("class", "Class%d" % i)
        classes = [c for c in self.declared if c.kind == "class"]
        if classes and self.random.random() < 0.5:
            t.base = self.random.choice(classes)
        if self.random.random() < 0.3:
            t.compact = 1000 + i
        t.preserve = self.random.random() < 0.4
        self.fields_of(t, optionals=True)
        t.fields.append(("self%d" % i, t, self.random.choice([None, 100])))
        return t

    # ---- Slice

    def slice_text(self, hidden=False):
        """Returns the Slice text. With `hidden`, it includes classes that the C side does not
        know."""
        out = ["module T {"]
        for t in self.declared:
            most = '["c:max:%d"] ' % t.maximum if t.maximum else ""
            if t.kind == "enum":
                out.append("enum %s { %s };" %
                           (t.name,
                            ", ".join("%s_%d = %d" % (t.name.lower(), v, v) for v in t.values)))
            elif t.kind == "sequence":
                out.append("%ssequence<%s> %s;" % (most, t.element.slice(), t.name))
            elif t.kind == "dictionary":
                out.append("%sdictionary<%s, %s> %s;" % (most, t.key.slice(), t.element.slice(),
                                                         t.name))
            else:
                out.append(self.members(t))
        out += [self.members(e) for e in self.exceptions]
        if hidden:
            out.append(
                "class Lone { int number; Lone next; optional(1) string text; Object any; };")
        out += ["class Later; sequence<Later> Laters; interface Marker; interface Tag {};",
                "interface SubTag extends Tag {};",
                "interface Labelled { string label(); }; class Named { string name; };",
                "class Square extends Named implements Labelled { int area(int side); };",
                "interface Echo {"]
        for i, t in enumerate(self.types):
            for form in self.formats(t):
                meta = self.meta(form).replace("]", ', "amd"]' if i % 3 == 0 else "]")
                out.append('%s%s plain%d%s(%s v, out %s w);' % (
                    (meta, t.slice(), i, form) + (t.slice(),) * 2))
            out.append("idempotent optional(3) %s maybe%d(optional(1) %s v, out optional(2) %s "
                       "w);" % ((t.slice(), i) + (t.slice(),) * 2))
        for e in self.exceptions:
            for form in ("Compact", "Sliced"):
                out.append("%svoid raise%s%s(%s) throws %s;" % (
                    self.meta(form), e.name, form,
                    ", ".join(self.parameter(f) for f in e.all_fields()), self.root(e).name))
            out.append('["format:sliced"] void forward%s(Object* to) throws %s;' %
                       (e.name, self.root(e).name))
        for form in ("Compact", "Sliced"):
            out.append("%sLaters declared%s(Later v, Marker m, Tag t, out Marker n, out Tag u);" %
                       (self.meta(form), form))
        out += ['["format:sliced"] Object any(Object v, out Object w);', "void shutdown();", "};"]
        for t in self.classes() if hidden else []:
            out.append("class Hidden%s%s extends %s { string more; %s other; optional(200) int "
                       "last; %s same; };" % (
                (t.name, "(%d)" % (t.compact + 5000) if t.compact else "") + (t.name,) * 3))
        for e in self.exceptions if hidden else []:
            out.append("exception Hidden%s extends %s { string more; Lone other; optional(200) "
                       "int last; };" % (e.name, e.name))
        out.append("};")
        return '[["underscore", "suppress-warning:deprecated"]]\n' + "\n".join(out) + "\n"

    # Slice file with the definitions of those types that the other file only declares.
    DEFINER = """module T {
class Later { int id; Later next; };
interface Marker { void op(); };
};
"""

    def classes(self):
        return [t for t in self.declared if t.kind == "class"]

    @staticmethod
    def root(e):
        return Model.root(e.base) if e.base else e

    @staticmethod
    def formats(t):
        return ("Compact", "Sliced") if t.has_class() else ("Compact",)

    @staticmethod
    def meta(form):
        return '["format:%s"] ' % form.lower()

    @staticmethod
    def parameter(field):
        name, t, tag = field
        return ("" if tag is None else "optional(%d) " %
                (tag + 1000 * int(name[1:])
                 if name.startswith("m") else tag)) + t.slice() + " " + name

    @staticmethod
    def members(t):
        head = ('["preserve-slice"] ' if t.preserve else "") + t.kind + " " + t.name
        if t.compact:
            head += "(%d)" % t.compact
        if t.base:
            head += " extends " + t.base.name
        fields = ["%s%s %s;" % ("" if tag is None else "optional(%d) " % tag, ft.slice(), name)
                  for name, ft, tag in t.fields]
        return head + " { " + " ".join(fields) + " };"

    # ---- values

    def value(self, t, module, ic, budget, graph):
        """Returns a random value. `budget` is a list with the number of values that may still be
        created. `graph` contains the instances created so far, which may be used again."""
        r = self.random
        budget[0] -= 1
        if t.kind in SCALARS or t.kind == "proxy":
            return self.scalar(t.kind, ic)
        if t.kind == "enum":
            return getattr(module, t.name).valueOf(r.choice(t.values))
        if t.kind in ("sequence", "dictionary"):
            most = t.maximum if t.maximum is not None else 6
            count = 0 if budget[0] < 0 else r.randint(0, most)
            if t.kind == "sequence":
                if t.element.kind == "byte":
                    return bytes(r.randint(0, 255) for _ in range(count))
                return [self.value(t.element, module, ic, budget, graph) for _ in range(count)]
            return {self.value(t.key, module, ic, budget,
                               graph): self.value(t.element, module, ic, budget, graph)
                    for _ in range(count)}
        if t.kind == "struct":
            return getattr(module, t.name)(*[self.value(ft, module, ic, budget, graph)
                                             for _, ft, _ in t.fields])
        return self.instance(t, module, ic, budget, graph)

    def instance(self, t, module, ic, budget, graph):
        r = self.random
        derived = [d for d in self.declared if d.kind == "class" and self.is_a(d, t)]
        known = [v for v, d in graph if d in derived]
        if known and r.random() < 0.5:
            return r.choice(known)
        if budget[0] < 0 or len(graph) >= 20 or r.random() < 0.2:
            return None
        t = r.choice(derived)
        v = getattr(module, t.name)()
        graph.append((v, t))
        for name, ft, tag in t.all_fields():
            unset = tag is not None and r.random() < 0.5
            setattr(v, name, Ice.Unset if unset else self.value(ft, module, ic, budget, graph))
        return v

    @staticmethod
    def is_a(t, base):
        return t is base or (t.base is not None and Model.is_a(t.base, base))

    def scalar(self, kind, ic):
        r = self.random
        if kind == "bool":
            return r.random() < 0.5
        if kind in ("byte", "short", "int", "long"):
            low, high = {"byte": (0, 255), "short": (-2**15, 2**15 - 1), "int": (-2**31, 2**31 - 1),
                         "long": (-2**63, 2**63 - 1)}[kind]
            return r.choice([low, high, 0, r.randint(low, high)])
        if kind == "double":
            return r.choice([0.0, -1.5, 1e300, r.random()])
        if kind == "float":
            return struct.unpack("<f", struct.pack("<f", r.uniform(-1e6, 1e6)))[0]
        if kind == "string":
            letters = string.ascii_letters + "\0\n\u00e9\u20ac\U0001F681"
            return "".join(r.choice(letters) for _ in range(r.choice([0, 1, 5, 20])))
        text = r.choice(["", "a", "cat/name", "a -o", "b -f face", "c -O", "d -s", "e @ adapter"])
        if not text:
            return None
        if "@" not in text:
            text += r.choice(["", ":tcp -h 127.0.0.1 -p 10000",
                              ":udp -h 127.0.0.1 -p 3:tcp -h 10.0.0.1 -p 4 -t 5000"])
        return ic.stringToProxy(text)
