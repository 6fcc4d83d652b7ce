# SPDX-License-Identifier: MIT
"""call: a user's program that calls a core with the installed Python module.

    call.py VEHICLE     with ICESOC_VEHICLES, the file that lists the vehicles
"""
import sys

import icesoc

with icesoc.connect(sys.argv[1], properties={"Ice.Default.InvocationTimeout": "60000"}) as vehicle:
    engine = vehicle.proxy("hwengine1", "Autopilot.HwProcessingEngine")
    engine.setParameterA(24)
    engine.startProcessing()
    print("corners:", engine.getResult().found)
