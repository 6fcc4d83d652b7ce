# SPDX-License-Identifier: MIT
"""vehicles: finds a vehicle by its name in a file of Ice properties that lists the vehicles. A
flight writes such a file, OUT/vehicles.conf, while its vehicles can be called.

The file is the argument `file` of find(), else $ICESOC_VEHICLES, else
~/.config/icesoc/vehicles.conf, else /etc/icesoc/vehicles.conf:

    Vehicle.uav1=xbee-at -d /dev/icesoc-modem -a 0x0001
    Vehicle.uav7=tcp -h gateway -p 10000
    XBeeAT.KeyFile=/etc/icesoc/uav1.key

If the file sets Ice.Default.Locator, a vehicle that the file does not list is looked up in IceGrid.
"""
import os

import Ice

FILES = ("~/.config/icesoc/vehicles.conf", "/etc/icesoc/vehicles.conf")
PREFIX = "Vehicle."


class Unknown(LookupError):
    """The vehicle, or the file that lists vehicles, was not found. The text explains what to do."""


def settings_file(file):
    """Returns the file that lists the vehicles."""
    given = file or os.environ.get("ICESOC_VEHICLES")
    for path in [given] if given else map(os.path.expanduser, FILES):
        if os.path.isfile(path):
            return path
    raise Unknown("no file lists the vehicles: expected %s with a line such as\n"
                  "Vehicle.uav1=xbee-at -d /dev/icesoc-modem -a 0x0001" %
                  (given or " or ".join(FILES)))


def read(path):
    """Returns ({name: endpoint}, {name: value of another property}) of a file. Raises
    Ice.FileException if the file cannot be read."""
    found = Ice.createProperties()
    found.load(path)
    properties = found.getPropertiesForPrefix("")
    return {key[len(PREFIX):]: properties.pop(key) for key in list(properties)
            if key.startswith(PREFIX)}, properties


def text(vehicles, **flight):
    """Returns the content of the file for {name: endpoint}, with properties Flight.*."""
    properties = {**{PREFIX + name: place for name, place in vehicles.items()},
                  **{f"Flight.{name}": str(value) for name, value in flight.items()}}
    return "".join(f"{name}=" + value.replace("\\", "\\\\").replace("#", "\\#") + "\n"
                   for name, value in properties.items())


def find(name, file=None):
    """Returns (place, properties) for the vehicle with this name; without a name, for the only
    vehicle in the file. place: the part of a proxy after the identity, such as ":tcp -h gateway -p
    10000". properties: Ice properties from the file."""
    path = settings_file(file)
    vehicles, properties = read(path)
    if not name and len(vehicles) == 1:
        name = next(iter(vehicles))
    if name in vehicles:
        return ":" + vehicles[name], properties
    if name and properties.get("Ice.Default.Locator"):
        return "@" + name, properties
    if not name and vehicles:
        raise Unknown("vehicle: expected a name, as %s lists several: %s" %
                      (path, ", ".join(sorted(vehicles))))
    raise Unknown("vehicle '%s': expected one of %s; add a line Vehicle.%s=... to %s for another "
                  "vehicle" %
                  (name, ", ".join(sorted(vehicles)) or "none", name or "NAME", path))


def has_radio(place):
    """Returns whether the radio plugin is needed to reach this place."""
    return place.startswith((":xbee-at", ":serial"))
