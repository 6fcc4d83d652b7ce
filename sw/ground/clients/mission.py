#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""mission: the ground station. Stock ZeroC Ice, and the xbee-at transport plugin.

Sets the vision core's threshold, starts it on the camera's frame, fetches the corners, draws them
over the picture, and serves Station, which the UAV calls. All of it over the radio.
"""

import argparse
import contextlib
import glob
import importlib.util
import itertools
import json
import mmap
import os
import struct
import subprocess
import sys
import threading
import time

import Ice

import plugged
from PIL import Image, ImageDraw


class Air:
    """The simulator's counters (sw/ground/sim_status.h); real hardware has none."""

    FORMAT = struct.Struct("<8s7Q")

    def __init__(self, path):
        self.map = None
        if path:
            with open(path, "rb") as f:
                self.map = mmap.mmap(f.fileno(), self.FORMAT.size, access=mmap.ACCESS_READ)

    def read(self):
        if not self.map:
            return None
        fields = self.FORMAT.unpack(self.map[: self.FORMAT.size])
        names = ("ns", "cycles", "up", "down", "packets", "lost", "wall")
        return dict(zip(names, fields[1:]))


# corners: a core that takes a pixel at the threshold for a brighter one passed with 121, and failed with 313
ENOUGH = 300
IP = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../ip")
RESULTS = ("after.png", "report.md", "report.json", "calls.jsonl")


@contextlib.contextmanager
def whole(path):
    """Returns a temporary name for a file that takes the name `path` when it is complete."""
    beside = path + ".new"
    try:
        yield beside
        os.replace(beside, path)
    finally:
        with contextlib.suppress(FileNotFoundError):
            os.remove(beside)


class Log:
    """Writes a line a call for people, and rows for the report."""

    def __init__(self, air, out, build):
        self.air, self.out, self.build = air, out, build  # folders: of the results, of the build
        self.rows = []
        followers = glob.glob(os.path.join(glob.escape(out), "after[0-9]*.png"))
        # Those of the mission before; a link is removed, and what it leads to stays.
        for path in [*(os.path.join(out, name) for name in RESULTS), *followers]:
            with contextlib.suppress(FileNotFoundError):
                os.remove(path)
        self.live = open(os.path.join(out, "calls.jsonl"), "x")  # the page of `make run` follows it
        self.lock = threading.Lock()
        self.start = time.monotonic()

    def say(self, text):
        with self.lock:
            print("%7.3f s  %s" % (time.monotonic() - self.start, text), flush=True)

    def follow(self, row):
        with self.lock:
            self.live.write(json.dumps(dict(row, at=round(time.monotonic() - self.start, 3),
                                            ns=(self.air.read() or {}).get("ns"))) + "\n")
            self.live.flush()

    def note(self, text):
        """Prints a line that is no call, on the terminal and on the page."""
        self.say(text)
        self.follow({"who": "ground", "what": text})

    def remind(self, what, answered):
        seconds = 0
        while not answered.wait(15):
            seconds += 15
            self.say("no answer to %s for %d s" % (what, seconds))

    def call(self, who, what, function):
        """Runs the call and returns its result; records the bytes on the air."""
        before, wall = self.air.read(), time.monotonic()
        answered = threading.Event()
        threading.Thread(target=self.remind, args=(what, answered), daemon=True).start()
        try:
            result = function()
            outcome = ""
        except Ice.Exception as e:
            outcome = " failed: " + type(e).__name__
            raise
        finally:
            answered.set()
            ms = (time.monotonic() - wall) * 1000
            after = self.air.read()
            row = {"who": who, "what": what + outcome, "wall_ms": round(ms, 1)}
            text = "%-16s %-48s %7.1f ms" % (who, what + outcome, ms)
            if before:
                row["simulated_ms"] = round((after["ns"] - before["ns"]) / 1e6, 1)
                row["bytes_up"] = after["up"] - before["up"]
                row["bytes_down"] = after["down"] - before["down"]
                text += " wall, %7.1f ms simulated, %4d bytes up, %4d down" % (
                    row["simulated_ms"], row["bytes_up"], row["bytes_down"])
            self.rows.append(row)
            self.follow(row)
            self.say(text)
        return result


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("flight",
                        help="flight.json: threshold, key, cores, folder of the results (./icesoc "
                             "run writes it)")
    parser.add_argument("--device", required=True, help="serial port of the modem")
    parser.add_argument("--plugin", required=True, help="folder of libxbeeat.so.37")
    parser.add_argument("--slice", required=True, help="Autopilot.ice")
    parser.add_argument("--frame", required=True, help="the camera's frame, to draw on")
    parser.add_argument("--status", help="the simulator's counters")
    parser.add_argument("--observer-device", help="the same of a second ground, which looks at all "
                        "vehicles meanwhile")
    parser.add_argument("--reference", help="program that computes the corners on the host")
    parser.add_argument("--trace", type=int, default=1, help="XBeeAT.Trace: 0, 1 or 2")
    args = parser.parse_args()
    try:
        with open(args.flight) as file:
            flight = json.load(file)
        for name in ("threshold", "loss", "guard", "patience", "key", "camera", "out", "wire",
                     "vehicles", "observer"):
            setattr(args, name, flight[name])
        args.endpoint = "%s -d %s -a 0x0001 -s 0x0000" % (
            "serial" if args.wire else "xbee-at", args.device)
    except (OSError, ValueError, KeyError) as error:
        sys.exit("mission: '%s' describes no flight: %r" % (args.flight, error))
    args.cores = [os.path.join(IP, core) for core in flight["cores"]]
    return args


def initialize(args):
    return plugged.initialize({
        "XBeeAT.Trace": str(args.trace),
        "Ice.ThreadPool.Client.Size": "2",
        "Ice.ThreadPool.Server.Size": "2",
        "Ice.Default.InvocationTimeout": str(1000 * args.patience),
        "Ice.ACM.Close": "0",
        "Station.Endpoints": args.endpoint,
        # of two devices in one process: where a proxy of the UAV leads
        **({"XBeeAT.Device": args.device} if args.observer_device else {}),
    }, args.plugin, args.guard, args.key)


def make_station(Autopilot, log):
    class StationI(Autopilot.Station):
        def __init__(self):
            self.called = threading.Event()
            self.alive = None
            self.params = {}

        def vehicleState(self, uav, params, current):
            for p in params:
                self.params[str(p.id)] = int.from_bytes(p.data, "little")
            what = "Station.vehicleState(%s)" % ", ".join("%s %d" % i for i in self.params.items())
            log.say("%-16s %s" % ("UAV -> ground", what))
            log.follow({"who": "UAV -> ground", "what": what})
            try:
                self.alive = log.call("ground -> UAV", "uav.isAlive(7)", lambda: uav.isAlive(7))
            finally:
                self.called.set()

    return StationI()


def draw(frame, result, path):
    """Returns the frame at twice its size with a circle a corner, larger for stronger corners."""
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
    with whole(path) as beside:
        picture.save(beside, format="PNG")


def check_against_reference(args, result):
    """Returns the same corners, computed by a C++ program from the same frame."""
    out = subprocess.run([args.reference, args.frame, str(args.threshold)],
                         check=True, stdout=subprocess.PIPE).stdout
    want = json.loads(out)
    best = [[f.x, f.y, f.score] for f in result.best]
    if [result.found, best] == [want["found"], want["best"]]:
        return
    text = "the vision core's result differs from the C++ reference: %d corners, not %d" % (result.found, want["found"])
    for number, (here, there) in enumerate(itertools.zip_longest(best, want["best"]), 1):
        if here != there:
            text += "; the first that differs, by their scores, is number %d: [x, y, score] %s, not %s" % (number, here, there)
            break
    raise RuntimeError(text)


class Follower(threading.Thread):
    """Calls the vision core of one more vehicle, while others are called."""

    def __init__(self, args, communicator, log, address):
        super().__init__(daemon=True)
        self.args = argparse.Namespace(**vars(args))
        self.args.frame = os.path.join(args.out, "before%d.png" % address)
        self.log, self.address, self.failure = log, address, None
        where = "%s -t %d" % (args.endpoint.replace("0x0001", "0x%04x" % address),
                              1000 * args.patience // 2)
        self.engine = communicator.stringToProxy("hwengine1:" + where)
        self.start()

    def run(self):
        try:
            self.fly()
        except (Ice.Exception, RuntimeError, OSError, subprocess.CalledProcessError) as failure:
            self.failure = failure

    def fly(self):
        import Autopilot
        engine = Autopilot.HwProcessingEnginePrx.uncheckedCast(self.engine)
        name = "uav%d.hwengine1" % self.address
        for what, call in (("setParameterA(%d)" % self.args.threshold,
                            lambda: engine.setParameterA(self.args.threshold)),
                           ("startProcessing()", engine.startProcessing),
                           ("getResult()", engine.getResult)):
            result = self.log.call("ground -> UAV", "%s.%s" % (name, what), call)
        if self.args.reference:
            check_against_reference(self.args, result)
        draw(self.args.frame, result, os.path.join(self.args.out, "after%d.png" % self.address))
        self.log.note("%s: %d corners" % (name, result.found))

    def land(self):
        self.join()
        if self.failure:
            raise self.failure


class Observer(Follower):
    """A second ground with a modem and keys of its own: asks each vehicle for its state, but those
    two that have each other in its place."""

    def __init__(self, args, log):
        os.environ["XBEEAT_CLOCK"] = args.status + "2"  # its engine's clock
        self.communicator = plugged.initialize(
            {"XBeeAT.Trace": str(args.trace), "Ice.ACM.Close": "0",
             "XBeeAT.Device": args.observer_device}, args.plugin, args.guard, args.observer)
        super().__init__(args, self.communicator, log, 1)

    def fly(self):
        import Autopilot
        for address in range(1 if self.args.vehicles < 4 else 3, self.args.vehicles + 1):
            where = "xbee-at -d %s -a 0x%04x -s 0x00f0 -t %d" % (
                self.args.observer_device, address, 1000 * self.args.patience // 2)
            vehicle = Autopilot.VehiclePrx.uncheckedCast(
                self.communicator.stringToProxy("uav:" + where))
            what = "uav%d.getFlightState()" % address
            state = self.log.call("observer -> UAV", what, vehicle.getFlightState)
            self.log.note("the observer sees uav%d: %s" % (address, state))

    def land(self):
        self.join()
        self.communicator.destroy()
        super().land()


def report(args, log, result, station, air):
    lines = ["# Mission report", "",
             "Frame `%s`, threshold %d, loss on the air %s: %d corners, %d cycles in the core." % (
                 os.path.basename(args.frame), args.threshold, args.loss, result.found,
                 result.cycles), "",
             "| who | call | wall ms | simulated ms | bytes up | bytes down |",
             "|---|---|---|---|---|---|"]
    for r in log.rows:
        lines.append("| %s | %s | %s | %s | %s | %s |" % (
            r["who"], r["what"], r["wall_ms"], r.get("simulated_ms", ""), r.get("bytes_up", ""),
            r.get("bytes_down", "")))
    lines += ["", "| corner | x | y | score |", "|---|---|---|---|"]
    lines += ["| %d | %d | %d | %d |" % (i + 1, f.x, f.y, f.score)
              for i, f in enumerate(result.best)]
    with whole(os.path.join(args.out, "report.md")) as beside, open(beside, "w") as f:
        f.write("\n".join(lines) + "\n")
    totals = air.read() or {}
    with whole(os.path.join(args.out, "report.json")) as beside, open(beside, "w") as f:
        json.dump({"calls": log.rows, "found": result.found, "cycles": result.cycles,
                   "vehicle": station.params, "air": totals}, f, indent=2)


def part_of(folder):
    """Imports FOLDER/ground.py."""
    path = os.path.join(folder, "ground.py")
    if not os.path.exists(path):
        raise RuntimeError("the core in %s has no part in a mission: there is no ground.py" %
                           folder)
    spec = importlib.util.spec_from_file_location("ground_" + os.path.basename(folder), path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def differences(chip):
    """Lists the blocks whose registers differ between chip and firmware."""
    return ["%s: its registers have the hash 0x%08X in the chip, 0x%08X in the firmware"
            % (c.block, c.chip & 0xFFFFFFFF, c.firmware & 0xFFFFFFFF)
            for c in chip.contracts() if c.chip != c.firmware]


def explain(communicator, args, failure):
    """Says why the UAV has no such object: a core that differs from the firmware's contract is not
    served."""
    import Hw  # made by loadSlice
    text = "the UAV has no object '%s'" % failure.id.name
    with contextlib.suppress(Ice.Exception):  # a UAV without the object chip
        found = differences(Hw.ChipPrx.uncheckedCast(communicator.stringToProxy(
            "chip:" + args.endpoint)))
        if found:
            text += "; ".join(["",
                               *found]) + ": build both anew from one ip/cores.list, the firmware by make firmware, " \
                "the chip by make synth-edif (docs/utilisation.md)"
    return text


def fly(args, communicator):
    import Autopilot  # made by loadSlice
    parts = [part_of(folder) for folder in args.cores]
    air = Air(args.status)
    log = Log(air, args.out, os.path.dirname(os.path.abspath(args.plugin)))
    station = make_station(Autopilot, log)
    adapter = communicator.createObjectAdapter("Station")
    adapter.add(station, communicator.stringToIdentity("station"))
    adapter.activate()
    begun = "calling over the wire at" if args.wire else "setting the ground's modem up on"
    log.say("%s %s; the UAV has %d s to answer" % (begun, args.device, args.patience))

    where = "%s -t %d" % (args.endpoint, 1000 * args.patience // 2)  # Ice tries twice
    base = communicator.stringToProxy("hwengine1:" + where)
    engine = log.call("ground -> UAV", "checkedCast(hwengine1)",
                      lambda: Autopilot.HwProcessingEnginePrx.checkedCast(base))
    # As in the paper's Figure 5: -o is a oneway proxy.
    oneway = Autopilot.HwProcessingEnginePrx.uncheckedCast(
        communicator.stringToProxy("hwengine1 -o:" + where))

    def proxy(identity, vehicle=1):
        return communicator.stringToProxy(
            identity + ":" + where.replace("0x0001", "0x%04x" % vehicle))

    if args.camera:
        size = Image.open(args.frame).size
        for part in parts:
            if hasattr(part, "prepare"):
                part.prepare(log, proxy, *size)

    if args.vehicles > 3:  # the first one asks the second for its state, and reports that
        fellow = Autopilot.VehiclePrx.uncheckedCast(proxy("uav", 2))
        log.call("ground -> UAV", "uav2.setFlightState(flying)",
                 lambda: fellow.setFlightState(Autopilot.FlightState.flying))
    log.call("ground -> UAV", "hwengine1.setParameterA(%d), oneway" % args.threshold,
             lambda: oneway.setParameterA(args.threshold))
    log.call("ground -> UAV", "hwengine1.startProcessing(), oneway", oneway.startProcessing)
    result = log.call("ground -> UAV", "hwengine1.getResult()", engine.getResult)
    log.say("%d corners; the core took %d cycles" % (result.found, result.cycles))
    log.follow({"features": [[f.x, f.y, f.score] for f in result.best], "found": result.found})

    followers = [Follower(args, communicator, log, address)
               for address in range(2, args.vehicles + 1)]
    if args.observer_device:
        followers.append(Observer(args, log))
    if not station.called.wait(args.patience):
        raise RuntimeError("the UAV did not call Station.vehicleState within %d s" % args.patience)
    if not station.alive:
        raise RuntimeError("uav.isAlive answered %r" % station.alive)
    if args.reference:
        try:
            check_against_reference(args, result)
        except RuntimeError as e:
            log.follow({"who": "ground", "what": "the mission failed: %s" % e})
            raise
        log.note("the result equals the C++ reference, bit by bit")
        if result.found < ENOUGH:
            log.note("%d corners leave much of the core untried: make ip-test IP=vision tries all "
                     "of it" % result.found)
    # A part may return a function to be called after all parts.
    ends = [part.fly(log, proxy, "%d corners" % result.found) for part in parts]
    for end in filter(None, ends):
        end()
    draw(args.frame, result, os.path.join(args.out, "after.png"))
    for follower in followers:
        follower.land()
    report(args, log, result, station, air)


def main():
    args = parse_arguments()
    communicator = initialize(args)
    try:
        registers = os.path.join(os.path.dirname(os.path.abspath(__file__)),
                                 "../../hw/registers/Registers.ice")
        for file in [args.slice, registers, *(file for core in args.cores
                                              for file in glob.glob(os.path.join(core, "*.ice")))]:
            Ice.loadSlice("", ["-I" + (Ice.getSliceDir() or "."), file])
        fly(args, communicator)
        return 0
    except KeyboardInterrupt:
        return 130
    except Ice.ObjectNotExistException as e:
        sys.exit("mission: " + explain(communicator, args, e))
    except Ice.TimeoutException:
        sys.exit("mission: no answer for %d s: is the UAV on, in reach, and has it the same key?" %
                 args.patience)
    except (Ice.Exception, RuntimeError, OSError, subprocess.CalledProcessError) as e:
        sys.exit("mission: %s" % e)
    finally:
        communicator.destroy()


if __name__ == "__main__":
    sys.exit(main())
