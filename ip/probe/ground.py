# SPDX-License-Identifier: MIT
"""probe's part of a mission: it records while the cores named after it fly: build/run/probe.vcd."""
import os

from icesoc.cores import probe as tool

NEWEST = 2000  # changes that are read without a trigger


def fly(log, proxy, report):
    import Probes  # made by loadSlice

    trigger = os.environ.get("PROBE", "")
    signals = tool.Signals(os.path.join(log.build, "gen/probes.json"), "probe")
    mask, value = signals.trigger(trigger)
    probe = Probes.ProbePrx.uncheckedCast(proxy(signals.identity))
    signals.check(log.call("ground -> UAV", "probe.getState()", probe.getState))
    # Without a trigger a condition that never occurs: the newest changes are kept.
    log.call(
        "ground -> UAV", "probe.arm(%s)" % (trigger or "no trigger"),
        lambda: probe.arm(tool.signed(mask), tool.signed(value if trigger else 1), True, NEWEST))

    def end():
        log.call("ground -> UAV", "probe.stop()", probe.stop)
        state = probe.getState()
        log.say("probe: " + log.call("ground -> UAV", "probe.read(...)", lambda: tool.save(
            os.path.join(log.out, "probe.vcd"), signals, probe, state, NEWEST, NEWEST)))

    return end
