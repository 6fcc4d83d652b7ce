# SPDX-License-Identifier: MIT
"""mapping: converts checked values to values of stock Ice for Python, and back. The types come from
Ice.loadSlice; no files are generated."""
import importlib
import keyword

import Ice

from icesoc.call.declarations import INTEGERS
from icesoc.util.errors import Stop


def escaped(name):
    """Returns the name in Python for a name in Slice."""
    return "_" + name if keyword.iskeyword(name) or name in ("exec", "print", "self") else name


class Mapping:
    """The Python types for some Slice files."""

    def __init__(self, slices, communicator):
        self.slices, self.communicator = slices, communicator
        self.loaded = set()
        # function that takes the name of an interface and returns the proxy of a listener
        self.listeners = None

    def load(self, file):
        """Loads a Slice file, if it is not loaded already."""
        if file in self.loaded:
            return
        self.loaded.add(file)
        folder = Ice.getSliceDir()
        options = ["-I" + folder] if folder else []
        try:
            Ice.loadSlice("", [*options, *self.slices.includes, str(file)])
        except RuntimeError as error:
            raise Stop(f"'{file}': stock Ice cannot load it: {error}", 2) from None

    def of(self, name, suffix=""):
        """Returns the Python class for a name such as ::Cores::Fir; `suffix` is appended to the
        name of the class."""
        self.load(self.slices.get(name)["file"])
        *modules, last = name.lstrip(":").split("::")
        found = importlib.import_module(".".join(map(escaped, modules)))
        return getattr(found, last + suffix if suffix else escaped(last))

    def into(self, value, kind, where=""):
        """Converts a checked value to the value for stock Ice."""
        if kind.endswith("*"):
            return self.proxy(value, kind[:-1], where)
        its = self.slices.get(kind)
        if value is None:
            return None
        if its["kind"] == "enum":
            return getattr(self.of(kind), escaped(value))
        if its["kind"] == "struct":
            return self.filled(self.of(kind)(), value, kind, where)
        if its["kind"] == "class":
            actual = value["@type"]
            return self.filled(self.of(actual)(), value, actual, where)
        if its["kind"] == "sequence" and not isinstance(value, bytes):
            return [self.into(each, its["element"], where) for each in value]
        if its["kind"] == "dictionary":
            return {self.into(key, its["key"]): self.into(each, its["element"], where)
                    for key, each in value}
        return value

    def filled(self, made, value, kind, where):
        for field in self.slices.fields(kind):
            if field["name"] in value:
                setattr(made, escaped(field["name"]),
                        self.into(value[field["name"]], field["type"], f"{where}.{field['name']}"))
        return made

    def proxy(self, value, interface, where):
        if value is None:
            return None
        if value == "watch" and self.listeners:
            return self.listeners(interface)
        try:
            found = self.communicator.stringToProxy(value)
        except Ice.Exception as error:
            raise Stop(f"{where}: expected a proxy such as 'uav:tcp -h 127.0.0.1 -p 10000', got "
                       f"'{value}': {getattr(error, 'str', error)}", 2) from None
        if interface == "Object" or found is None:
            return found
        return self.of(interface, "Prx").uncheckedCast(found)

    def outof(self, value, kind):
        """Converts a value of stock Ice to a checked value, which consists of JSON's types and of
        bytes."""
        if kind.endswith("*"):
            return None if value is None else str(value)
        if value is None or value is Ice.Unset:
            return None
        if kind in INTEGERS:
            return int(value)
        its = self.slices.get(kind)
        if its["kind"] == "enum":
            return value.name
        if its["kind"] in ("struct", "class"):
            return self.object(value, kind)
        if its["kind"] == "sequence":
            if its["element"] == "byte":
                return bytes(value)
            return [self.outof(each, its["element"]) for each in value]
        if its["kind"] == "dictionary":
            pairs = [[self.outof(k, its["key"]), self.outof(v, its["element"])]
                     for k, v in value.items()]
            return {key: each for key, each in pairs} if all(
                isinstance(key, (str, int)) for key, _ in pairs) else pairs
        if kind == "sequence<string>":
            return list(value)
        return value

    def object(self, value, kind):
        """Converts a struct, a class or an exception to a dict of its fields."""
        actual = value.ice_id() if hasattr(value, "ice_id") else kind
        found = self.slices.fields(actual if actual in self.slices.declarations else kind)
        return {field["name"]: self.outof(getattr(value, escaped(field["name"])), field["type"])
                for field in found}
