# SPDX-License-Identifier: MIT
"""vehicles_test: tests the file in which a flight lists its vehicles, and which programs with Ice
read; and that the call command finds only flights in progress."""
import os
import tempfile
import unittest
from pathlib import Path

import vehicles
from icesoc.call import objects

PLACES = {"uav1": "tcp -h 127.0.0.1 -p 40001", "uav2": 'xbee-at -d "/dev/a b" -a 2'}


class Vehicles(unittest.TestCase):
    def setUp(self):
        work = tempfile.TemporaryDirectory()
        self.addCleanup(work.cleanup)
        self.folder = Path(work.name)
        self.file = self.folder / objects.VEHICLES

    def written(self, process, build="/build"):
        self.file.write_text(vehicles.text(PLACES, Process=process, Build=build))
        return objects.flight(self.folder)

    def test_programs_find_each_vehicle_by_its_name(self):
        self.written(os.getpid())
        for name, place in PLACES.items():
            self.assertEqual(vehicles.find(name, str(self.file))[0], ":" + place)
        with self.assertRaisesRegex(vehicles.Unknown, "several: uav1, uav2"):
            vehicles.find("", str(self.file))

    def test_a_folder_may_have_characters_that_mean_something_in_properties(self):
        for build in "/a b/c", "/a#b", "/a\\b=c", "/größe":
            flight = self.written(os.getpid(), build)
            self.assertEqual((flight.build, flight.vehicles), (build, PLACES))

    def test_a_flight_that_has_ended_is_not_found(self):
        pid = os.posix_spawn("/bin/true", ["true"], os.environ)
        os.waitpid(pid, 0)
        self.assertIsNone(self.written(pid))
        self.assertIsNone(self.written("none"))
        self.file.write_text("Vehicle.uav1=tcp\n")  # a list of vehicles that is not of a flight
        self.assertIsNone(objects.flight(self.folder))
        self.file.unlink()
        self.assertIsNone(objects.flight(self.folder))


unittest.main()
