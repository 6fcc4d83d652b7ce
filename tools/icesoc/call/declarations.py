# SPDX-License-Identifier: MIT
"""declarations: the declarations of Slice files, as printed by `slice2c --describe`.

The command line and the page in the browser use them to check values and to show operations.
"""
import json
import re
import subprocess
from pathlib import Path

from icesoc.util.errors import Stop

INTEGERS = {"byte": (0, 255), "short": (-2**15, 2**15 - 1), "int": (-2**31, 2**31 - 1),
            "long": (-2**63, 2**63 - 1)}
# Operations that every object has
OBJECT = [{"name": "ice_ping", "result": "void", "parameters": [],
           "doc": "Checks that the object exists."},
          {"name": "ice_id", "result": "string", "parameters": [],
           "doc": "Returns the most derived interface of the object."},
          {"name": "ice_ids", "result": "sequence<string>", "parameters": [],
           "doc": "Returns all interfaces of the object."},
          {"name": "ice_isA", "result": "bool", "parameters": [{"name": "id", "type": "string"}],
           "doc": "Checks whether the object has an interface, such as ::Cores::Fir."}]


def listed(words, most=12):
    """Returns words as a list with commas. If there are more than `most` words, the list ends after
    that number, with the total count."""
    words = list(words)
    more = f", ... ({len(words)} in all)" if len(words) > most else ""
    return ", ".join(words[:most]) + more


def annotation(metadata, name):
    """Returns the text after a prefix such as "hw:max:" in metadata, or an empty text."""
    return next((m[len(name) + 1:] for m in metadata or () if m.startswith(name + ":")), "")


class Slices:
    """All declarations of some Slice files. The keys are full names such as ::Cores::Fir."""

    def __init__(self, files, compiler, includes=()):
        self.files = [Path(file) for file in dict.fromkeys(map(str, files))]
        for file in self.files:
            if not file.is_file():
                raise Stop(f"Slice file '{file}' does not exist", 2)
        self.includes = [f"-I{folder}" for folder in includes]
        self.declarations = self.describe(compiler) if self.files else {}

    def describe(self, compiler):
        try:
            done = subprocess.run([str(compiler), "--describe", *self.includes,
                                   *map(str, self.files)], capture_output=True, text=True,
                                  errors="replace")
        except OSError as error:
            raise Stop(f"cannot run the Slice compiler '{compiler}': {error.strerror}; "
                       "./icesoc build makes it, and the package icesoc-slice2c contains "
                       "it") from None
        if done.returncode:
            raise Stop(done.stderr.rstrip(), 2)
        return json.loads(done.stdout)

    def get(self, name):
        return self.declarations.get(name, {"kind": ""})

    def interfaces(self):
        return [name for name, each in self.declarations.items() if each["kind"] == "interface"]

    def lineage(self, name):
        """Returns a declaration and all its bases, the most derived one first."""
        names, todo = [], [name]
        while todo:
            first = todo.pop(0)
            if first not in names and first in self.declarations:
                names.append(first)
                todo += self.get(first).get("bases", []) + self.get(first).get("implements", [])
        return names

    def operations(self, interface):
        """Returns the operations of an interface by name, including inherited operations and the
        operations of every object (ice_ping, ...)."""
        found = {}
        for name in self.lineage(interface):
            for operation in self.get(name).get("operations", []):
                found.setdefault(operation["name"], operation)
        for operation in OBJECT:
            found.setdefault(operation["name"], operation)
        return found

    def fields(self, name):
        """Returns the fields of a struct, class or exception, including inherited fields."""
        return [field for each in reversed(self.lineage(name))
                for field in self.get(each).get("fields", [])]

    def bounds(self, kind, metadata=()):
        """Returns the range of an integer type, narrowed by ["call:range:LOW:HIGH"]."""
        low, high = INTEGERS[kind]
        if given := annotation(metadata, "call:range"):
            found = re.fullmatch(r"(-?\d{1,19}):(-?\d{1,19})", given)
            if not found or not low <= int(found[1]) <= int(found[2]) <= high:
                raise Stop(f'["call:range:{given}"]: expected LOW:HIGH within {low}:{high}', 2)
            low, high = int(found[1]), int(found[2])
        return low, high

    def most(self, kind, metadata=()):
        """Returns the maximum number of elements of a sequence, or None."""
        limits = [annotation(metadata, "hw:max"), annotation(metadata, "c:max"),
                  annotation(self.get(kind).get("metadata"), "c:max")]
        return next((int(limit) for limit in limits if limit), None)

    def named(self, kind):
        """Returns a readable name of a type, such as Cores.Fir. For a sequence or dictionary, the
        name contains the type of the elements. For an enum with at most four enumerators, the
        enumerators are the name."""
        each = self.get(kind)
        if each["kind"] == "sequence":
            return f"sequence<{self.named(each['element'])}>"
        if each["kind"] == "dictionary":
            return f"dictionary<{self.named(each['key'])}, {self.named(each['element'])}>"
        if each["kind"] == "enum" and len(each["enumerators"]) <= 4:
            return "|".join(one["name"] for one in each["enumerators"])
        return kind.lstrip(":").replace("::", ".")

    def signature(self, operation):
        """Returns the signature of an operation as one line."""
        inputs, outputs = [], []
        for parameter in operation["parameters"]:
            target = outputs if parameter.get("out") else inputs
            target.append(f"{parameter['name']}: {self.explained(parameter)}")
        if operation["result"] != "void":
            outputs.insert(0, self.named(operation["result"]))
        return f"{operation['name']}({', '.join(inputs)})" + (
            f" -> {', '.join(outputs)}" if outputs else "")

    def explained(self, parameter):
        """Returns the type of a parameter with its range and its unit."""
        kind, metadata = parameter["type"], parameter.get("metadata")
        text = self.named(kind)
        if kind in INTEGERS and annotation(metadata, "call:range"):
            low, high = self.bounds(kind, metadata)
            text += f" {low}..{high}"
        if unit := annotation(metadata, "call:unit"):
            text += f" {unit}"
        if self.most(kind, metadata) is not None:
            text += f" (at most {self.most(kind, metadata)})"
        return text + (" optional" if "tag" in parameter else "")
