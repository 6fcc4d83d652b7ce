#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""mission: the ground station of the simulated mission. It uses unmodified ZeroC Ice and the
xbee-at transport plugin.

Sets the vision core's threshold, starts the core on the camera's frame, fetches the corners, draws
the corners over the picture, and serves Station, which the UAV calls. All calls use the radio.
"""

import argparse
import concurrent.futures
import contextlib
import glob
import importlib.util
import itertools
import json
import os
import subprocess
import sys
import threading

import Ice

import places
import plugged
import stay
from mission_log import Air, Log, Patience, report, whole
from PIL import Image, ImageDraw
from reasons import reason_of

# Smallest number of corners of a useful test frame. A faulty core that treats a pixel at the
# threshold as brighter passes with a frame of 121 corners, and fails with a frame of 313 corners.
ENOUGH = 300


def parse_arguments():
    parser = argparse.ArgumentParser(
        description=__doc__.split("\n\n")[0],
        formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog="examples:\n"
               "  %(prog)s flight.json --device /dev/ttyUSB0 --frame photo.png\n"
               "  %(prog)s flight.json --device /dev/pts/3 --frame photo.png --status status\n"
               "  %(prog)s flight.json --device /dev/ttyUSB0 --frame photo.png --trace 2")
    parser.add_argument("flight",
                        help="flight.json, the description of the flight, which ./icesoc run "
                             "writes: threshold, key, cores, output folder")
    parser.add_argument("--device", required=True, help="serial port of the modem")
    parser.add_argument("--plugin", default=places.plugin(),
                        help="folder of libxbeeat.so.37 (default: as built or installed)")
    parser.add_argument("--slice", default=places.slice_file("Autopilot.ice"),
                        help="path of Autopilot.ice (default: as installed)")
    parser.add_argument("--frame", required=True, help="picture of the camera; found corners are "
                        "drawn into a copy")
    parser.add_argument("--status", help="file with the counters of a simulator")
    parser.add_argument("--observer-device", help="serial port of a second ground station, which "
                        "watches all vehicles during the mission")
    parser.add_argument("--reference", help="program that computes the expected corners")
    parser.add_argument("--trace", type=int, default=1,
                        help="messages of the plugin: 0 errors, 1 link and connections, 2 AT "
                        "commands (default 1)")
    args = parser.parse_args()
    try:
        with open(args.flight) as file:
            flight = json.load(file)
        for name in ("threshold", "loss", "guard", "patience", "key", "camera", "out", "wire",
                     "vehicles", "observer", "live"):
            setattr(args, name, flight[name])
        args.endpoint = "%s -d %s -a 0x0001 -s 0x0000" % (
            "serial" if args.wire else "xbee-at", plugged.quoted(args.device))
    except KeyError as error:
        sys.exit("mission: '%s': expected a flight (./icesoc run writes it); the member %s is "
                 "missing" % (args.flight, error))
    except (OSError, ValueError, TypeError) as error:
        sys.exit("mission: '%s': expected a flight (./icesoc run writes it): "
                 "%s" % (args.flight, reason_of(error)))
    args.cores = [places.core(core) for core in flight["cores"]]
    return args


def initialize(args):
    return plugged.initialize({
        "XBeeAT.Trace": str(args.trace),
        "Ice.ThreadPool.Client.Size": "2",
        "Ice.ThreadPool.Server.Size": "2",
        # no time-out by Ice, because mission_log.Patience counts simulated time
        "Ice.Default.InvocationTimeout": "-1",
        "Ice.ACM.Close": "0",
        "Station.Endpoints": args.endpoint,
        # A proxy that the UAV sends contains no device. If this process has two devices, such a
        # proxy uses this one.
        **({"XBeeAT.Device": args.device} if args.observer_device else {}),
    }, args.plugin, args.guard, args.key)


def make_station(Autopilot, log, timeout):
    class StationI(Autopilot.Station):
        def __init__(self):
            self.called = threading.Event()
            self.alive = None
            self.error = None  # exception of the call to the vehicle
            self.params = {}

        def vehicleState(self, uav, params, current):
            for p in params:
                self.params[str(p.id)] = int.from_bytes(p.data, "little")
            what = "Station.vehicleState(%s)" % ", ".join("%s %d" % i for i in self.params.items())
            log.say("%-16s %s" % ("UAV -> ground", what))
            log.follow({"who": "UAV -> ground", "what": what})
            uav = uav.ice_timeout(timeout)
            try:
                self.alive = log.call("ground -> UAV", "uav.isAlive(7)", lambda: uav.isAlive(7))
            except Ice.Exception as e:
                self.error = e  # Mission.hear raises it in the main thread
            finally:
                self.called.set()

    return StationI()


def draw(frame, result, path):
    """Returns the frame at twice its size, with a circle around each corner; a stronger corner has
    a larger circle."""
    scale = 2
    picture = Image.open(frame).convert("RGB")
    picture = picture.resize((picture.width * scale, picture.height * scale), Image.NEAREST)
    pen = ImageDraw.Draw(picture)
    strongest = result.best[0].score if result.best else 1
    for f in result.best:
        x, y = f.x * scale + scale // 2, f.y * scale + scale // 2
        r = 4 + 8 * f.score // max(strongest, 1)
        pen.ellipse((x - r, y - r, x + r, y + r), outline=(255, 80, 0), width=2)
        pen.point((x, y), fill=(0, 255, 80))
    with whole(path) as temporary:
        picture.save(temporary, format="PNG")


def check_against_reference(args, frame, result):
    """Compares the result with the corners that a C++ program computes from the same frame."""
    out = subprocess.run([args.reference, frame, str(args.threshold)],
                         check=True, stdout=subprocess.PIPE).stdout
    want = json.loads(out)
    best = [[f.x, f.y, f.score] for f in result.best]
    if [result.found, best] == [want["found"], want["best"]]:
        return
    text = ("the vision core's result differs from the C++ reference: "
            f"{result.found} corners, expected {want['found']}")
    for number, (here, there) in enumerate(itertools.zip_longest(best, want["best"]), 1):
        if here != there:
            text += (f"; the first difference, in the order of scores, is number {number}: [x, y, "
                     f"score] is {here}, expected {there}")
            break
    raise RuntimeError(text)


def begin(function, *args):
    """Calls a function in a thread. Returns a future for its result."""
    future = concurrent.futures.Future()

    def run():
        try:
            future.set_result(function(*args))
        except Exception as failure:
            future.set_exception(failure)

    threading.Thread(target=run, daemon=True).start()
    return future


def part_of(folder):
    """Imports FOLDER/ground.py and returns the module."""
    path = os.path.join(folder, "ground.py")
    if not os.path.exists(path):
        raise RuntimeError("the core in %s cannot be called in a mission: expected a file "
                           "ground.py in this folder" % folder)
    spec = importlib.util.spec_from_file_location("ground_" + os.path.basename(folder), path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def differences(chip):
    """Returns a line of text for each block with different registers in the chip and the
    firmware."""
    return ["%s: expected registers with hash 0x%08X, as the firmware was built for, "
            "got 0x%08X in the chip"
            % (c.block, c.firmware & 0xFFFFFFFF, c.chip & 0xFFFFFFFF)
            for c in chip.contracts() if c.chip != c.firmware]


def explain(communicator, args, failure):
    """Returns the reason why the UAV does not have an object. Usually the registers of the core
    differ from those for which the firmware was built, so the firmware does not serve the core."""
    import Hw  # generated by loadSlice
    text = "the UAV has no object '%s'" % failure.id.name
    with contextlib.suppress(Ice.Exception):  # the UAV may have no object "chip"
        found = differences(Hw.ChipPrx.uncheckedCast(communicator.stringToProxy(
            "chip:" + args.endpoint)))
        if found:
            text += "; ".join(["", *found]) + (
                ": rebuild both from the same ip/cores.list, the firmware with ./icesoc build "
                "firmware, the chip with ./icesoc synth edif (docs/utilisation.md)")
    return text


class Mission:
    """Makes the calls of a mission, step by step. A step calls vehicle 1 unless its comment names
    another vehicle."""

    def __init__(self, args, communicator):
        import Autopilot  # generated by loadSlice
        self.args, self.communicator, self.autopilot = args, communicator, Autopilot
        self.parts = [part_of(folder) for folder in args.cores]
        self.air = Air(args.status)
        self.log = Log(self.air, args.out, os.path.dirname(os.path.abspath(args.plugin)))
        self.communicators = [communicator]
        self.log.patience, self.log.give_up = args.patience, self.give_up
        # time-out of connections, ms; practically unlimited, because Ice measures real time
        self.timeout = 0x7FFFFFFF
        self.station = make_station(Autopilot, self.log, self.timeout)

    def give_up(self):
        """Ends the mission: all calls in progress fail with an exception."""
        for communicator in self.communicators:
            communicator.destroy()

    def proxy(self, identity, vehicle=1):
        endpoint = self.args.endpoint.replace("0x0001", f"0x{vehicle:04x}")
        return self.communicator.stringToProxy(f"{identity}:{endpoint} -t {self.timeout}")

    def call(self, what, function):
        return self.log.call("ground -> UAV", what, function)

    def serve(self):
        adapter = self.communicator.createObjectAdapter("Station")
        adapter.add(self.station, self.communicator.stringToIdentity("station"))
        adapter.activate()
        begun = "calling over the wire at" if self.args.wire else "setting the ground's modem up on"
        self.log.say(f"{begun} {self.args.device}; the UAV has {self.args.patience} s to answer")

    def prepare(self):
        """Sends the size of the frame to the cores. With four or more vehicles, also gives the
        first vehicle the address of the second one, asks the first vehicle for the second one's
        state, and reports the answer."""
        if self.args.camera:
            size = Image.open(self.args.frame).size
            for part in self.parts:
                if hasattr(part, "prepare"):
                    part.prepare(self.log, self.proxy, *size)
        if self.args.vehicles > 3:
            fellow = self.autopilot.VehiclePrx.uncheckedCast(self.proxy("uav", 2))
            self.call("uav2.setFlightState(flying)",
                      lambda: fellow.setFlightState(self.autopilot.FlightState.flying))

    def find_corners(self):
        """Returns the corners that the vision core finds, using the calls of the paper's Figure
        5."""
        prx, threshold = self.autopilot.HwProcessingEnginePrx, self.args.threshold
        engine = self.call("checkedCast(hwengine1)",
                           lambda: prx.checkedCast(self.proxy("hwengine1")))
        oneway = prx.uncheckedCast(self.proxy("hwengine1 -o"))
        self.prepare()
        self.call(f"hwengine1.setParameterA({threshold}), oneway",
                  lambda: oneway.setParameterA(threshold))
        self.call("hwengine1.startProcessing(), oneway", oneway.startProcessing)
        result = self.call("hwengine1.getResult()", engine.getResult)
        self.log.say(f"{result.found} corners; the core took {result.cycles} cycles")
        self.log.follow({"features": [[f.x, f.y, f.score] for f in result.best],
                         "found": result.found})
        return result

    def call_others(self):
        """Starts the calls to the other vehicles, and the calls of the second ground station to all
        vehicles."""
        others = [begin(self.call_vehicle, address)
                  for address in range(2, self.args.vehicles + 1)]
        if self.args.observer_device:
            others.append(begin(self.observe))
        return others

    def call_vehicle(self, address):
        """Calls the vision core of another vehicle. This function runs for all other vehicles at
        the same time."""
        frame = os.path.join(self.args.out, f"before{address}.png")
        engine = self.autopilot.HwProcessingEnginePrx.uncheckedCast(
            self.proxy("hwengine1", address))
        name, threshold = f"uav{address}.hwengine1", self.args.threshold
        self.call(f"{name}.setParameterA({threshold})", lambda: engine.setParameterA(threshold))
        self.call(f"{name}.startProcessing()", engine.startProcessing)
        result = self.call(f"{name}.getResult()", engine.getResult)
        if self.args.reference:
            check_against_reference(self.args, frame, result)
        draw(frame, result, os.path.join(self.args.out, f"after{address}.png"))
        self.log.note(f"{name}: {result.found} corners")

    def observe(self):
        """Acts as a second ground station with a separate modem and separate keys. Asks each
        vehicle for its state."""
        args, device = self.args, self.args.observer_device
        plugged.use_second_clock()
        with plugged.initialize({"XBeeAT.Trace": str(args.trace), "Ice.ACM.Close": "0",
                                 "XBeeAT.Device": device},
                                args.plugin, args.guard, args.observer) as communicator:
            self.communicators.append(communicator)
            for address in range(1, args.vehicles + 1):
                vehicle = self.autopilot.VehiclePrx.uncheckedCast(communicator.stringToProxy(
                    f"uav:xbee-at -d {plugged.quoted(device)} -a 0x{address:04x} -s 0x00f0 "
                    f"-t {self.timeout}"))
                state = self.log.call("observer -> UAV", f"uav{address}.getFlightState()",
                                      vehicle.getFlightState)
                self.log.note(f"the observer sees uav{address}: {state}")

    def hear(self):
        patience = Patience(self.air, self.args.patience)
        while not self.station.called.wait(0.1):
            if patience.is_over():
                raise RuntimeError("the UAV did not call Station.vehicleState within "
                                   f"{self.args.patience} s")
        if self.station.error:
            raise self.station.error
        if not self.station.alive:
            raise RuntimeError(f"uav.isAlive: expected True, got {self.station.alive!r}")

    def check(self, result):
        if not self.args.reference:
            return
        try:
            check_against_reference(self.args, self.args.frame, result)
        except RuntimeError as e:
            self.log.follow({"who": "ground", "what": f"the mission failed: {e}"})
            raise
        self.log.note("the result equals the C++ reference, bit by bit")
        if result.found < ENOUGH and not places.IS_INSTALLED:
            self.log.note(f"{result.found} corners test only a part of the core: ./icesoc core "
                          "test vision tests all of it")

    def fly(self):
        self.serve()
        result = self.find_corners()
        others = self.call_others()
        self.hear()
        self.check(result)
        # The function `fly` of a core's part may return a function, which is called after `fly` of
        # all parts.
        ends = [part.fly(self.log, self.proxy, f"{result.found} corners") for part in self.parts]
        for end in filter(None, ends):
            end()
        draw(self.args.frame, result, os.path.join(self.args.out, "after.png"))
        for other in others:
            other.result()
        report(self.args, self.log, result, self.station, self.air)


def fly(args):
    """Flies the mission; returns an exit status."""
    communicator = initialize(args)
    try:
        registers = places.slice_file("Registers.ice")
        for file in [args.slice, registers, *(file for core in args.cores
                                              for file in glob.glob(os.path.join(core, "*.ice")))]:
            Ice.loadSlice("", ["-I" + (Ice.getSliceDir() or "."), file])
        Mission(args, communicator).fly()
        return 0
    except KeyboardInterrupt:
        return 130
    except Ice.ObjectNotExistException as e:
        sys.exit("mission: " + explain(communicator, args, e))
    except (Ice.TimeoutException, Ice.CommunicatorDestroyedException):
        sys.exit("mission: no reply from the UAV for %d s: check that it is on, in range, and has "
                 "the same key" %
                 args.patience)
    except (Ice.Exception, RuntimeError, OSError, subprocess.CalledProcessError) as e:
        call = getattr(e, "call", "")
        sys.exit("mission: %s%s" % (call and call + ": ", reason_of(e)))
    finally:
        communicator.destroy()


def main():
    plugged.interrupt_once()
    args = parse_arguments()
    return fly(args) or (stay.serve(args) if stay.is_wanted(args) else 0)


if __name__ == "__main__":
    sys.exit(main())
