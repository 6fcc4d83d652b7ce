# SPDX-License-Identifier: MIT
"""plugged: creates an Ice communicator with the radio plugin, for unmodified ZeroC Ice."""

import os

import Ice


def use_second_clock():
    """Uses the clock of the simulator's second ground station, if a simulator has started this
    program. The file of its counters has the name of the first one, with a 2."""
    clock = os.environ.get("XBEEAT_CLOCK")
    if clock and not clock.endswith("2"):
        os.environ["XBEEAT_CLOCK"] = clock + "2"


def initialize(settings, plugin, guard, key):
    """Returns a communicator with these properties. plugin: folder with libxbeeat.so.37; empty or
    None means no radio. guard: guard time of the modem, ms. key: file with the key of the link;
    empty means no key."""
    if plugin:
        settings = {"Ice.Plugin.XBeeAT": os.path.join(plugin, "xbeeat") + ":createXBeeAT",
                    "XBeeAT.Guard": str(guard),
                    "XBeeAT.KeyFile": key, **settings}
    data = Ice.InitializationData()
    data.properties = Ice.createProperties()
    for name, value in settings.items():
        data.properties.setProperty(name, value)
    return Ice.initialize(data)
