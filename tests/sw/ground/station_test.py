# SPDX-License-Identifier: MIT
"""station_test: a call of the mission's station to the vehicle that fails ends the mission with the
reason of this call."""
import types
import unittest

import Ice

import mission


class Log:
    def say(self, text):
        pass

    def follow(self, row):
        pass

    def call(self, who, what, function):
        return function()


class Vehicle:
    """A proxy of a vehicle whose link is lost during a call."""

    def ice_timeout(self, timeout):
        return self

    def isAlive(self, session):
        raise Ice.ConnectionLostException()


class Station(unittest.TestCase):
    def test_a_lost_link_is_the_reason_of_the_failure(self):
        station = mission.make_station(types.SimpleNamespace(Station=object), Log(), 1000)
        station.vehicleState(Vehicle(), [], None)
        self.assertTrue(station.called.is_set())
        flight = types.SimpleNamespace(station=station, air=types.SimpleNamespace(read=dict),
                                       args=types.SimpleNamespace(patience=1))
        with self.assertRaises(Ice.ConnectionLostException):
            mission.Mission.hear(flight)


if __name__ == "__main__":
    unittest.main()
