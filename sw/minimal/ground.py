#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""ground: the ground station of the minimal program, with unmodified ZeroC Ice.

Usage: ground.py DEVICE [--reference PROGRAM --frame PICTURE] [Ice options]

Serves the object Station. The vehicle calls Station and passes a proxy, which this program uses to
call the vehicle. The program then calls the vehicle's engine with both encodings and by one-way
calls, and checks that the minimal run time refuses the calls that it does not support.
"""

import argparse
import json
import os
import subprocess
import sys
import threading
import time

import Ice

HERE = os.path.dirname(os.path.abspath(__file__))
Ice.loadSlice("", [os.path.join(HERE, "..", "vehicle", "Autopilot.ice")])
import Autopilot  # noqa: E402

THRESHOLD = 24
CALLS = 20


class StationI(Autopilot.Station):
    """Counts the calls from the vehicle: the first call is two-way, the second call is one-way."""

    def __init__(self):
        self.called = threading.Semaphore(0)
        self.vehicle = None

    def vehicleState(self, uav, params, current):
        self.vehicle = uav
        self.called.release()


def expect(what, is_so):
    print("%-60s %s" % (what, "yes" if is_so else "NO"), flush=True)
    if not is_so:
        raise RuntimeError(what)


def raises(kind, function):
    try:
        function()
    except kind:
        return True
    return False


def fly(communicator, args):
    station = StationI()
    adapter = communicator.createObjectAdapterWithEndpoints(
        "Station", "xbee-at -d %s -a 0x0001 -s 0x0000" % args.device)
    adapter.add(station, Ice.stringToIdentity("station"))
    adapter.activate()
    where = ":xbee-at -d %s -a 0x0001 -t 300000" % args.device
    proxy = communicator.stringToProxy("hwengine1" + where)

    engine = Autopilot.HwProcessingEnginePrx.checkedCast(proxy)
    expect("the engine is one (ice_isA)", engine is not None)
    expect("the vehicle calls its station, two-way and one-way",
           all(station.called.acquire(timeout=300) for _ in range(2)))
    station.vehicle.ice_ping()
    expect("the proxy that it passes leads to its object", True)

    begin = time.monotonic()
    for _ in range(CALLS):
        engine.ice_ping()
    print("%d pings: %.0f ms each" % (CALLS, (time.monotonic() - begin) * 1000 / CALLS), flush=True)
    old = engine.ice_encodingVersion(Ice.Encoding_1_0)
    old.setParameterA(THRESHOLD)
    Autopilot.HwProcessingEnginePrx.uncheckedCast(engine.ice_oneway()).startProcessing()
    result = engine.getResult()
    while result.cycles == 0:  # the core is still working
        result = old.getResult()
    print("%d corners at threshold %d, in %d cycles" % (result.found, THRESHOLD, result.cycles))
    expect("the core found corners", result.found > 0)
    if args.reference:
        text = subprocess.run([args.reference, args.frame, str(THRESHOLD)], check=True,
                              capture_output=True, text=True).stdout
        expect("as many as the C++ reference", json.loads(text)["found"] == result.found)

    missing = communicator.stringToProxy("missing" + where)
    expect("a missing object is reported",
           raises(Ice.ObjectNotExistException, missing.ice_ping))
    facet = engine.ice_facet("none")
    expect("facets are not there", raises(Ice.ObjectNotExistException, facet.ice_ping))
    expect("ice_id is refused", raises(Ice.OperationNotExistException, engine.ice_id))
    engine.ice_context({"who": "ground"}).ice_ping()
    expect("contexts are passed over", True)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("device", help="serial port of the ground's modem")
    parser.add_argument("--frame", help="the camera's picture")
    parser.add_argument("--reference", help="program that counts the corners on the host")
    args, rest = parser.parse_known_args()
    properties = Ice.createProperties()
    for key, value in (("Ice.ThreadPool.Server.Size", "2"),
                       ("Ice.Default.InvocationTimeout", "300000"),
                       ("Ice.ACM.Close", "0")):
        properties.setProperty(key, value)
    properties.parseCommandLineOptions("", rest)
    data = Ice.InitializationData()
    data.properties = properties
    with Ice.initialize(rest, data) as communicator:
        try:
            fly(communicator, args)
        except (Ice.Exception, RuntimeError) as e:
            print("ground: %s" % e, file=sys.stderr)
            return 1
    return 0


sys.exit(main())
