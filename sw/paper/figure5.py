#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Figure 5 of the paper, lower half: the client on the ground. The text is that of the figure,
except for the marked lines:

[1] The figure has HwProcessEnginePrx and uncheckCast.
[2] The proxy names the serial port of the ground station's modem, the UAV's address, and a
    time-out, which includes the set-up of the modem.
[3] The call has results, so the proxy must be two-way: "-o" would make it one-way.
"""

import os
import sys

import Ice

Ice.loadSlice("", [os.path.join(os.path.dirname(os.path.abspath(__file__)), "Figure3.ice")])
import Autopilot  # noqa: E402


class Client(Ice.Application):
    def run(self, args):
        where = ":xbee-at -d %s -a 0x0001 -t 300000" % args[1]  # [2]

        ic = self.communicator()
        proxy = ic.stringToProxy("hwengine1 -o" + where)
        hwobject = Autopilot.HwProcessingEnginePrx.uncheckedCast(proxy)  # [1]

        paramValue = 0

        hwobject.setParameterA(paramValue)
        hwobject.startProcessing()
        # [3]
        twoway = Autopilot.HwProcessingEnginePrx.checkedCast(ic.stringToProxy("hwengine1" + where))
        found = twoway.getResult().found
        while found == 0:  # the core is still working
            found = twoway.getResult().found
        print("figure 5: %d corners at threshold %d" % (found, paramValue))
        return 0


if len(sys.argv) < 2:
    sys.exit("usage: figure5.py DEVICE [--Ice.Plugin.XBeeAT=FOLDER/xbeeat:createXBeeAT]")
sys.exit(Client().main(sys.argv))
