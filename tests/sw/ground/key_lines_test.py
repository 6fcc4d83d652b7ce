# SPDX-License-Identifier: MIT
"""key_lines_test: tests that change_key.py keeps the other lines of a key file, whatever bytes
their comments contain, and that provide_key.py can read a file with a byte order mark, and takes
decimal and hexadecimal addresses."""
import argparse
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import change_key
import provide_key

OLD, OTHER = "00112233445566778899aabbccddeeff", "ff" * 16


class KeyLines(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name, "fleet.key")

    def write(self, content):
        self.path.write_bytes(content)
        self.path.chmod(0o600)

    def change(self):
        """Changes the key of vehicle 1; a mock replaces the vehicle. Returns the new content of the
        key file."""
        with mock.patch.object(change_key, "talk", return_value=1), mock.patch("builtins.print"):
            change_key.change(argparse.Namespace(key=str(self.path), address=1))
        return self.path.read_bytes()

    def test_other_lines_are_kept(self):
        for comment in (b"# Jos\xe9", b"# form\x0cfeed", "# next\x85line \u2028 end".encode(),
                        b"# carriage\rreturn", b""):
            self.write(b"%s\n0x0001 %s\n0x0002 %s # two\n" % (comment, OLD.encode(),
                                                             OTHER.encode()))
            lines = self.change().split(b"\n")
            self.assertEqual((lines[0], lines[2:]),
                             (comment, [b"0x0002 %s # two" % OTHER.encode(), b""]))
            self.assertNotEqual(provide_key.read_key(self.path, 1), OLD)
            self.assertEqual(provide_key.read_key(self.path, 2), OTHER)

    def test_a_byte_order_mark_is_ignored(self):
        self.write(b"\xef\xbb\xbf" + OLD.encode() + b"\r\n")
        self.assertEqual(provide_key.read_key(self.path, 7), OLD)
        self.change()
        self.assertEqual(provide_key.read_key(self.path, 7), OLD)
        self.assertNotEqual(provide_key.read_key(self.path, 1), OLD)

    def test_an_address_is_decimal_or_hexadecimal(self):
        for text in "9", "0x9", "0X0009":
            self.assertEqual(provide_key.address(text), 9)
        for text in "", "x", "09", "65536", "0x10000", "-1", "٣":
            with self.assertRaisesRegex(argparse.ArgumentTypeError, "expected 0 to 65535"):
                provide_key.address(text)


if __name__ == "__main__":
    unittest.main()
