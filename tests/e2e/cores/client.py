#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""client: calls new cores in a UAV's FPGA by radio. Usage: client.py DEVICE GUARD STATUS PLUGIN
FOLDER GENERATED TRACE|NETLIST File.ice ..."""

import os
import sys
import threading
import types
import zlib

import Ice

import mission
from icesoc.cores import probe
from icesoc.util.errors import Stop

device, guard, status, plugin, folder, generated, chip, *files = sys.argv[1:]
clocked = ["my_requests"] if chip == "TRACE" else []
for file in files:
    Ice.loadSlice("", [file])
import Cores  # noqa: E402
import Demo  # noqa: E402
import Hw  # noqa: E402
import Probes  # noqa: E402


def expect(what, value, wanted):
    if value != wanted:
        sys.exit("%s: %r, expected %r" % (what, value, wanted))


def fails(kind, call, *arguments):
    try:
        call(*arguments)
    except kind as e:
        return e
    sys.exit("%s did not come" % kind.__name__)


class Watcher(Demo.Watcher):
    def __init__(self):
        self.peaks, self.finished_calls, self.came = [], 0, threading.Semaphore(0)

    def peak(self, largest, current=None):
        self.peaks.append((largest.index, largest.value))
        self.came.release()

    def finished(self, current=None):
        self.finished_calls += 1
        self.came.release()


data = Ice.InitializationData()
data.properties = Ice.createProperties()
data.properties.setProperty("Ice.Plugin.XBeeAT", plugin)
data.properties.setProperty("XBeeAT.Clock", status)
data.properties.setProperty("XBeeAT.Guard", guard)
data.properties.setProperty("Ground.Endpoints", "xbee-at -d %s" % device)
data.properties.setProperty("Ice.ACM.Close", "0")  # calls of a chip's netlist take minutes
with Ice.initialize(data) as ic:
    where = ":xbee-at -d %s -a 0x0001 -t 3000000" % device
    # A probe records the inputs and outputs of the first core; cores.sh compares the recording with
    # the simulator's trace.
    said = []
    signals = probe.Signals(os.path.join(generated, "chip.json"), "probe")
    prober = Probes.ProbePrx.checkedCast(ic.stringToProxy("probe" + where))
    settings = types.SimpleNamespace(trigger="u_sample_verilog.bus_valid_i=1", level=False,
                                     before=4, after=150, wait=600,
                                     out=os.path.join(folder, "probe.vcd"))
    recording = threading.Thread(target=probe.capture,
                                 args=(prober, signals, settings, said.append))
    recording.start()
    while not said and recording.is_alive():
        threading.Event().wait(0.01)
    core = Cores.SampleVerilogPrx.uncheckedCast(ic.stringToProxy("sample_verilog" + where))
    # the calls follow each other without pauses, because the trace covers only a few clocks
    while recording.is_alive():
        calls = [call for _ in range(3) for call in (core.setOffsetAsync(7), core.addAsync(42))]
        expect("add, recorded", [call.result() for call in calls], 3 * [None, 49])
    print(said)
    settings.trigger, settings.before, settings.after = "", 0, 0
    settings.out = os.path.join(folder, "second.vcd")
    probe.capture(prober, signals, settings, said.append)
    times = [[int(line[1:]) for line in open(os.path.join(folder, f)) if line[0] == "#"]
             for f in ("probe.vcd", "second.vcd")]
    expect("the second capture is another one", times[1][0] > times[0][-1], True)
    signals.names ^= 1
    failed = fails(Stop, signals.check, prober.getState())
    expect("another chip's names", "chip.json" in str(failed), True)
    for identity, prx in (("sample_verilog", Cores.SampleVerilogPrx),
                          ("newcomer", Cores.SampleVhdlPrx)):
        core = prx.checkedCast(ic.stringToProxy(identity + where))
        core.setOffset(-100)
        expect(identity + ".add", core.add(42), -58)
        expect(identity + ".sumTo", core.sumTo(100), 5050)
        fails(Ice.UnknownException, core.sumTo, 0)
        # While a long call is in progress, other calls are answered. The long call never ends by
        # itself, and is aborted after 100 ms.
        later = core.sumToAsync(2000000000)
        expect(identity + ".add meanwhile", core.add(1), -99)
        if later.done():
            sys.exit("the long call was over before the short one")
        fails(Ice.UnknownException, later.result)
        expect(identity + ".sumTo after that", core.sumTo(4), 10)

    servo = Demo.ServoPrx.checkedCast(ic.stringToProxy("servo" + where))
    servo.setPulse(2, 1500)
    for _ in range(2000):  # wait until the simulator's script raises the pin
        if servo.fault():
            break
    servo.clear()
    expect("servo.fault after clear", servo.fault(), False)

    crc = Cores.Crc32Prx.checkedCast(ic.stringToProxy("crc32" + where))
    for length in (0, 1, 8, 1000, 4096):
        packet = bytes(i * i * 7 + 31 * i & 0xFF for i in range(length))
        expect("crc32 of %d bytes" % length, crc.crc(packet) & 0xFFFFFFFF, zlib.crc32(packet))

    # Checks that the chip is the one for which the firmware was built. (In the test case
    # mission.other_chip, it is another chip.)
    vehicle = Hw.ChipPrx.checkedCast(ic.stringToProxy("chip" + where))
    contracts = vehicle.contracts()
    expect("blocks", sorted(c.block for c in contracts), sorted([
        "system", "modem", "sample_verilog", "scaler", "servo", "crc32", "port", *clocked,
        "my_lamps", "sample_vhdl", "many", "probe"]))
    expect("contracts", mission.differences(vehicle), [])

    # Third-party cores, which are called by their registers.
    port = Hw.RegistersPrx.checkedCast(ic.stringToProxy("port" + where))
    # the simulator's script raises the pin during this call
    expect("port.wait", port.wait(10000), ["CORE"])
    expect("port.LEVELS", port.get("LEVELS"), 0x83)
    expect("port.list", [
        (r.name, r.word, r.width) for r in port.list() if r.access == Hw.Access.rw and r.page == 0],
           [("LEVELS", 8, 8), ("DRIVEN", 9, 8)])
    port.set("DRIVEN", 0x5A)
    expect("port.DRIVEN", port.get("0x4"), 0x5A)
    expect("reason", fails(Hw.RegisterError, port.set, "DRIVEN", 256).reason,
           "DRIVEN takes 0 to 255")
    waits = port.waitAsync(600000)
    for name in clocked:
        requests = Hw.RegistersPrx.checkedCast(ic.stringToProxy(name + where))
        requests.set("REG2", 0xFFFFFFFF)
        expect("my_requests.REG2", requests.get("REG2"), 0xFFFFFFFF)
        for call in (lambda: requests.get("REG3"), lambda: requests.set("REG3", 1)):
            expect("reason", fails(Hw.RegisterError, call).reason,
                   "REG3: the core does not answer, or refuses the address")
        expect("my_requests.wait", requests.wait(0), ["TIMEOUT"])
    lamps = Hw.RegistersPrx.checkedCast(ic.stringToProxy("my_lamps" + where))
    lamps.set("REG0", 0x1234)
    expect("my_lamps", [lamps.get("REG0"), lamps.get("REG1"), lamps.get("REG1")], [0x1234, 1, 2])
    expect("port.wait, still high", waits.result(), ["CORE"])

    # This core has more words than a slot, so some of its words are accessed through PAGE.
    many = Demo.ManyPrx.checkedCast(ic.stringToProxy("many" + where))
    for seed in (1, 1000003):
        p, q = ([(seed * i * 0x123456789ABCDEF + i & 2**64 - 1) - 2**63 for i in range(n, n + 5)]
                for n in (1, 6))
        answer = many.turn(Demo.Five(*p), Demo.Five(*q))
        expect("many.turn", answer, (Demo.Five(*[~i for i in q]), Demo.Five(*p[1:], p[0])))
        expect("many.add", many.add(seed, -7), seed - 7)

    scaler = Demo.ScalerPrx.checkedCast(ic.stringToProxy("scaler" + where))
    watcher = Watcher()
    adapter = ic.createObjectAdapter("Ground")
    listener = adapter.add(watcher, ic.stringToIdentity("watcher"))
    adapter.activate()
    scaler.watch(Demo.WatcherPrx.uncheckedCast(ic.stringToProxy("watcher -o:xbee-at -a 0x0000")))
    scaler.setLimit(1000)
    values = [37 * i % 200 - 100 for i in range(100)]
    expect("scaler.shift", scaler.shift(values, 7), (sum(values) + 700, [v + 7 for v in values]))
    if not watcher.came.acquire(timeout=60):
        sys.exit("the event 'finished' did not come")
    expect("events", (watcher.peaks, watcher.finished_calls), ([], 1))
    scaler.shift([1, 2000, 3], 5)
    for _ in range(2):
        if not watcher.came.acquire(timeout=60):
            sys.exit("events: %r, %d finished" % (watcher.peaks, watcher.finished_calls))
    expect("events", (watcher.peaks, watcher.finished_calls), ([(1, 2005)], 2))
    # A listener that has no endpoint is called over the connection on which it was passed.
    nearby = ic.createObjectAdapter("")
    scaler.ice_getConnection().setAdapter(nearby)
    scaler.watch(Demo.WatcherPrx.uncheckedCast(nearby.addWithUUID(watcher).ice_oneway()))
    scaler.shift([4, 3000], 5)
    for _ in range(2):
        if not watcher.came.acquire(timeout=60):
            sys.exit("events: %r, %d finished" % (watcher.peaks, watcher.finished_calls))
    expect("events over the call's connection", (watcher.peaks, watcher.finished_calls),
           ([(1, 2005), (1, 3005)], 3))
    thrown = fails(Demo.Overflow, scaler.shift, [0, 1, 32000], 1000)
    expect("Overflow", (thrown.index, thrown.code), (2, 42))
    fails(Ice.UnknownException, scaler.shift, [0] * 101, 1)
    fails(Ice.ObjectNotExistException, ic.stringToProxy("hwengine1" + where).ice_ping)
print("cores: all as expected")
