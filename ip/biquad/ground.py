# SPDX-License-Identifier: MIT
"""biquad's part of a mission (with a line biquad in ip/cores.list): a step goes through two leaky integrators."""


def fly(log, proxy, report):
    import Cores  # made by loadSlice

    biquad = Cores.BiquadPrx.checkedCast(proxy("biquad"))

    def integrators():  # y(n) = x(n) / 4 + 3 / 4 y(n-1)
        biquad.clear()
        for section in (0, 1):
            for k, value in enumerate((16384, 0, 0, -49152, 0)):
                biquad.setCoefficient(8 * section + k, value)

    log.call("ground -> UAV", "biquad.clear, 2 x 5 setCoefficient", integrators)
    tooLarge, filtered = log.call("ground -> UAV", "biquad.filter(48 samples)", lambda: biquad.filter([8000] * 48))
    # The step's answer of two poles at 3/4: 1 - (1 + (n + 1) / 4) (3 / 4)^(n + 1), and what rounding leaves.
    wanted = [8000 * (1 - (1 + (n + 1) / 4) * 0.75 ** (n + 1)) for n in range(48)]
    if tooLarge or max(abs(f - w) for f, w in zip(filtered, wanted)) > 1:
        raise RuntimeError("biquad: %s came, %s was to come" % (list(filtered), wanted))
    log.say("biquad: a step of 8000 is at %d after 16 samples, at %d after 48" % (filtered[15], filtered[47]))
