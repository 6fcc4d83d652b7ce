#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""call: calls the meter of a porting example with stock ZeroC Ice, and receives the meter's report.

Usage: call.py KERNEL ENDPOINT [STATION-ENDPOINT] [Ice options]

KERNEL is the name that the meter must report. With a STATION-ENDPOINT, this program also serves an
object Station at this endpoint, and waits until the meter calls it.
"""
import os
import sys
import threading

import Ice

HERE = os.path.dirname(os.path.abspath(__file__))
for name in "Meter", "Station":
    Ice.loadSlice("", [os.path.join(HERE, f"{name}.ice")])
import Demo  # noqa: E402

CALLS = 20
SECONDS = 30


class StationI(Demo.Station):
    """Stores the name of the kernel that the meter reports."""

    def __init__(self):
        self.reported = threading.Event()
        self.kernel = None

    def report(self, kernel, calls, current):
        self.kernel = kernel
        self.reported.set()


def expect(what, expected, got):
    if expected != got:
        sys.exit(f"{what}: expected {expected}, got {got}")
    print(f"{what}: {got}", flush=True)


def main():
    with Ice.initialize(sys.argv) as communicator:
        kernel, endpoint, *station = sys.argv[1:]
        servant = StationI()
        if station:
            adapter = communicator.createObjectAdapterWithEndpoints("Station", station[0])
            adapter.add(servant, Ice.stringToIdentity("station"))
            adapter.activate()
        prx = communicator.stringToProxy(f"meter:{endpoint}").ice_invocationTimeout(SECONDS * 1000)
        meter = Demo.MeterPrx.checkedCast(prx)
        expect("kernel", kernel, meter.kernel())
        expect("sum of 20 calls", sum(range(CALLS)) + CALLS,
               sum(meter.add(number, 1) for number in range(CALLS)))
        if station:
            expect("report arrived", True, servant.reported.wait(SECONDS))
            expect("kernel of the report", kernel, servant.kernel)


main()
