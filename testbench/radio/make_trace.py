#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""make_trace: prints a trace: out to 300 m at 10 m/s, most of a minute there, and back.

It is made up, not recorded: free space and Rayleigh fading of the four tries of a packet, as in
rf_channel.h, and bursts as frequent as "bursts, long" (docs/simulation.md), drawn again each
second."""
import math
import random
import sys

SENSITIVITY, FIRST_METRE = -92, 40  # dBm, dB
# Probabilities per second (about ten packets) that a burst begins and ends; packets lost in it
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
