# SPDX-License-Identifier: MIT
"""Runs the part of a mission for the core probe: records signals while the listed cores run, and
writes build/run/probe.vcd."""
import os

from icesoc.cores import probe as tool

NEWEST = 2000  # number of changes that are read if the trigger condition was not met


def fly(log, proxy, report):
    import Probes  # module that loadSlice generates from Probe.ice

    trigger = os.environ.get("PROBE", "")
    signals = tool.Signals(os.path.join(log.build, "gen/chip.json"), "probe")
    mask, value = signals.trigger(trigger)
    probe = Probes.ProbePrx.uncheckedCast(proxy(signals.identity))
    signals.check(log.call("ground -> UAV", "probe.getState()", probe.getState))
    # If no trigger is requested, the probe gets a condition that is never met, so that the ring
    # contains the newest changes when the capture is stopped.
    log.call(
        "ground -> UAV", "probe.arm(%s)" % (trigger or "no trigger"),
        lambda: probe.arm(tool.signed(mask), tool.signed(value if trigger else 1), True, NEWEST))

    def end():
        log.call("ground -> UAV", "probe.stop()", probe.stop)
        state = probe.getState()
        log.say("probe: " + log.call("ground -> UAV", "probe.read(...)", lambda: tool.save(
            os.path.join(log.out, "probe.vcd"), signals, probe, state, NEWEST, NEWEST)))

    return end
