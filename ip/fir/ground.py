# SPDX-License-Identifier: MIT
"""Runs the part of a mission for the core fir: it filters a noisy step with a moving average of 16
samples."""


def fly(log, proxy, report):
    import Cores  # module that loadSlice generates from fir.ice

    fir = Cores.FirPrx.uncheckedCast(proxy("fir"))

    def average():
        fir.clear()
        fir.setShift(4)
        for k in range(16):
            fir.setCoefficient(k, 1)

    log.call("ground -> UAV", "fir.clear, setShift, 16 x setCoefficient", average)
    signal = [(1000 if i >= 20 else 0) + 137 * (-1) ** i for i in range(64)]
    tooLarge, filtered = log.call("ground -> UAV", "fir.filter(64 samples)",
                                  lambda: fir.filter(signal))
    # The filter rounds to the nearest integer, halves up (ip/fir/README.md).
    wanted = [(sum(signal[max(0, n - 15):n + 1]) + 8) >> 4 for n in range(64)]
    if list(filtered) != wanted or tooLarge:
        raise RuntimeError("fir: %s came, %s was to come" % (list(filtered), wanted))
    log.say("fir: noise of +-137 became +-%d" % max(abs(v - 1000) for v in filtered[40:]))
