# SPDX-License-Identifier: MIT
"""Runs probe's part of a mission: records signals while the listed cores run, and writes
build/run/probe.vcd."""
import os

from icesoc.cores import probe as tool

NEWEST = 2000  # number of changes that are read if the trigger condition was never met


def fly(log, proxy, report):
    import Probes  # made by loadSlice

    trigger = os.environ.get("PROBE", "")
    signals = tool.Signals(os.path.join(log.build, "gen/chip.json"), "probe")
    mask, value = signals.trigger(trigger)
    probe = Probes.ProbePrx.uncheckedCast(proxy(signals.identity))
    signals.check(log.call("ground -> UAV", "probe.getState()", probe.getState))
    # Without a trigger, a condition is set that never occurs: the ring then contains the newest
    # changes.
    log.call(
        "ground -> UAV", "probe.arm(%s)" % (trigger or "no trigger"),
        lambda: probe.arm(tool.signed(mask), tool.signed(value if trigger else 1), True, NEWEST))

    def end():
        log.call("ground -> UAV", "probe.stop()", probe.stop)
        state = probe.getState()
        log.say("probe: " + log.call("ground -> UAV", "probe.read(...)", lambda: tool.save(
            os.path.join(log.out, "probe.vcd"), signals, probe, state, NEWEST, NEWEST)))

    return end
