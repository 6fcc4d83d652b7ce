# SPDX-License-Identifier: MIT
"""plugged: a communicator of stock ZeroC Ice with the radio plugin in it."""

import os

import Ice


def use_second_clock():
    """Follows the simulator's second ground station, if a simulator has started this program: its
    counters' file is named as the first one's, with a 2."""
    clock = os.environ.get("XBEEAT_CLOCK")
    if clock and not clock.endswith("2"):
        os.environ["XBEEAT_CLOCK"] = clock + "2"


def initialize(settings, plugin, guard, key):
    """Returns a communicator with these properties. plugin: folder of libxbeeat.so.37, empty or
    None: no radio; guard: the modem's guard time in ms; key: file with the link's key, empty: in
    the clear."""
    if plugin:
        settings = {"Ice.Plugin.XBeeAT": os.path.join(plugin, "xbeeat") + ":createXBeeAT",
                    "XBeeAT.Guard": str(guard),
                    "XBeeAT.KeyFile": key, **settings}
    data = Ice.InitializationData()
    data.properties = Ice.createProperties()
    for name, value in settings.items():
        data.properties.setProperty(name, value)
    return Ice.initialize(data)
