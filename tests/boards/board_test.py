# SPDX-License-Identifier: MIT
"""board_test: checks that all boards of the tree can be read, and that boards without unknown facts
can be built. Their generated files must agree with the chip, with the facts about parts, and with
the pages in docs/boards."""
import re
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from icesoc import TREE
from icesoc.board import check, firmware, make, model, picture, signals, ucf, wiring
from icesoc.cli.commands.board import PAGES, documents
from icesoc.regs.model import Wrong

KIT = model.find("nucleo-qmtech")
MUXED = model.find("nucleo-qmtech-muxed")


class Boards(unittest.TestCase):
    def test_all_are_read_and_only_unknown_facts_stop_a_build(self):
        for name in model.names():
            board = model.find(name)
            found = check.problems(board)
            self.assertEqual([text for text in found if not text.startswith("unknown: ")], [])
            if board.facts.get("unknown"):
                self.assertRaisesRegex(Wrong, "unknown: ", make.for_build, board)
            else:
                make.for_build(board)

    def test_pages_in_docs_are_those_that_are_generated(self):
        expected = {}
        for name in model.names():
            expected |= documents(model.find(name))
        for name, text in expected.items():
            self.assertEqual((PAGES / name).read_text(), text,
                             f"docs/boards/{name}: ./icesoc board make NAME --docs writes it")
        self.assertEqual({p.name for p in PAGES.iterdir()} - {"index.md"}, set(expected))

    def test_names_of_ports_are_those_of_the_chip(self):
        chip = (TREE / "synth/ise/chip.v").read_text()
        ports = {name: width for width, name in re.findall(
            r"(?:input|output|inout) +wire +(?:\[(\d+):0\])? *(\w+)", chip.partition("\n);")[0])}
        for signal in signals.SIGNALS.values():
            if signal.port:
                name, _, bit = signal.port.rstrip(">").partition("<")
                self.assertIn(name, ports)
                self.assertEqual(bool(bit), bool(ports[name]), signal.port)
                self.assertLessEqual(int(bit or 0), int(ports[name] or 0))

    def test_the_muxed_kit_has_15_wires_fewer(self):
        self.assertEqual(len(wiring.wires(KIT)) - len(wiring.wires(MUXED)), 15)
        self.assertIsNone(MUXED.net("A0"))
        self.assertEqual(MUXED.net("NADV").get("mcu"), "PB7")

    def test_each_wire_is_in_the_table_once_and_in_the_picture(self):
        rows = wiring.wires(KIT)
        self.assertEqual(len({row[4] for row in rows}), len(rows))
        self.assertIn(("CN12.46 (PD14)", "↔", "U7.5 (E12)", "D0", ""),
                      [row[1:] for row in rows])
        svg = picture.draw(KIT)
        ElementTree.fromstring(svg)
        for net in KIT.nets:
            if net.get("mcu") and net.get("fpga"):
                self.assertIn(f"<title>{net.name}</title>", svg)

    def test_constraints_place_each_port_once_at_its_ball(self):
        places = re.findall(r'^NET "([^"]+)" LOC = "(\w+)"', ucf.constraints(KIT), re.M)
        self.assertEqual(len(dict(places)), len(places))
        for net in KIT.nets:
            if net.get("fpga"):
                self.assertEqual(dict(places)[net.signal.port], net.get("fpga"))

    def test_the_firmwares_table_switches_each_fsmc_pin_and_keeps_the_debugger(self):
        ports = firmware.ports(MUXED)
        for net in MUXED.nets:
            pin = net.get("mcu")
            if pin and net.function.startswith("FSMC_"):
                registers, number = ports[pin[1]], int(pin[2:])
                self.assertEqual(registers["mode"] >> 2 * number & 3, 2)
                half = registers["low" if number < 8 else "high"]
                self.assertEqual(half >> 4 * (number % 8) & 15, 12)
        self.assertEqual(ports["B"]["mode"] & 0x3C0, 0x280)

    def test_the_kit_has_fsmc_pins_on_four_ports_only(self):
        self.assertEqual(set(firmware.ports(KIT)), set("DEFG"))

    def test_the_commands_of_the_page_do_what_it_shows(self):
        text = (TREE / "docs/first-board.md").read_text()
        commands = re.findall(r"^\./icesoc (board (?:list|check|make|show).*)$", text, re.M)
        said = ""
        for words in commands:
            said += subprocess.run([TREE / "icesoc", *words.split()], cwd=TREE, check=True,
                                   text=True, stdout=subprocess.PIPE).stdout
        self.assertGreaterEqual(len(commands), 2)
        for shown in re.findall(r"prints `(nucleo-qmtech: [^`]*)`", text):
            self.assertIn(shown, said)
        for file in re.findall(r"^\| `([a-z_.]+)` \|", text, re.M):
            self.assertIn(f"build/board/nucleo-qmtech/{file}", said)

    def test_errors_name_the_place(self):
        cases = {
            'title = 3\n': "title: expected a text, got 3",
            'nets = [{ name = "D99", fpga = "A5" }]\n': "nets: unknown name D99; did you mean",
            'base = "nucleo-qmtec"\n': "no board 'nucleo-qmtec'; did you mean nucleo-qmtech?",
        }
        for text, expected in cases.items():
            with tempfile.TemporaryDirectory() as folder:
                path = Path(folder) / "board.toml"
                base = "" if "base" in text else 'base = "nucleo-qmtech"\n'
                path.write_text(base + text)
                with self.assertRaises(Wrong) as caught:
                    model.read(path)
                self.assertIn(expected, str(caught.exception))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
