# SPDX-License-Identifier: MIT
"""probe: captures signals of a vehicle's FPGA by radio, as a waveform (VCD) with the simulator's
names. It uses stock ZeroC Ice.

    probe.py --device /dev/ttyUSB0 --plugin build/main/ground --trigger u_fir.sent=1 \\
        --after 500 capture.vcd
    gtkwave capture.vcd

The recorded signals are in the probe's line in ip/cores.list; --map is gen/chip.json in the build
folder of the vehicle's chip. Times count chip clocks, modulo 2**32.
"""

import argparse
import collections
import os
import sys
import time

from icesoc import TREE
from icesoc.util import chip
from icesoc.util.errors import Stop, reason_of

RING_BYTES, READ_BYTES = 1 << 18, 4096  # probe.regs.json, probe_servant.h
# gap: 1 if changes directly before this change were lost, otherwise 0
Change = collections.namedtuple("Change", "clock gap value")


class Signals:
    """Signals of one probe: names and widths, bit 0 first."""

    def __init__(self, path, name):
        try:
            probes = {probe.core: probe for probe in chip.read(path).probes}
        except (OSError, ValueError) as e:
            raise Stop("--map: expected gen/chip.json of the build folder of the vehicle's chip, "
                         "got '%s': %s" % (path, getattr(e, "strerror", None) or reason_of(e)))
        if name not in probes:
            raise Stop("--map %s: expected a probe '%s', found %s" %
                         (path, name, ", ".join(probes) or "none"))
        self.names = probes[name].names
        self.identity = probes[name].identity
        self.list = [(signal, width) for signal, width in probes[name].signals]

    def check(self, state):
        if state.names & 0xFFFFFFFF != self.names:
            raise Stop("--map: expected signals with the hash 0x%08X (in the chip), got 0x%08X; "
                         "give the chip.json of the build of this chip" %
                         (state.names & 0xFFFFFFFF, self.names))

    def trigger(self, text):
        """Converts a text such as "u_fir.sent=1,u_fir.count=0x10" to a mask and a value."""
        mask = wanted = 0
        for word in text.split(",") if text else ():
            name, _, number = word.partition("=")
            lsb = 0
            for signal, width in self.list:
                if signal == name:
                    break
                lsb += width
            else:
                raise Stop("--trigger: unknown signal '%s': expected one of %s" %
                             (name, ", ".join(s for s, _ in self.list)))
            try:
                value = int(number, 0)
            except ValueError:
                raise Stop("--trigger: expected a signal and a value such as u_fir.count=0x10, "
                             "got '%s'" % word)
            if not 0 <= value < 1 << width:
                raise Stop("--trigger: %s: expected 0 to %d, got %s" %
                             (name, (1 << width) - 1, number))
            if lsb + width > 31:
                raise Stop("--trigger: %s is at bits %d to %d of the list, and only bits below "
                             "31 can trigger; list it earlier in signals=" %
                             (name, lsb, lsb + width - 1))
            mask |= (1 << width) - 1 << lsb
            wanted |= value << lsb
        return mask, wanted

    def parts(self, value):
        for name, width in self.list:
            yield name, value & (1 << width) - 1
            value >>= width


def signed(value):
    return value - (value >> 31 << 32)


def read(probe, state, before, after):
    """Returns the change that triggered, with up to `before` changes before it and up to `after`
    changes after it. If the trigger has not occurred, returns the changes around the newest one."""
    size = 8 * state.words
    ring = RING_BYTES // size
    count = ring if state.wrapped else state.next
    oldest = state.next if state.wrapped else 0
    at = (state.trigger - oldest) % ring if state.trigger >= 0 else max(count - 1, 0)
    data, place, end = b"", max(at - before, 0), min(at + after + 1, count)
    while place < end:
        first = (oldest + place) % ring
        n = min(end - place, ring - first, READ_BYTES // size)
        data += bytes(probe.read(first, n))
        place += n
    changes, clock = [], None
    for i in range(0, len(data), size):
        entry = int.from_bytes(data[i:i + size], "little")
        low = entry - 2 & 0xFFFFFFFF  # the stored time is two clocks after the change
        clock = low if clock is None else clock + (low - clock & 0xFFFFFFFF)
        changes.append(Change(clock, entry >> 32 & 1, entry >> 33))
    return changes


def write_vcd(path, signals, changes, clk_hz):
    """Returns the changes as VCD. Where changes were lost, all signals are x until the next stored
    change."""
    unit, name = (10**9, "1ns") if 10**9 % clk_hz == 0 else (10**12, "1ps")
    ids = {s: "".join(chr(33 + d) for d in divmod(i, 94)) for i, (s, _) in enumerate(signals.list)}
    widths = dict(signals.list)
    lines = ["$comment what a probe of IceSoC recorded, clk_hz %d $end" % clk_hz,
             "$timescale %s $end" % name, "$scope module TOP $end",
             "$scope module soc $end"]
    scope: list[str] = []
    for signal in sorted(ids, key=lambda s: s.split(".")):
        *folder, leaf = signal.split(".")
        same = len(os.path.commonprefix([scope, folder]))
        lines += ["$upscope $end"] * (len(scope) - same) + ["$scope module %s $end" % s
                                                            for s in folder[same:]]
        scope = folder
        bits = " [%d:0]" % (widths[signal] - 1) if widths[signal] > 1 else ""
        lines.append("$var wire %d %s %s%s $end" % (widths[signal], ids[signal], leaf, bits))
    lines += ["$upscope $end"] * (len(scope) + 2) + ["$enddefinitions $end"]

    def show(signal, bits):
        lines.append(("%s%s" if widths[signal] == 1 else "b%s %s") % (bits, ids[signal]))

    shown = {}
    for i, change in enumerate(changes):
        if change.gap and i:
            lines.append("#%d" % ((changes[i - 1].clock + 1) * unit // clk_hz))
            for signal in ids:
                show(signal, "x")
            shown = {}
        lines.append("#%d" % (change.clock * unit // clk_hz))
        for signal, value in signals.parts(change.value):
            if shown.get(signal) != value:
                shown[signal] = value
                show(signal, format(value, "0%db" % widths[signal]))
    lines.append("#%d" % ((changes[-1].clock + 1) * unit // clk_hz))
    with open(path, "w") as f:
        f.write("\n".join(lines) + "\n")


def save(path, signals, probe, state, before, after):
    """Writes the capture into a file; returns messages about the capture."""
    changes = read(probe, state, before, after)
    if not changes:
        raise Stop("expected recorded changes in the probe, got none; run the recorded core "
                     "during the capture")
    write_vcd(path, signals, changes, state.clkHz)
    lost = sum(c.gap for c in changes)
    return "%d changes of %d signals in %d clocks%s: gtkwave %s" % (
        len(changes), len(signals.list), changes[-1].clock - changes[0].clock + 1,
        ", changes were lost at %d places" % lost if lost else "", path)


def capture(probe, signals, args, say):
    state = probe.getState()
    signals.check(state)
    mask, value = signals.trigger(args.trigger)
    ring = RING_BYTES // (8 * state.words)
    if args.before < 0 or args.after < 0 or args.before + args.after >= ring:
        raise Stop("--before and --after: expected fewer than %d changes together, the size of "
                     "the ring" % ring)
    probe.arm(signed(mask), signed(value), bool(args.trigger) and not args.level, args.after)
    say("armed; waiting for %s" % (args.trigger or "changes; the capture begins at once"))
    end = time.monotonic() + args.wait
    while str((state := probe.getState()).phase) != "done":
        if time.monotonic() > end:
            say("%s after %d s: stopped with the changes so far" % (
                "no trigger" if state.trigger < 0 else "not all changes after the trigger",
                args.wait))
            probe.stop()
            state = probe.getState()
            break
        time.sleep(0.1)
    say(save(args.out, signals, probe, state, args.before, args.after))


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", help="output file for the waveform (VCD)")
    parser.add_argument("--map", default=str(TREE / "build/main/gen/chip.json"),
                        help="chip.json of the build (default: build/main/gen/chip.json)")
    parser.add_argument("--probe", default="probe",
                        help="name of the probe in ip/cores.list (default: probe)")
    parser.add_argument("--trigger", default="",
                        help="signals and values, such as u_fir.sent=1,u_fir.count=0x10; the "
                             "capture begins when all signals have changed to these values "
                             "(default: at once)")
    parser.add_argument("--level", action="store_true",
                        help="begin at once if the signals already have these values")
    parser.add_argument("--before", type=int, default=500,
                        help="number of changes before the trigger (default: 500)")
    parser.add_argument("--after", type=int, default=1500,
                        help="number of changes after the trigger (default: 1500)")
    parser.add_argument("--wait", type=float, default=60,
                        help="time to wait for the trigger, s; then the changes recorded so "
                             "far are used (default: 60)")
    parser.add_argument("--device", help="serial port of the modem")
    parser.add_argument("--proxy",
                        help="proxy of the probe, such as 'probe:tcp -h host -p 4061'; replaces "
                             "--device")
    parser.add_argument("--plugin", help="folder of libxbeeat.so.37")
    parser.add_argument("--key", default="", help="file with the link key (default: unencrypted)")
    parser.add_argument("--guard", type=int, default=1000, help="guard time of the modem, ms")
    args = parser.parse_args()
    if not args.device and not args.proxy:
        parser.error("expected --device or --proxy")
    import Ice
    import plugged
    plugged.interrupt_once()
    Ice.loadSlice("", [str(TREE / "ip/probe/Probe.ice")])
    import Probes  # Ice.loadSlice creates this module
    communicator = None
    try:
        signals = Signals(args.map, args.probe)
        settings = {"Ice.Default.InvocationTimeout": "60000", "Ice.ACM.Close": "0"}
        communicator = plugged.initialize(settings, args.plugin, args.guard, args.key)
        where = args.proxy or "%s:xbee-at -d %s -a 0x0001 -t 60000" % (
            signals.identity, plugged.quoted(args.device))
        capture(Probes.ProbePrx.uncheckedCast(communicator.stringToProxy(where)), signals, args,
                lambda text: print("probe: " + text, flush=True))
        return 0
    except KeyboardInterrupt:
        return 130
    except Ice.ObjectNotExistException:
        sys.exit("probe: the vehicle has no probe '%s': add its line to ip/cores.list, and build "
                 "the chip and the firmware" % signals.identity)
    except (Stop, Ice.Exception, OSError) as e:
        sys.exit("probe: %s" % e)
    finally:
        if communicator:
            communicator.destroy()


if __name__ == "__main__":
    sys.exit(main())
