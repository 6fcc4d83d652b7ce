# SPDX-License-Identifier: MIT
"""update_file_test: tests that update.py reads all update packages in a file, in order, and rejects
a damaged file."""
import tempfile
import unittest
from pathlib import Path

import update

HEADER = update.HEADER
FIRMWARE, FPGA, KEYS = (HEADER.constants[name]
                        for name in ("LOADER_PRODUCT", "FPGA_PRODUCT", "SLOTS_KEYS"))


def package(product, version, base=0, image=b"", **more):
    """Returns a package: the header that pack_update writes, and the image."""
    fields = {"magic": update.MAGIC, "product": product, "version": version, "base": base,
              "bytes": len(image), **more}
    return HEADER.pack(**fields) + image


class Packages(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name, "package")

    def read(self, *parts):
        self.path.write_bytes(b"".join(parts))
        return update.read_package(self.path)

    def test_several_packages_in_one_file_are_sent_in_their_order(self):
        lists = [package(KEYS, 1), package(KEYS, 2)]
        slots = [package(FIRMWARE, 5, 0x08020000, b"first"),
                 package(FIRMWARE, 5, 0x08060000, b"second")]
        newer = package(FIRMWARE, 6, 0x08020000, b"third")
        fpga = package(FPGA, 3, 0, b"bits")
        parts = self.read(*lists, *slots, fpga, newer, package(KEYS, 3))
        self.assertEqual([name for name, _ in parts],
                         ["keys", "update", "fpga", "update", "keys"])
        self.assertEqual(parts[0][1], lists)
        self.assertEqual({base: image for base, (_, image) in parts[1][1].items()},
                         {0x08020000: b"first", 0x08060000: b"second"})
        self.assertEqual(parts[2][1][0], (fpga[:HEADER.size], b"bits"))
        self.assertEqual(parts[3][1][0x08020000][1], b"third")
        self.assertEqual(len(parts[4][1]), 1)

    def test_the_same_package_twice_is_sent_twice(self):
        image = package(FIRMWARE, 5, 0x08020000, b"first")
        self.assertEqual([name for name, _ in self.read(image, image)], ["update", "update"])

    def test_a_damaged_file_is_rejected(self):
        good = package(FIRMWARE, 5, 0x08020000, b"image")
        for bytes_ in (good[:-1], good[:40], good + b"x", good + good[:-1], good[1:],
                       package(FIRMWARE, 5, 0, b"image", magic=update.MAGIC ^ 1),
                       package(max(FIRMWARE, FPGA, KEYS) + 1, 5, 0, b"image")):
            with self.assertRaisesRegex(update.Failed, "expected a complete package"):
                self.read(bytes_)
        with self.assertRaisesRegex(update.Failed, "got an empty file"):
            self.read()


if __name__ == "__main__":
    unittest.main()
