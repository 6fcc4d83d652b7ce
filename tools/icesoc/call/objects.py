# SPDX-License-Identifier: MIT
"""objects: the objects of a vehicle with their interfaces and Slice files, from gen/chip.json in
the build folder; and the endpoints of a flight in progress, which the flight writes to
OUT/vehicles.conf.
"""
import contextlib
import os
import re
from dataclasses import dataclass
from pathlib import Path

import places

from icesoc import TREE
from icesoc.call.declarations import Slices, listed
from icesoc.util import chip
from icesoc.util.errors import Stop, nearest

# interface of a core without a servant; its operations read and write the core registers by name
REGISTERS = "::Hw::Registers"
ACCESSES = {"get": ("ro", "rw", "w1c", "w1s"), "set": ("rw", "w1c", "w1s", "ws")}
VEHICLES = "vehicles.conf"  # file in the folder of a flight; it exists only during the flight
VIEWED = "viewed"  # file in the same folder, which is rewritten while a browser shows the page


@dataclass
class Object:
    identity: str
    interface: str = ""  # empty: unknown, so the program asks the object for its interface
    registers: str = ""  # path of the *.regs.json of the object's core
    core: str = ""  # name of the object's core and of the core's register block


def only_interface(slices, files):
    """Returns the interface of a core's servant: the only interface with the metadata [":hw"], or
    else the only interface in the files. Returns "" if the files have several candidates or
    none."""
    folders = {os.path.realpath(file) for file in files}
    found = [name for name in slices.interfaces()
             if os.path.realpath(slices.get(name)["file"]) in folders]
    marked = [name for name in found if ":hw" in slices.get(name).get("metadata", [])]
    return marked[0] if len(marked) == 1 else found[0] if len(found) == 1 else ""


class Catalogue:
    """Everything that can be called: the objects, and the declarations of their interfaces."""

    def __init__(self, build, files=()):
        """build: build folder of the vehicle, or None. files: Slice files to use instead of the
        vehicle's Slice files."""
        cores = []
        self.is_complete = False
        if build is not None:
            with contextlib.suppress(OSError, ValueError):
                cores = chip.read(Path(build, chip.FILE)).objects
                self.is_complete = True
        for core in cores:
            core.slice = [str(TREE / file) for file in core.slice]
        own = [] if build is None else [places.slice_file(file) for file in places.SLICE_FILES]
        all_files = [*files, *own, *(file for core in cores for file in core.slice)]
        self.given = {os.path.realpath(file) for file in files}
        self.slices = Slices(all_files, compiler(build),
                             [folder for folder in ("/usr/share/ice/slice",)
                              if os.path.isdir(folder)])
        self.objects = {}
        if build is not None:
            self.objects = {name: Object(name, interface)
                            for name, interface in places.OBJECTS.items()}
        for core in cores:
            interface = core.interface or only_interface(self.slices, core.slice)
            self.objects[core.identity] = Object(core.identity, interface, core.registers,
                                                 core.core)

    def find(self, text):
        """Returns (object, operation) of OBJECT.OPERATION, or of an operation that only one object
        has."""
        identity, dot, operation = text.rpartition(".")
        if dot:
            return self.objects.get(identity) or self.unknown(identity, operation), operation
        having = [each for each in self.objects.values()
                  if text in self.slices.operations(each.interface)]
        if len(having) == 1:
            return having[0], text
        if text in self.objects:
            names = self.slices.operations(self.objects[text].interface)
            raise Stop(f"{text}: expected {text}.OPERATION; it has {listed(names)}", 2)
        if having:
            raise Stop(f"{text}: expected OBJECT.{text}, because several objects have this "
                       "operation: " + listed(f"{each.identity}.{text}" for each in having), 2)
        every = {name for each in self.objects.values()
                 for name in self.slices.operations(each.interface)}
        raise Stop(f"no object has an operation '{text}'{nearest(text, every)}; --list lists "
                   "all", 2)

    def unknown(self, identity, operation):
        """Returns an object that the build does not list. If exactly one interface in the files of
        --slice declares the operation, the object gets this interface. Otherwise, the program asks
        the object for its interface later."""
        declare = [name for name in self.slices.interfaces()
                   if os.path.realpath(self.slices.get(name)["file"]) in self.given
                   and any(o["name"] == operation for o in self.slices.get(name)["operations"])]
        if self.is_complete and not self.given and (near := nearest(identity, self.objects)):
            raise Stop(f"the vehicle has no object '{identity}'{near}", 2)
        return Object(identity, declare[0] if len(declare) == 1 else "")

    def operation(self, each, name):
        """Returns the operation with this name of an object."""
        found = self.slices.operations(each.interface)
        if name not in found:
            raise Stop(f"{each.identity} has no operation '{name}'"
                       f"{nearest(name, found) or '; it has ' + listed(found)}", 2)
        return found[name]

    def interface_of(self, ids):
        """Returns, among the type ids of an object, the most derived interface that the Slice files
        declare."""
        known = [name for name in ids if name in self.slices.declarations]
        return max(known, key=lambda name: len(self.slices.lineage(name)), default="")


def registers(each):
    """Returns {name: (access, width)} of the registers and fields of an object's core."""
    from icesoc.regs.model import Block, Wrong
    found = {}
    try:
        block = Block.read(each.registers)
    except (Wrong, OSError):
        return found
    for register in block.registers:
        # Bits above the last field have no effect, so the width ends there.
        width = max((f.lsb + f.width for f in register.fields), default=register.width)
        found[register.name] = register.access, width
        for field in register.fields:
            if field.name:
                found[f"{register.name}.{field.name}"] = field.access, field.width
    return found


def check_register(each, operation, values):
    """Checks the name and the value in a call of Hw::Registers against the description of the
    core."""
    if each.interface != REGISTERS or operation not in ACCESSES or not each.registers:
        return
    known, name = registers(each), values["name"]
    if not known or re.fullmatch("0[xX][0-9a-fA-F]+", name):
        return
    fitting = [one for one, (access, _) in known.items() if access in ACCESSES[operation]]
    if name not in fitting:
        reason = f"{known[name][0]}: it cannot be {'read' if operation == 'get' else 'written'}" \
            if name in known else f"not a register{nearest(name, fitting)}"
        raise Stop(f"{name}: {reason}; expected {listed(fitting)}", 2)
    most = (1 << known[name][1]) - 1
    if operation == "set" and not 0 <= values["value"] <= most:
        raise Stop(f"{name}: expected 0 to {most}, got {values['value']}", 2)


def compiler(build):
    """Returns the path of slice2c."""
    candidates = [Path(build, "slice/slice2c")] if build else []
    candidates += [TREE / "build/main/slice/slice2c", Path(places.TOP, "bin/slice2c")]
    return next((path for path in candidates if path.exists()), "slice2c")


@dataclass
class Flight:
    """A flight whose vehicles can be called."""
    vehicles: dict  # name: endpoint
    build: str  # folder


def flight(folder):
    """Returns the flight in progress in this folder, or None."""
    path = Path(folder, VEHICLES)
    if not path.is_file():
        return None
    import Ice  # imported here, because only a flight in progress needs Ice, which loads slowly
    import vehicles
    try:
        found, properties = vehicles.read(str(path))
        os.kill(int(properties["Flight.Process"]), 0)
    except (Ice.FileException, KeyError, ValueError, OverflowError, ProcessLookupError):
        return None
    except PermissionError:
        pass
    return Flight(found, properties.get("Flight.Build", "")) if found else None


def flights():
    """Returns {folder: flight} of all flights in progress below build/, build/run first."""
    folders = sorted((path.parent for path in Path("build").glob("*/" + VEHICLES)),
                     key=lambda folder: folder.name != "run")
    found = {str(folder): flight(folder) for folder in folders}
    return {folder: live for folder, live in found.items() if live}
