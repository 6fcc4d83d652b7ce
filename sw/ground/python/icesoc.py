# SPDX-License-Identifier: MIT
"""icesoc: calls vehicles by name from Python, with stock ZeroC Ice and the radio plugin.

    import icesoc
    with icesoc.connect("uav1") as vehicle:
        engine = vehicle.proxy("hwengine1", "Autopilot.HwProcessingEngine")
        print(engine.getResult())

A file of Ice properties lists the vehicles: FILE of connect(), else $ICESOC_VEHICLES, else
~/.config/icesoc/vehicles.conf, else /etc/icesoc/vehicles.conf:

    Vehicle.uav1=xbee-at -d /dev/icesoc-modem -a 0x0001
    Vehicle.uav7=tcp -h gateway -p 10000
    XBeeAT.KeyFile=/etc/icesoc/uav1.key

A vehicle without a line is looked up in IceGrid, if the file sets Ice.Default.Locator.
"""
import importlib
import os

import Ice

from . import places, plugged

__all__ = ["Vehicle", "Unknown", "connect", "load_slice"]
FILES = ("~/.config/icesoc/vehicles.conf", "/etc/icesoc/vehicles.conf")


class Unknown(LookupError):
    """The vehicle, or the file that lists it, was not found; the text says what to do."""


def load_slice(*files):
    """Makes the types of Slice files available; without names, those of the installed ones."""
    for file in files or map(places.slice_file, places.SLICE_FILES):
        Ice.loadSlice("", ["-I" + (Ice.getSliceDir() or "."), file])


def settings_file(file):
    """Returns the file that lists the vehicles."""
    given = file or os.environ.get("ICESOC_VEHICLES")
    for path in [given] if given else map(os.path.expanduser, FILES):
        if os.path.isfile(path):
            return path
    raise Unknown("no file lists the vehicles: expected %s; write a line such as\n"
                  "Vehicle.uav1=xbee-at -d /dev/icesoc-modem -a 0x0001" %
                  (given or " or ".join(FILES)))


class Vehicle:
    """A vehicle, and the communicator that leads to it. Use it in a `with` statement, or close
    it."""

    def __init__(self, communicator, place):
        self.communicator, self.place = communicator, place

    def proxy(self, identity, interface=None, oneway=False):
        """Returns a proxy of the vehicle's object `identity`: an Ice.ObjectPrx, or of an interface
        such as "Autopilot.Vehicle", not checked. oneway: calls do not wait for the vehicle."""
        text = self.communicator.identityToString(Ice.stringToIdentity(identity))
        proxy = self.communicator.stringToProxy(f"{text}{' -o' if oneway else ''}{self.place}")
        if interface is None:
            return proxy
        module, _, name = interface.replace("::", ".").strip(".").rpartition(".")
        return getattr(importlib.import_module(module), name + "Prx").uncheckedCast(proxy)

    def close(self):
        self.communicator.destroy()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


def connect(name, file=None, properties=None):
    """Returns the Vehicle with this name. properties: Ice's, in addition to those of the file.
    Calls fail after 10 s without a reply, unless Ice.Default.InvocationTimeout differs."""
    path = settings_file(file)
    found = Ice.createProperties()
    found.load(path)
    found = {"Ice.Default.InvocationTimeout": "10000",
             **found.getPropertiesForPrefix(""), **(properties or {})}
    prefix = "Vehicle."
    vehicles = {key[len(prefix):]: found.pop(key) for key in list(found) if key.startswith(prefix)}
    if name in vehicles:
        place = ":" + vehicles[name]
    elif found.get("Ice.Default.Locator"):
        place = "@" + name
    else:
        raise Unknown("vehicle '%s': expected one of %s; or add a line Vehicle.%s=... to %s" %
                      (name, ", ".join(sorted(vehicles)) or "none", name, path))
    has_radio = vehicles.get(name, "").startswith(("xbee-at", "serial"))
    communicator = plugged.initialize(found, places.plugin() if has_radio else None,
                                      found.get("XBeeAT.Guard", 1000),
                                      found.get("XBeeAT.KeyFile", ""))
    load_slice()
    return Vehicle(communicator, place)
