# SPDX-License-Identifier: MIT
"""target: finds the endpoint of a call: a flight in progress, a serial device, the gateway, a name
in IceGrid, or an endpoint in the installed settings."""
import re
from dataclasses import dataclass, field

import places

from icesoc.call import objects
from icesoc.util.errors import Stop


@dataclass
class Target:
    """The target of a call: properties for the communicator, and the address for proxies."""
    place: str  # for messages
    suffix: str = ""  # part of the proxy after the identity: ":tcp -h ..." or "@uav1"
    properties: dict = field(default_factory=dict)
    build: str = ""  # build folder of the vehicle; empty: unknown
    plugin: str = ""  # folder of the radio plugin
    key: str = ""
    guard: int = 1000
    # endpoints at which this program receives calls from the vehicle; empty: the vehicle uses the
    # connection that this program has opened
    callbacks: str = ""

    def proxy(self, identity, mode="", facet=""):
        quoted = identity.replace("\\", "\\\\").replace('"', '\\"')
        options = (f' -f "{facet}"' if facet else "") + mode
        return f'"{quoted}"{options}{self.suffix}'


def of_flight(folder, vehicle):
    """Returns the target of a flight in progress."""
    found = {folder: objects.flight(folder)} if folder else objects.flights()
    if not any(found.values()):
        place = f"in {folder}" if folder else "below build/"
        raise Stop(f"no flight is in progress {place}: start one with ./icesoc run --live, or give "
                   "--flight, --device or --gateway", 4)
    folder, live = next(iter(found.items()))
    name = vehicle or next(iter(live.vehicles))
    if name not in live.vehicles:
        raise Stop(f"--vehicle: expected one of {', '.join(live.vehicles)}, got '{name}'", 2)
    return Target(f"the flight in {folder}", ":" + live.vehicles[name], build=live.build)


def of_device(values):
    """Returns the target at a serial port, with a modem or a cable."""
    kind = "serial" if values.wire else "xbee-at"
    plugin = values.plugin or (
        places.plugin() if places.IS_INSTALLED else f"{values.build}/ground")
    address = values.address
    return Target(
        f"the vehicle {address} at {values.device}",
        f':{kind} -d "{values.device}" -a {address} -t {int(1000 * values.timeout)}',
        build=values.build, plugin=plugin, key=values.key or "", guard=values.guard,
        callbacks=f'{kind} -d "{values.device}"')


def of_gateway(values):
    """Returns the target of a gateway, given as HOST:PORT or as endpoints of Ice."""
    text = values.gateway
    if " " in text:
        return Target(text, ":" + text, build=values.build)
    found = re.fullmatch(r"(?:\[([0-9a-fA-F:.]+)\]|([^:\[\]]+)):(\d{1,5})", text)
    if not found or not 0 < int(found[3]) <= 65535:
        raise Stop(f"--gateway: expected HOST:PORT, [::1]:PORT or Ice's endpoints, got '{text}'", 2)
    return Target(text, f':tcp -h "{found[1] or found[2]}" -p {found[3]}', build=values.build)


def of_settings(values):
    """Returns the target for a vehicle that vehicles.conf lists."""
    import vehicles
    try:
        suffix, properties = vehicles.find(values.vehicle)
    except vehicles.Unknown as error:
        is_option_missing = str(error).startswith("vehicle:")
        raise Stop(("--" if is_option_missing else "") + str(error), 2) from None
    radio = re.match(r':(xbee-at|serial)\b.* (-d ("[^"]*"|\S+))', suffix)
    return Target(f"'{values.vehicle}'" if values.vehicle else suffix[1:], suffix, properties,
                  build=values.build, plugin=values.plugin or places.plugin() if radio else "",
                  callbacks=f"{radio[1]} {radio[2]}" if radio else "")


def of(values):
    """Returns the target that the options name. Without such an option, the target is the flight in
    progress; for the installed program, it is a vehicle in vehicles.conf."""
    given = [name for name in ("flight", "device", "gateway", "locator") if getattr(values, name)]
    if len(given) > 1:
        raise Stop(f"{', '.join('--' + name for name in given)} exclude each other; give only "
                   "one of them",
                   2)
    if values.locator:
        name = values.vehicle or "uav1"
        return Target(f"'{name}' in IceGrid", f"@{name}",
                      {"Ice.Default.Locator": values.locator}, build=values.build)
    if values.device:
        return of_device(values)
    if values.gateway:
        return of_gateway(values)
    if places.IS_INSTALLED:
        return of_settings(values)
    return of_flight(values.flight, values.vehicle)
