# SPDX-License-Identifier: MIT
"""manifest_test: tests the manifest of a core, core.toml: values that are accepted, and the
messages for values that are rejected."""
import re
import tempfile
import unittest
from pathlib import Path

import places

from icesoc import TREE
from icesoc.chip import manifest
from icesoc.regs.model import Wrong


class Manifest(unittest.TestCase):
    def setUp(self):
        work = tempfile.TemporaryDirectory()
        self.addCleanup(work.cleanup)
        self.folder = Path(work.name) / "lamp"
        self.folder.mkdir()
        for name in ("lamp.v", "lamp.ice", "lamp.regs.json"):
            (self.folder / name).write_text("")
        self.path = self.folder / "core.toml"

    def read(self, text):
        self.path.write_text(text, encoding="utf-8")
        return manifest.read(self.path)

    def refused(self, words, text):
        with self.assertRaises(Wrong) as caught:
            self.read(text)
        self.assertIn(words, str(caught.exception))
        self.assertTrue(str(caught.exception).startswith(str(self.path)))

    def test_a_folder_with_two_lines_is_a_core(self):
        core = self.read('interface = "lamp.ice"\nverilog = ["lamp.v"]\n')
        self.assertEqual(core.name, "lamp")
        words = manifest.cmake(core)
        self.assertIn('set(name "lamp")', words)
        self.assertIn(f'set(A_VERILOG "{self.folder}/lamp.v")', words)

    def test_a_byte_order_mark_is_ignored(self):
        core = self.read('\ufeffinterface = "lamp.ice"\nverilog = ["lamp.v"]')
        self.assertEqual(core.name, "lamp")

    def test_a_value_out_of_range_is_named_with_its_range(self):
        self.refused("clock_hz: expected 3000000 to 100000000, got 5",
                     'interface = "lamp.ice"\nverilog = ["lamp.v"]\nclock_hz = 5\n')

    def test_an_unknown_key_is_refused_with_the_known_ones(self):
        self.refused("unknown key 'verilg'; expected clk_hz, clock_hz", 'verilg = ["lamp.v"]\n')

    def test_each_wrong_key_of_a_file_is_named(self):
        text = 'interface = "lamp.ice"\nidle = 1\nverilog = "lamp.v"\n'
        self.refused("idle: expected true or false, got 1", text)
        self.refused('verilog: expected a list of files, got "lamp.v"', text)

    def test_a_missing_file_is_named(self):
        self.refused("verilog: no file lump.v", 'interface = "lamp.ice"\nverilog = ["lump.v"]\n')

    def test_a_name_is_no_reserved_word(self):
        for name in ("signal", "module", "logic", "test"):
            self.refused(f"name: '{name}' is a reserved word",
                         f'name = "{name}"\ninterface = "lamp.ice"\nverilog = ["lamp.v"]\n')

    def test_a_core_has_files_and_each_once(self):
        self.refused("expected 'verilog' or 'vhdl'", 'interface = "lamp.ice"\nverilog = []\n')
        self.refused("verilog: lamp.v is listed twice",
                     'interface = "lamp.ice"\nverilog = ["lamp.v", "lamp.v"]\n')

    def test_the_objects_of_the_platform_are_those_of_the_firmware(self):
        firmware = "".join(file.read_text() for file in (TREE / "sw/vehicle").glob("*.c"))
        added = re.findall(r'Ice_ObjectAdapter_add\([^;]*"(\w+)"\)', firmware)
        updatable = re.search(r"names\[UAV_UPDATABLES\] = {(.*?)}", firmware)[1]
        self.assertEqual({*added, *re.findall(r'"(\w+)"', updatable)}, set(places.OBJECTS))

    def test_a_core_has_one_interface(self):
        self.refused("expected one of 'interface'", 'verilog = ["lamp.v"]\n')

    def test_pins_have_a_place_for_each_bit(self):
        self.refused("pins: led_o: expected 2 places, got 1",
                     'registers = "lamp.regs.json"\nverilog = ["lamp.v"]\n'
                     'pins = [{name = "led_o", width = 2, places = ["A4"]}]\n')

    def test_a_pin_shows_its_direction(self):
        self.refused("pins[0].name: expected the name of a port that ends with i or o, got",
                     'registers = "lamp.regs.json"\nverilog = ["lamp.v"]\n'
                     'pins = [{name = "led"}]\n')

    def test_a_window_is_for_registers(self):
        self.refused("window: expected with 'registers' only",
                     'interface = "lamp.ice"\nverilog = ["lamp.v"]\nwindow = true\n')
        core = self.read('registers = "lamp.regs.json"\nverilog = ["lamp.v"]\nwindow = true\n')
        self.assertIn('set(A_WINDOW "TRUE")', manifest.cmake(core))

    def test_properties_of_the_manifest_are_part_of_the_block(self):
        registers = self.folder / "lamp.regs.json"
        text = '{"block": "lamp", "doc": "", "type": "0x4C41", "version": "0x0100", "registers": []'
        registers.write_text(text + "}")
        core = self.read('registers = "lamp.regs.json"\nverilog = ["lamp.v"]\nmemory_bytes = 64\n'
                         'pins = [{name = "led_o", places = ["A4"]}]\n')
        block = manifest.block_of(core, registers)
        self.assertEqual((block.memory_bytes, block.description["memory_port"]), (64, True))
        self.assertEqual(block.description["pins"], [{"name": "led_o"}])
        registers.write_text(text + ', "memory_bytes": 64}')
        with self.assertRaisesRegex(Wrong, "memory_bytes: expected in core.toml only"):
            manifest.block_of(core, registers)

    def test_all_manifests_of_the_tree_are_valid(self):
        found = [*TREE.glob("ip/*/core.toml"), *TREE.glob("tests/*/cores/*/core.toml")]
        self.assertGreaterEqual(len(found), 7)
        for path in found:
            self.assertEqual(manifest.read(path).name, path.parent.name)


if __name__ == "__main__":
    unittest.main()
