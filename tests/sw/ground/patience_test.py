# SPDX-License-Identifier: MIT
"""patience_test: tests that the time-out of calls in a mission counts simulated time, even on a
slow PC, and that the exception of a failed call contains the call."""
import contextlib
import io
import tempfile
import unittest
from unittest import mock

import Ice

import mission_log


class Air:
    """The counters of a simulator."""

    def __init__(self, ns):
        self.ns = ns

    def read(self):
        return None if self.ns is None else {"ns": self.ns}


class Patience(unittest.TestCase):
    def setUp(self):
        self.real = 1000.0
        clock = mock.patch.object(mission_log.time, "monotonic", lambda: self.real)
        clock.start()
        self.addCleanup(clock.stop)

    def test_real_time_does_not_count_while_simulated_time_moves(self):
        air = Air(5 * 10**9)
        patience = mission_log.Patience(air, 16)
        for _ in range(160):  # simulated time is ten times slower than real time
            self.real += 1
            air.ns += 10**8
            self.assertFalse(patience.is_over())
        air.ns += 10**8
        self.assertTrue(patience.is_over())

    def test_it_ends_if_simulated_time_stands_still(self):
        patience = mission_log.Patience(Air(5 * 10**9), 16)
        self.real += 16
        self.assertFalse(patience.is_over())
        self.real += 1
        self.assertTrue(patience.is_over())

    def test_real_hardware_has_only_real_time(self):
        patience = mission_log.Patience(Air(None), 16)
        self.real += 16
        self.assertFalse(patience.is_over())
        self.real += 1
        self.assertTrue(patience.is_over())


class FailedCall(unittest.TestCase):
    def test_the_exception_contains_the_call(self):
        def fails():
            raise Ice.UnknownException()
        with tempfile.TemporaryDirectory() as out, contextlib.redirect_stdout(io.StringIO()):
            log = mission_log.Log(mission_log.Air(""), out, out)
            with self.assertRaises(Ice.UnknownException) as caught:
                log.call("ground -> UAV", "fir.filter(list)", fails)
            log.live.close()
        self.assertEqual(caught.exception.call, "fir.filter(list)")


if __name__ == "__main__":
    unittest.main()
