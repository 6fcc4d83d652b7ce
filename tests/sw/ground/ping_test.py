# SPDX-License-Identifier: MIT
"""ping_test: the program ping reports errors in words, without positions in Ice's source code.

Usage: ping_test.py PING
"""
import subprocess
import sys
import unittest

PING = sys.argv.pop()


def reason(*words):
    """Returns the last line that ping prints for an error."""
    done = subprocess.run([PING, *words], capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 1, done
    return done.stderr.splitlines()[-1]


class Ping(unittest.TestCase):
    def test_errors_are_words(self):
        for words, expected in ((["uav:tcp -h 127.0.0.1 -p 1"], "Connection refused"),
                                (["uav:xyz"], "uav:xyz"), (["uav"], "uav"), ([":"], ":"),
                                (["uav:xbee-at -d /missing -a 1"], ""),
                                (["uav:xbee-at -d /dev/null -a 70000"], "70000")):
            with self.subTest(words=words):
                text = reason(*words)
                self.assertTrue(text.startswith("ping: "), text)
                self.assertIn(expected, text)
                for internal in (".cpp", ".h:", "::Ice::"):
                    self.assertNotIn(internal, text)


if __name__ == "__main__":
    unittest.main()
