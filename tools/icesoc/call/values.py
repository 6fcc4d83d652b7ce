# SPDX-License-Identifier: MIT
"""values: converts the arguments of a call from texts to checked values, and results to text.
mapping.py converts between checked values and values of stock Ice.

A checked value consists of the types that JSON has, and of bytes for a sequence<byte>. Every value
is checked against Slice before a communicator is created: "threshold: expected 0 to 255, got 300".
"""
import json
import math
import os
import re

from icesoc.call.declarations import INTEGERS, listed
from icesoc.util.errors import Stop, nearest

FLOAT_LIMIT = 3.4028234663852886e38
DEEPEST = 100  # largest nesting depth of a value
SHOWN_BYTES = 64  # number of bytes of a sequence<byte> that are printed


class Refused(Stop):
    """A value that does not fit its type."""

    def __init__(self, where, expected, got):
        super().__init__(f"{where}: expected {expected}, got {got}", 2)


def short(value):
    """Returns a value as a short text for a message."""
    text = value if isinstance(value, str) else json.dumps(value, default=repr)
    text = text.encode("utf-8", "replace").decode().replace("\n", " ")
    text = text if len(text) <= 60 else text[:57] + "..."
    return f"'{text}'" if isinstance(value, str) else text


def parse(text, where):
    """Parses JSON; a key that occurs twice is an error."""
    def pairs(found):
        names = [name for name, _ in found]
        if twice := next((n for n in names if names.count(n) > 1), None):
            raise Stop(f"{where}.{twice}: given twice", 2)
        return dict(found)

    try:
        return json.loads(text, object_pairs_hook=pairs)
    except RecursionError:
        raise Refused(where, f"JSON of at most {DEEPEST} levels", short(text)) from None
    except ValueError as error:
        at = f" (column {error.colno}: {error.msg})" if isinstance(
            error, json.JSONDecodeError) else ""
        raise Refused(where, "JSON", short(text) + at) from None


def contents(path, where):
    """Returns the bytes of a file that an argument names with @."""
    try:
        with open(path, "rb") as file:
            return file.read()
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise Stop(f"{where}: cannot read '{path}': {reason}", 2) from None


class Reader:
    """Converts arguments and checks them against the types of Slice files."""

    def __init__(self, slices, place="."):
        """place: folder to which file names are relative."""
        self.slices, self.place = slices, place

    def argument(self, text, parameter):
        """Converts a text from the command line to a parameter's value, and checks the value."""
        where, kind = parameter["name"], parameter["type"]
        metadata = parameter.get("metadata")
        if "tag" in parameter and text == "null":
            return None
        structure = self.slices.get(kind)["kind"]
        try:
            text.encode()
        except UnicodeEncodeError:
            raise Refused(where, "text in UTF-8", short(text)) from None
        if text.startswith("@") and kind != "string" and not kind.endswith("*"):
            return self.of_file(os.path.join(self.place, text[1:]), kind, where, metadata)
        if kind == "string" or kind.endswith("*") or structure == "enum":
            return self.check(text, kind, where, metadata)
        if self.is_bytes(kind) and re.fullmatch("0x([0-9a-fA-F]{2})*", text):
            return self.check(bytes.fromhex(text[2:]), kind, where, metadata)
        if kind in INTEGERS and re.fullmatch(r"[+-]?0[xX][0-9a-fA-F]{1,32}", text):
            return self.check(int(text, 16), kind, where, metadata)
        if kind in (*INTEGERS, "float", "double", "bool"):
            return self.check(self.scalar(text, kind), kind, where, metadata)
        return self.check(parse(text, where), kind, where, metadata)

    def scalar(self, text, kind):
        """Returns the text as a number or a bool. If it is neither, returns the text itself, which
        the error message quotes."""
        if kind == "bool":
            return {"true": True, "false": False}.get(text, text)
        if re.fullmatch(r"[+-]?\d{1,40}", text, re.A) and (kind in INTEGERS or len(text) < 300):
            return int(text)
        if kind in ("float", "double"):
            if text.lower().lstrip("+-") in ("nan", "inf") or re.fullmatch(
                    r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", text, re.A):
                return float(text)
        return text

    def is_bytes(self, kind):
        return self.slices.get(kind).get("element") == "byte" \
            and self.slices.get(kind)["kind"] == "sequence"

    def of_file(self, path, kind, where, metadata):
        """Returns the value in a file: its bytes for a sequence<byte>; its picture for a struct of
        width, height and pixels; the parsed JSON for any other type."""
        data = contents(path, where)
        if self.is_bytes(kind):
            return self.check(data, kind, where, metadata)
        if picture := self.picture_fields(kind):
            return self.check(self.picture(path, where, picture), kind, where, metadata)
        try:
            return self.check(parse(data.decode(), where), kind, where, metadata)
        except UnicodeDecodeError:
            raise Refused(where, f"JSON in '{path}'", "bytes that are not UTF-8") from None

    def picture_fields(self, kind):
        """If a struct consists of width, height and pixels, returns the names of these fields."""
        if self.slices.get(kind)["kind"] != "struct":
            return None
        fields = {field["name"]: field["type"] for field in self.slices.fields(kind)}
        pixels = [name for name, each in fields.items() if self.is_bytes(each)]
        if len(fields) == 3 and len(pixels) == 1 and {"width", "height"} <= set(fields):
            return "width", "height", pixels[0]
        return None

    @staticmethod
    def picture(path, where, names):
        from PIL import Image, UnidentifiedImageError
        try:
            with Image.open(path) as image:
                grey = image.convert("L")
        except (UnidentifiedImageError, OSError, Image.DecompressionBombError) as error:
            reason = getattr(error, "strerror", None) or error
            raise Refused(where, "a picture", f"'{path}' ({reason})") from None
        return dict(zip(names, (grey.width, grey.height, grey.tobytes())))

    def check(self, value, kind, where, metadata=(), depth=0):
        """Returns the value if it fits the type; raises Refused otherwise."""
        if depth > DEEPEST:
            raise Refused(where, f"at most {DEEPEST} levels", "more")
        if kind in INTEGERS:
            return self.integer(value, kind, where, metadata)
        if kind == "bool":
            if not isinstance(value, bool):
                raise Refused(where, "true or false", short(value))
            return value
        if kind in ("float", "double"):
            return self.number(value, kind, where)
        if kind == "string":
            return self.string(value, where)
        if kind.endswith("*"):
            if value is not None and not isinstance(value, str):
                raise Refused(where, "a proxy such as 'uav:tcp -h 127.0.0.1 -p 10000', or null",
                              short(value))
            return None if value in ("null", "") else value
        declaration = self.slices.get(kind)
        checks: dict = {"enum": self.enumerator, "struct": self.structure,
                        "sequence": self.sequence,
                        "dictionary": self.dictionary, "class": self.instance}
        if declaration["kind"] not in checks:
            raise Stop(f"{where}: values of the type {self.slices.named(kind)} cannot be given "
                       "here", 2)
        return checks[declaration["kind"]](value, kind, where, metadata, depth)

    def integer(self, value, kind, where, metadata):
        low, high = self.slices.bounds(kind, metadata)
        if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
            raise Refused(where, f"{low} to {high}", short(value))
        return value

    @staticmethod
    def number(value, kind, where):
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise Refused(where, "a number", short(value))
        try:
            value = float(value)
        except OverflowError:
            value = math.inf
            raise Refused(where, "a number", "one that is too large") from None
        if kind == "float" and math.isfinite(value) and abs(value) > FLOAT_LIMIT:
            raise Refused(where, f"-{FLOAT_LIMIT:.6e} to {FLOAT_LIMIT:.6e}", f"{value:g}")
        return value

    @staticmethod
    def string(value, where):
        if not isinstance(value, str):
            raise Refused(where, "a text", short(value))
        try:
            value.encode()
        except UnicodeEncodeError:
            raise Refused(where, "text in UTF-8", short(value)) from None
        return value

    def enumerator(self, value, kind, where, metadata, depth):
        names = [one["name"] for one in self.slices.get(kind)["enumerators"]]
        if value not in names:
            near = nearest(value, names) if isinstance(value, str) else ""
            raise Refused(where, listed(names), short(value) + near)
        return value

    def structure(self, value, kind, where, metadata, depth, ignored=()):
        fields = self.slices.fields(kind)
        names = [field["name"] for field in fields]
        if not isinstance(value, dict):
            raise Refused(where, f"an object with {listed(names)}", short(value))
        for name in value:
            if name not in names and name not in ignored:
                raise Stop(f"{where}.{name}: {self.slices.named(kind)} has no such field"
                           f"{nearest(name, names) or '; it has ' + listed(names)}", 2)
        made = {}
        for field in fields:
            name, inner = field["name"], f"{where}.{field['name']}"
            if name not in value and "tag" in field:
                continue
            if name not in value and "default" not in field:
                raise Stop(f"{inner}: missing; expected {self.slices.explained(field)}", 2)
            if value.get(name, 0) is None and "tag" in field:
                continue
            made[name] = self.check(value.get(name, field.get("default")), field["type"], inner,
                                    field.get("metadata"), depth + 1)
        return made

    def instance(self, value, kind, where, metadata, depth):
        """Checks an instance of a class: a JSON object, with "@type" for a derived class, or
        null."""
        if value is None:
            return None
        actual = value.get("@type", kind) if isinstance(value, dict) else kind
        actual = actual if str(actual).startswith("::") else "::" + str(actual).replace(".", "::")
        if kind not in self.slices.lineage(actual):
            raise Refused(f"{where}.@type", f"{kind} or a class derived from it", short(actual))
        made = self.structure(value, actual, where, metadata, depth, ("@type", ))
        return {"@type": actual, **made}

    def sequence(self, value, kind, where, metadata, depth):
        element = self.slices.get(kind)["element"]
        most = self.slices.most(kind, metadata)
        if not isinstance(value, (list, bytes)) or isinstance(value, bytes) and element != "byte":
            raise Refused(where, f"a list of {self.slices.named(element)}", short(value))
        if most is not None and len(value) > most:
            raise Refused(where, f"at most {most} elements", len(value))
        if isinstance(value, bytes):
            return value
        made = [self.check(each, element, f"{where}[{at}]", (), depth + 1)
                for at, each in enumerate(value)]
        return bytes(made) if element == "byte" else made

    def dictionary(self, value, kind, where, metadata, depth):
        """Checks a dictionary: a JSON object, or a list of pairs [key, value], which allows any
        type of key."""
        its = self.slices.get(kind)
        if isinstance(value, dict):
            pairs = [(self.argument(key, {"name": f"key of {where}", "type": its["key"]}), inner)
                     for key, inner in value.items()]
        elif isinstance(value, list) and all(isinstance(p, list) and len(p) == 2 for p in value):
            pairs = [(self.check(key, its["key"], f"key of {where}", (), depth + 1), inner)
                     for key, inner in value]
        else:
            raise Refused(where, "an object, or a list of [key, value]", short(value))
        keys = [json.dumps(key, default=repr) for key, _ in pairs]
        if twice := next((key for key in keys if keys.count(key) > 1), None):
            raise Stop(f"{where}: duplicate key {twice}", 2)
        return [[key, self.check(inner, its["element"], f"{where}[{json.dumps(key, default=repr)}]",
                                 (), depth + 1)] for key, inner in pairs]


def readable(value, indent=""):
    """Returns a value as text for people: one line per field, long lists shortened."""
    if isinstance(value, bytes):
        text = value[:SHOWN_BYTES].hex(" ")
        return f"{len(value)} bytes" + (f": {text}" if value else "") + (
            " ..." if len(value) > SHOWN_BYTES else "")
    if isinstance(value, dict):
        inner = indent + "  "
        return "".join(f"\n{inner}{name}: {readable(each, inner)}" for name, each in value.items()
                       ) if value else "{}"
    if isinstance(value, list) and any(isinstance(each, (dict, list)) for each in value):
        return f"{len(value)} elements" + "".join(
            f"\n{indent}  {json.dumps(each, default=plain)}" for each in value)
    return json.dumps(value, ensure_ascii=False, default=plain)


def plain(value):
    """Returns a value in which a list of numbers replaces bytes, because JSON has no bytes."""
    return list(value)
