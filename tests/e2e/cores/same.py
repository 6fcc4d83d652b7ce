#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""same: checks that a probe's capture is equal to the simulator's trace: same.py capture.vcd
trace.vcd nanoseconds-of-a-clock

Compares each signal of the capture in each clock that both files contain. The trace (fst2vcd) has
two times per clock. It contains u_system_slot.cycles, which numbers the clocks."""
import sys

from icesoc.cores.replay import read_vcd


def clocks(moments, keys, clock_of):
    """Returns {clock: {key: value}} for the signals with these keys. `moments` is a list of pairs
    of a time and the changes at this time; `clock_of` returns the clock to which a time belongs."""
    values, found = dict.fromkeys(keys), {}
    for time, changes in moments:
        values = {key: int(changes[key], 2) if key in changes and "x" not in changes[key] else old
                  for key, old in values.items()}
        found[clock_of(time, values)] = values
    return found


capture_file, trace_file, period = sys.argv[1:]
_, names, moments = read_vcd(capture_file)
captured = clocks(moments, list(names), lambda time, values: time // int(period))
_, names_there, moments = read_vcd(trace_file)
key_of = {name: key for key, all_names in names_there.items() for name, _ in all_names}
pairs = [(key, key_of[name], name) for key, all_names in names.items() for name, _ in all_names]
count = key_of["u_system_slot.cycles"]
traced = clocks(moments, [count] + [other for _, other, _ in pairs],
                lambda time, values: values[count])
changes = sorted(captured)
first, last = max(changes[0], min(traced)), min(changes[-1], max(traced) + 1)
now, there, wrong = captured[max(c for c in changes if c <= first)], None, 0
for clock in range(first, last):
    now = captured.get(clock) or now
    there = traced.get(clock) or there
    for mine, other, name in pairs:
        if now[mine] != there[other]:
            wrong += 1
            print(f"clock {clock}: {name} is {now[mine]} in the capture and {there[other]} in the "
                  "trace")
moved = sum(first < c < last for c in changes)
print("%d signals in %d clocks, %d changes: %d differ" % (len(pairs), last - first, moved, wrong))
sys.exit(wrong != 0 or moved < 100)
