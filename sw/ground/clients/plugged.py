# SPDX-License-Identifier: MIT
"""plugged: creates an Ice communicator with the radio plugin, for unmodified ZeroC Ice."""

import os
import signal

import Ice


def interrupt_once():
    """Lets only the first SIGINT raise KeyboardInterrupt. After Ctrl-C, a program that the
    simulator has started gets a second SIGINT from the simulator, while it is ending."""
    def interrupt(number, frame):
        signal.signal(number, signal.SIG_IGN)
        raise KeyboardInterrupt
    # a shell ignores SIGINT for programs in the background
    if signal.getsignal(signal.SIGINT) == signal.default_int_handler:
        signal.signal(signal.SIGINT, interrupt)


def use_second_clock():
    """Selects the clock of the simulator's second ground station, if a simulator has started this
    program. The name of this clock's file is the name of the first ground station's file, followed
    by 2."""
    clock = os.environ.get("XBEEAT_CLOCK")
    if clock and not clock.endswith("2"):
        os.environ["XBEEAT_CLOCK"] = clock + "2"


def quoted(text):
    """Returns a text in the quotes of ZeroC Ice. Without quotes, a space ends an argument of an
    endpoint or a plugin, and a colon ends an endpoint."""
    return '"%s"' % text.replace("\\", "\\\\").replace('"', '\\"')


def initialize(settings, plugin, guard, key):
    """Creates and returns a communicator with the properties `settings`. plugin: folder that
    contains libxbeeat.so.37; empty or None means no radio. guard: guard time of the modem, ms. key:
    file with the key of the link; empty means no key."""
    if plugin:
        entry = os.path.join(plugin, "xbeeat") + ":createXBeeAT"
        settings = {"Ice.Plugin.XBeeAT": quoted(entry),
                    "XBeeAT.Guard": str(guard),
                    "XBeeAT.KeyFile": key, **settings}
    data = Ice.InitializationData()
    data.properties = Ice.createProperties()
    for name, value in settings.items():
        data.properties.setProperty(name, value)
    return Ice.initialize(data)
