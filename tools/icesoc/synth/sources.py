# SPDX-License-Identifier: MIT
"""sources: finds the Verilog files that a module needs by following its instances, and reads the
list of designs to synthesise, with their limits (synth/designs.json)."""
import dataclasses
import functools
import json
import pathlib
import re

from icesoc.util.errors import Stop
from icesoc.util.files import digest

# A comment, a string, a word or directive, or the punctuation that marks instances.
TOKEN = re.compile(r'//[^\n]*|/\*.*?(?:\*/|$)|"([^"]*)"?|(`?[\w$]+|`)|([()#;]|::)', re.S)

DESIGNS = "synth/designs.json"  # only read_designs() reads this file
PROPERTIES = {"FORMAL", "RULES", "COVER_POINTS"}  # code under these macros is not hardware


@functools.cache
def tokens(text):
    """Returns the words and punctuation of a text, without properties. An include directive becomes
    the token `include and the name."""
    result = []
    # one entry per open `ifdef: True if its text is dropped, False if the text after `else will be
    # dropped
    branches = []
    condition = ""
    for string, word, mark in TOKEN.findall(text):
        if condition:
            branches.append((condition == "`ifdef") if word in PROPERTIES else None)
            condition = ""
        elif word in ("`ifdef", "`ifndef"):
            condition = word
        elif word in ("`else", "`elsif") and branches:
            branches[-1] = {False: True, True: None}.get(branches[-1])
        elif word == "`endif" and branches:
            branches.pop()
        elif (word or mark or (result and result[-1] == "`include")) and True not in branches:
            result.append(word or mark or string)
    return result


def is_name(token):
    return token[:1].isalpha() or token[:1] == "_"


def closing(t, opened):
    """Returns the index after the parenthesis that closes the parenthesis at `opened`."""
    depth = 0
    for i in range(opened, len(t)):
        depth += {"(": 1, ")": -1}.get(t[i], 0)
        if depth == 0:
            return i + 1
    return len(t)


@functools.cache
def read(file):
    return pathlib.Path(file).read_text(errors="replace")


@dataclasses.dataclass
class Module:
    """A module, or a SystemVerilog package, which is treated as an instance of its users."""
    file: pathlib.Path
    is_package: bool = False
    # Instance name -> module names. A name has several modules if branches of `ifdef or generate
    # use the same name.
    instances: dict = dataclasses.field(default_factory=dict)
    includes: set = dataclasses.field(default_factory=set)


class Library:
    """All modules in the *.v files of these folders, then in these files. If two modules have the
    same name, the first one counts."""

    def __init__(self, folders, include_folders, files=()):
        self.include_folders = list(include_folders)
        self.modules = {}
        for folder in folders:
            if not folder.is_dir():
                raise Stop(f"expected a folder, got {folder}")
            for file in sorted(folder.glob("*.v")):
                self.scan(file)
        for file in files:
            self.scan(file)
        # a name that is not a module does not mark an instance
        for module in self.modules.values():
            module.instances = {name: known for name, types in module.instances.items()
                                if (known := [t for t in types if t in self.modules])}

    def included(self, name):
        """Returns the file that an include directive names; None if it is not found."""
        return next((folder / name for folder in self.include_folders if (folder / name).exists()),
                    None)

    def all_tokens(self, file):
        """Returns the tokens of a file, with the tokens of included files after each include."""
        result = []
        for token in tokens(read(file)):
            is_include = bool(result) and result[-1] == "`include"
            result.append(token)
            if is_include and self.included(token):
                result += tokens(read(self.included(token)))
        return result

    def scan(self, file):
        t = self.all_tokens(file) + ["", ""]
        # an import outside a module applies to everything after the import
        current, outside = None, {}
        for i, token in enumerate(t[:-2]):
            if token in ("module", "package") and is_name(t[i + 1]):
                current = None
                if t[i + 1] not in self.modules:
                    current = self.modules[t[i + 1]] = Module(file, token == "package", {**outside})
            elif token in ("endmodule", "endpackage"):
                current = None
            elif token == "::":
                (current.instances if current else outside)["::" + t[i - 1]] = [t[i - 1]]
            elif current and token == "`include":
                current.includes.add(t[i + 1])
            elif current and t[i + 2] == "(" and is_name(token):
                k = i + 1  # TYPE [#(...)] NAME (
                if t[k] == "#" and t[k + 1] == "(":
                    k = closing(t, k + 1)
                if k + 1 < len(t) and is_name(t[k]) and t[k + 1] == "(":
                    current.instances.setdefault(t[k], []).append(token)

    def reach(self, top):
        """Returns the module and all modules that it instantiates."""
        if top not in self.modules:
            raise Stop(f"unknown module {top}")
        found, left = {top}, [top]
        while left:
            for types in self.modules[left.pop()].instances.values():
                left += set(types) - found
                found.update(types)
        return found

    def files_of(self, top):
        return sorted({self.modules[module].file for module in self.reach(top)})

    def all_files_of(self, top):
        """Returns the files that the module and its instances need, and the files that these
        include."""
        names = sorted(set().union(*(self.modules[module].includes for module in self.reach(top))))
        return self.files_of(top) + [file for name in names if (file := self.included(name))]

    @functools.cache
    def hash_of(self, top):
        """Returns a hash of all files of the module; it changes if any of them changes."""
        return digest(map(read, self.all_files_of(top)))

    def module_at(self, top, path):
        """Returns the module of the instance at the end of a path of instance names; "" if
        unknown."""
        module = top
        for name in path.split(".") if path else ():
            if name in self.modules[module].instances:
                module = self.modules[module].instances[name][0]
            elif "[" not in name and not name.startswith("g_"):
                return ""  # neither an instance nor a generate block
        return module

    def files_along(self, top, path):
        """Returns the names of the files of all modules along such a path, including the top."""
        names = path.split(".") if path else []
        modules = [self.module_at(top, ".".join(names[:n])) for n in range(len(names) + 1)]
        return {self.modules[module].file.name for module in modules if module}


@dataclasses.dataclass
class Design:
    name: str
    top: str
    title: str = ""
    file: str = ""  # path of the module's file in the project
    parameters: dict = dataclasses.field(default_factory=dict)
    limits: dict = dataclasses.field(default_factory=dict)  # largest "lut", "ff", "slices",
                                                            # "sites"
    pads: dict = dataclasses.field(default_factory=dict)  # output port -> largest delay from any
                                                          # pad, ns, grade -2
    paper: bool = False  # True: the paper has figures for the design
    # The design is mapped this number of additional times, each time with its inputs and outputs
    # in another sequence, because the estimated clock of a single mapping depends on chance.
    orders: int = 0


@dataclasses.dataclass
class Plan:
    chip: dict
    paper: dict  # figures of Table I: "lut", "ff", "slices"
    designs: list
    simulated: dict  # design -> prefixes of the tests that run on its netlist; other designs are
                     # proven
    xilinx: list  # designs with parts that only Xilinx FPGAs have

    def has(self, design, family):
        return family != "ecp5" or design.name not in self.xilinx


def sentence_of(file, module):
    """Returns the sentence in "// name: one sentence" at the head of a file. For a converted core,
    reads the head of its VHDL file."""
    begin = f"// {module}: "
    return next((line.removeprefix(begin) for line in read(file).split("\n", 8)[:8]
                 if line.startswith(begin)), "")


def read_json(file):
    """Reads a JSON file of ours; an exception names the file."""
    try:
        return json.loads(file.read_text())
    except (OSError, ValueError) as error:
        raise Stop(f"{file}: " + (getattr(error, "strerror", None) or f"expected JSON: {error}")
                   ) from None


def read_designs(root="."):
    """Returns the content of synth/designs.json: the designs, the chip, the paper's figures, and
    published reports (published.py)."""
    return read_json(pathlib.Path(root, DESIGNS))


def read_plan(library, root):
    """Returns the plan: the designs in synth/designs.json, and a design for every other module that
    has a file of the same name. `*_rules` and `*_proof` are left out, because they are properties,
    not hardware."""
    j = read_designs(root)
    designs = [Design(**design) for design in j["designs"]]
    for design in designs:
        if design.top not in library.modules:
            raise Stop(f"{pathlib.Path(root, DESIGNS)}: unknown module {design.top}")
    tops = {design.top for design in designs}
    for name, module in sorted(library.modules.items()):
        is_hardware = not name.endswith(("_rules", "_proof")) and not module.is_package
        # From a converted core, only the core itself becomes a design.
        if name not in tops and is_hardware and module.file.stem == name:
            designs.append(Design(name, name, sentence_of(module.file, name)))
    for design in designs:
        design.file = str(relative_to(library.modules[design.top].file, root))
    return Plan(j["chip"], j["paper"], designs, j.get("simulated", {}), j.get("xilinx", []))


def relative_to(file, root):
    file, root = file.absolute(), root.absolute()
    return file.relative_to(root) if file.is_relative_to(root) else file
