#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""fleet_ground: calls the vision cores of several vehicles repeatedly, and asks for the vehicles'
states from a second ground station, until a given simulated time. Then each vehicle has to answer
once more. At the beginning, one call to all vehicles starts the first frame of each.

    fleet_ground.py '{"out": FOLDER, ...}'      words_of() writes all options

For each vehicle, FOLDER/fleet.json contains the numbers of frames that were started, answered and
reported. It also contains the times at which the second ground station received a state, each with
the vehicle's address. If "changed" is the address of a vehicle, the key file also contains the next
key of this vehicle, "new_key"; at the end, the vehicle must accept this key only. If "rival" is not
0, it is the time at which the second ground station starts, and this station has the address and
the key of the first one."""

import json
import os
import subprocess
import sys
import threading
import time
from pathlib import Path
from types import SimpleNamespace

import Ice

import mission
import plugged

THRESHOLD = 40
REST = 0.2  # simulated time between two frames, s


# Faults of a fleet: name, option of the simulator ("" if a program causes the fault), and shortest
# and longest duration in s. Vehicle 1 runs the host build of the firmware, the others run the ARM
# binary.
TROUBLE = {"vehicle away": ("away:2", 0.5, 3), "vehicle gone": ("away:3", 11, 13),
           "twin": ("twin:2", 1, 3), "babbler": ("babble:1", 1, 3),
           "other ground": ("away:0", 2, 4), "new key": ("away:2", 11, 13),
           "rival ground": ("", 20, 22)}
VEHICLES, NEXT = 3, "7" * 32


def words_of(m, image, name, begin, end):
    """Returns the command that starts the simulator with several vehicles. The vehicles
    are called continuously, and each has its own key."""
    keys, isRival = {}, name == "rival ground"
    for file, digits in (("fleet", "123"), ("observer", "456")):
        lines = [f"0x{at:04x} {digit * 32}" for at, digit in enumerate(digits, 1)]
        if (name, file) == ("new key", "fleet"):
            lines[1] += " " + NEXT
        keys[file] = f"{m.out}.{file}.key"
        with open(os.open(keys[file], os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600), "w") as f:
            f.write("\n".join([*lines, f"0xffff {'9' * 32}"]))
    flight = {"image": image, "size": "48x32", "out": m.out, "speed": "max", "key": keys["fleet"],
              "observer": keys["observer"], "guard": 20, "vehicles": VEHICLES}
    if TROUBLE[name][0]:
        flight["trouble"] = f"{TROUBLE[name][0]}:{begin:.3f}:{end - begin:.3f}"
    calls = {"device": "{device}", "device2": "{device2}", "status": "{status}", "out": "{out}",
             "plugin": m.build + "/ground", "slice": m.source + "/sw/vehicle/Autopilot.ice",
             "reference": m.build + "/testbench/sim/vision-reference", "key": keys["fleet"],
             "key2": keys["fleet" if isRival else "observer"], "until": end + 1,
             "rival": begin if isRival else 0, "changed": 2 if name == "new key" else 0,
             "new_key": NEXT, "guard": 20, "vehicles": VEHICLES}
    options = [str(word) for option, value in flight.items() for word in ("--" + option, value)]
    return [m.build + "/testbench/sim/icesoc-sim", *options, "--", "/usr/bin/python3",
            __file__, json.dumps(calls)]


class Caller(threading.Thread):
    """Calls one vehicle. A call is made only once, even if it fails."""

    def __init__(self, ground, address):
        super().__init__(daemon=True)
        self.ground, self.address = ground, address
        self.started, self.answered, self.wrong = 1, 0, 0  # `started` begins with 1: the call to
                                                           # all vehicles started one frame
        self.reported, self.failure = [], None
        args = ground.args
        picture = f"{args.out}/before{address if address > 1 else ''}.png"
        self.want = json.loads(subprocess.check_output([args.reference, picture, str(THRESHOLD)]))
        self.start()

    def frame(self, engine):
        engine.setParameterA(THRESHOLD)
        self.started += 1
        engine.startProcessing()
        self.answered += 1
        self.take(engine)

    def take(self, engine):
        result = engine.getResult()
        best = [[f.x, f.y, f.score] for f in result.best]
        self.wrong += [result.found, best] != [self.want["found"], self.want["best"]]

    def frames(self):
        """Makes calls until the end of the flight, and then until another reply arrives, for at
        most 20 seconds."""
        engine = Autopilot.HwProcessingEnginePrx.uncheckedCast(
            self.ground.proxy("hwengine1", self.address))
        self.take(engine)
        while True:
            due = self.ground.seconds() + REST
            late = due - self.ground.args.until
            try:
                self.frame(engine)
                if late >= 0:
                    return
            except Ice.Exception as e:
                self.reported.append(e.ice_id())
                if late > 20:
                    raise
            while self.ground.seconds() < due:
                time.sleep(0.005)

    def run(self):
        ground = self.ground
        try:
            ring = Autopilot.KeyRingPrx.uncheckedCast(ground.proxy("keys", self.address))
            isChanged = self.address == ground.args.changed
            if isChanged and not ring.setNextKey(bytes.fromhex(ground.args.new_key)):
                raise RuntimeError("the vehicle refuses a new key")
            self.frames()
        except (Ice.Exception, RuntimeError) as failure:
            self.failure = failure

    def result(self):
        return {"started": self.started, "answered": self.answered, "reported": self.reported,
                "wrong": self.wrong}


class Ground:
    def __init__(self, args):
        self.args, self.air = args, mission.Air(args.status)
        self.pilot = self.communicator(args.device, args.key)
        # states that the second ground station received: (address, simulated seconds)
        self.seen = []

    def seconds(self):
        return self.air.read()["ns"] / 1e9

    def communicator(self, device, key):
        return plugged.initialize(
            {"Ice.Default.InvocationTimeout": "120000", "Ice.RetryIntervals": "-1",
             "Ice.ACM.Close": "0", "XBeeAT.Device": device, "XBeeAT.Trace": "1"},
            self.args.plugin, self.args.guard, key)

    def proxy(self, name, address, ic=None):
        return (ic or self.pilot).stringToProxy(
            f"{name}:xbee-at -d {self.args.device} -a 0x{address:04x} -t 120000")

    def observe(self):
        """Asks the vehicles for their states, one after the other, from the second ground
        station."""
        plugged.use_second_clock()
        observer = self.communicator(self.args.device2, self.args.key2)
        source = 0x0000 if self.args.rival else 0x00f0
        while self.seconds() < self.args.rival:
            time.sleep(0.01)
        while self.seconds() < self.args.until:
            for address in range(1, self.args.vehicles + 1):
                vehicle = Autopilot.VehiclePrx.uncheckedCast(observer.stringToProxy(
                    f"uav:xbee-at -d {self.args.device2} -a 0x{address:04x} -s {source} "
                    "-t 120000"))
                try:
                    vehicle.getFlightState()
                    self.seen.append((address, self.seconds()))
                except Ice.Exception:
                    time.sleep(0.01)
        observer.destroy()

    def call_all(self):
        """Starts a frame in each vehicle with one call, once all vehicles have sessions. Destroying
        the communicator waits until the call has been sent."""
        for address in range(1, self.args.vehicles + 1):
            self.proxy("uav", address).ice_ping()
        ic = self.communicator(self.args.device, self.args.key)
        engines = Autopilot.HwProcessingEnginePrx.uncheckedCast(
            self.proxy("hwengine1 -o", 0xFFFF, ic))
        engines.setParameterA(THRESHOLD)
        engines.startProcessing()
        ic.destroy()

    def keep_new_key(self):
        """Calls the vehicle `changed` with its new key, as change_key.py does; after that, the
        vehicle accepts only this key. Returns the error, or None."""
        lines = Path(self.args.key).read_text().split("\n")
        lines[self.args.changed - 1] = f"0x{self.args.changed:04x} {self.args.new_key}"
        Path(self.args.key).write_text("\n".join(lines))
        ic = self.communicator(self.args.device, self.args.key)
        try:
            ring = Autopilot.KeyRingPrx.uncheckedCast(self.proxy("keys", self.args.changed, ic))
            return None if ring.count() == 1 else "the vehicle still has its old key"
        except Ice.Exception as failure:
            return failure
        finally:
            ic.destroy()

    def fly(self):
        self.call_all()
        callers = [Caller(self, address) for address in range(1, self.args.vehicles + 1)]
        while not any(caller.answered for caller in callers) and any(
                caller.is_alive() for caller in callers):
            time.sleep(0.01)
        self.observe()
        for caller in callers:
            caller.join()
        self.pilot.destroy()
        if self.args.changed and not callers[self.args.changed - 1].failure:
            callers[self.args.changed - 1].failure = self.keep_new_key()
        results = {caller.address: caller.result() for caller in callers}
        Path(self.args.out, "fleet.json").write_text(json.dumps({**results, "seen": self.seen}))
        failed = [f"vehicle {c.address}: {c.failure}" for c in callers if c.failure]
        if failed:
            sys.exit("fleet_ground: " + "; ".join(failed))


def main():
    global Autopilot
    args = SimpleNamespace(**json.loads(sys.argv[1]))
    Ice.loadSlice("", ["-I" + (Ice.getSliceDir() or "."), args.slice])
    import Autopilot
    Ground(args).fly()


if __name__ == "__main__":
    main()
