#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""make_trace: prints the trace of a flight: 300 m out at 10 m/s, 50 s at that distance, and back.

The trace is computed, not recorded. It contains free-space loss, Rayleigh fading of each of the
four tries of a packet (as in rf_channel.h), and bursts of losses that are as frequent as in
"bursts, long" (docs/simulation.md). Once per second, a random number decides whether a burst
begins or ends."""
import math
import random
import sys

SENSITIVITY, FIRST_METRE = -92, 40  # dBm, dB
# Probabilities per second (about ten packets) that a burst begins and that it ends; loss rate
# inside a burst
BEGIN, END, INSIDE = 0.01 * 10, 0.08 * 10, 0.9


def rows(draw):
    burst = False
    for second in range(110):
        metres = max(1, min(300, 10 * second, 10 * (110 - second)))
        rssi = -FIRST_METRE - 20 * math.log10(metres) + draw.uniform(-3, 3)
        missed = 1 - math.exp(-10 ** ((SENSITIVITY - rssi) / 10))
        burst = draw.random() >= END if burst else draw.random() < BEGIN
        yield second, max(missed ** 4, INSIDE if burst else 0), rssi


print("time_s,loss,rssi_dbm,delay_ms")
for time, loss, strength in rows(random.Random(int(sys.argv[1]) if sys.argv[1:] else 7)):
    print(f"{time},{loss:.4f},{strength:.1f},0")
