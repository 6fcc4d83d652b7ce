# SPDX-License-Identifier: MIT
"""icesoc: calls vehicles by name from Python, with an unmodified ZeroC Ice and the radio plugin.

    import icesoc
    with icesoc.connect("uav1") as vehicle:
        engine = vehicle.proxy("hwengine1", "Autopilot.HwProcessingEngine")
        print(engine.getResult())

The vehicles are listed in a file of Ice properties (vehicles.py): the argument `file` of connect(),
else $ICESOC_VEHICLES, else ~/.config/icesoc/vehicles.conf, else /etc/icesoc/vehicles.conf.
"""
import importlib

import Ice

from . import places, plugged, vehicles
from .vehicles import Unknown

__all__ = ["Vehicle", "Unknown", "connect", "load_slice"]


def load_slice(*files):
    """Loads Slice files and makes their types available; without arguments, all installed Slice
    files."""
    for file in files or map(places.slice_file, places.SLICE_FILES):
        Ice.loadSlice("", ["-I" + (Ice.getSliceDir() or "."), file])


class Vehicle:
    """A vehicle with the communicator that reaches it. Use it in a `with` statement, or close
    it."""

    def __init__(self, communicator, place):
        self.communicator, self.place = communicator, place

    def proxy(self, identity, interface=None, oneway=False):
        """Returns a proxy of the vehicle's object `identity`. interface: name of the object's type,
        such as "Autopilot.Vehicle"; it is not checked with the vehicle. Without an interface, the
        proxy is an Ice.ObjectPrx. oneway: calls do not wait for the vehicle."""
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
    """Returns the Vehicle with this name. file: the file that lists the vehicles. properties: Ice
    properties in addition to those in the file. A call fails after 10 s without a reply, unless
    Ice.Default.InvocationTimeout is set."""
    place, found = vehicles.find(name, file)
    found = {"Ice.Default.InvocationTimeout": "10000", **found, **(properties or {})}
    communicator = plugged.initialize(found, places.plugin() if vehicles.has_radio(place) else None,
                                      found.get("XBeeAT.Guard", 1000),
                                      found.get("XBeeAT.KeyFile", ""))
    load_slice()
    return Vehicle(communicator, place)
