# SPDX-License-Identifier: MIT
"""board_test: checks that all boards of the tree can be read, and that boards without unknown facts
can be built. Their generated files must agree with the chip, with the facts about parts, and with
the pages in docs/boards."""
import argparse
import json
import re
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from unittest import mock

from icesoc import TREE
from icesoc.board import check, firmware, make, model, picture, signals, ucf, wiring
from icesoc.cli import flight
from icesoc.cli.build_folder import BuildFolder
from icesoc.cli.commands.board import PAGES, documents
from icesoc.regs.model import Wrong
from icesoc.util.errors import Stop

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

    def test_only_a_multiplexed_board_needs_a_separate_build(self):
        with tempfile.TemporaryDirectory() as folder:
            make.write(make.for_build(MUXED), folder)
            self.assertEqual(flight.kit(folder), "nucleo-qmtech-muxed")
            self.assertEqual(flight.kit(folder, "my/board.toml"), "my/board.toml")
            self.assertIn("#define BOARD_MUXED 1\n", (Path(folder) / "board_pins.h").read_text())
            make.write(make.for_build(KIT), folder)
            self.assertEqual(flight.kit(folder, "my/board.toml"), "")
            self.assertIn("#define BOARD_MUXED 0\n", (Path(folder) / "board_pins.h").read_text())
        self.assertEqual(flight.kit(""), "")
        with self.assertRaises(Stop):
            flight.kit("no/such/folder")

    def test_a_folder_that_was_configured_for_the_vehicle_is_used(self):
        with tempfile.TemporaryDirectory() as folder:
            build = BuildFolder(folder, argparse.Namespace(jobs=1, built=True))
            Path(folder, "CMakeCache.txt").write_text("BOARD:STRING=other\nBRIDGE:STRING=sync\n")
            for board, bridge in ("", ""), ("other", ""), ("", "sync"), ("other", "sync"):
                self.assertIs(build.for_vehicle(board, bridge), build)
            Path(folder, "CMakeCache.txt").write_text("")
            self.assertIs(build.for_vehicle("nucleo-qmtech", "async"), build)

    def test_a_folder_for_tests_of_cores_is_completed_by_the_next_other_command(self):
        with tempfile.TemporaryDirectory() as folder, mock.patch("icesoc.cli.build_folder.run"), \
                mock.patch.multiple(BuildFolder, configure=mock.DEFAULT, set=mock.DEFAULT) as made:
            build = BuildFolder(folder, argparse.Namespace(jobs=1, built=False))
            build.prepare(core_tests=True)
            made["configure"].assert_called_with("-DCORE_TESTS_ONLY=ON")
            build.prepare()
            made["configure"].assert_called_with()
            made["set"].assert_not_called()  # the folder was complete
            Path(folder, "CMakeCache.txt").write_text("CORE_TESTS_ONLY:BOOL=ON\n")
            build.prepare(core_tests=True)
            made["set"].assert_not_called()
            build.prepare(tests=True)
            made["set"].assert_called_once_with(CORE_TESTS_ONLY="OFF")

    def test_each_pair_of_board_and_bridge_has_its_own_folder(self):
        kit = "boards/nucleo-qmtech-muxed/board.toml"
        with tempfile.TemporaryDirectory() as folder, mock.patch.multiple(
                BuildFolder, configure=mock.DEFAULT, follow=mock.DEFAULT) as made:
            build = BuildFolder(folder, argparse.Namespace(jobs=1, built=True))

            def shows(board, bridge, name, *variables):
                self.assertEqual(str(build.for_vehicle(board, bridge).folder), f"build/{name}")
                self.assertEqual(made["configure"].call_args.args[:-1], variables)

            shows("", "sync", "sync", "-DBRIDGE=sync")
            shows("xynergy", "", "board_xynergy", "-DBRIDGE=async", "-DBOARD=xynergy")
            shows("xynergy", "sync", "board_xynergy_sync", "-DBRIDGE=sync", "-DBOARD=xynergy")
            shows(kit, "async", "board_nucleo-qmtech-muxed", "-DBRIDGE=async",
                  f"-DBOARD={Path(kit).absolute()}")
            # a folder that was configured for another board
            Path(folder, "CMakeCache.txt").write_text("BOARD:STRING=xynergy\n")
            shows("", "sync", "board_xynergy_sync", "-DBRIDGE=sync", "-DBOARD=xynergy")
            shows("nucleo-qmtech", "", "board_nucleo-qmtech", "-DBRIDGE=async",
                  "-DBOARD=nucleo-qmtech")
            # Descriptions in two folders with the same name share a build folder, which is
            # configured for the one that flies.
            for kit in "/a/mine/board.toml", "/b/mine/board.toml":
                build.for_vehicle(kit, "")
                self.assertEqual(made["follow"].call_args.kwargs.get("BOARD"), kit)

    def test_a_recording_names_board_and_bridge(self):
        head = {"flight": {"board": "b"}, "clkHz": 2, "bridge": "sync"}
        with tempfile.TemporaryDirectory() as folder:
            for text, expected in ((json.dumps(head) + '\n{"ns": 0}\n', head), ("[1]\n", {}),
                                   ('{"flight": 1}\n', {}), ("\xff\n", {}), ("", {})):
                Path(folder, "flight.jsonl").write_text(text, encoding="latin-1")
                self.assertEqual(flight.recorded(folder), expected)

    def test_the_build_learns_how_address_and_data_are_connected(self):
        for board, expected in ((KIT, "separate"), (MUXED, "multiplexed")):
            said = subprocess.run([sys.executable, "-m", "icesoc.board.make", board.path],
                                  check=True, text=True, stdout=subprocess.PIPE).stdout
            self.assertEqual(said, expected + "\n")

    def test_only_a_multiplexed_board_constrains_the_edge_of_nadv(self):
        self.assertIn('PERIOD "fsmc_nadv"', ucf.constraints(MUXED))
        self.assertNotIn('"fsmc_nadv"', ucf.constraints(KIT))

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

    def read(self, text, folder="my_board"):
        """Returns the error of a file board.toml, or None."""
        with tempfile.TemporaryDirectory() as parent:
            path = Path(parent) / folder / "board.toml"
            path.parent.mkdir()
            path.write_bytes(text if isinstance(text, bytes) else text.encode())
            try:
                model.read(path)
            except Wrong as error:
                return str(error).replace(f"{path}: ", "")
        return None

    def test_errors_of_a_variant_name_the_place(self):
        for text, expected in VARIANTS.items():
            text = text if text.startswith("base") else 'base = "nucleo-qmtech"\n' + text
            self.assertEqual(self.read(text), expected, text)

    def test_errors_of_a_board_name_the_place(self):
        kit = KIT.path.read_text()
        self.assertIsNone(self.read(kit))
        for old, new, expected in CHANGES:
            self.assertIn(old, kit)
            self.assertEqual(self.read(kit.replace(old, new, 1)), expected, new[:60])

    def test_files_in_other_encodings_are_read_or_refused(self):
        kit = KIT.path.read_text()
        self.assertIsNone(self.read("\ufeff" + kit))  # a byte order mark, as Windows writes it
        self.assertIsNone(self.read(kit.replace("\n", "\r\n")))
        for encoding in ("utf-16", "latin-1"):
            text = kit.replace("QMTECH", "QMT\u00c9CH").encode(encoding)
            self.assertEqual(self.read(text), "expected text in UTF-8", encoding)

    def test_texts_of_a_board_cannot_add_code_to_generated_files(self):
        text = KIT.path.read_text()
        for place in ('title = "', 'to = "jumper', 'source = "', 'notes = [\n    "'):
            self.assertIn(place, text)
            evil = r'<script>alert()</script>)board\"; int x; // '
            text = text.replace(place, place[:place.rindex('"') + 1] + evil, 1)
        with tempfile.TemporaryDirectory() as parent:
            path = Path(parent) / "kit" / "board.toml"
            path.parent.mkdir()
            path.write_text(text)
            board = model.read(path)
            made = {**make.for_build(board), **make.for_bench(board)}
        self.assertNotIn("int x", made["board_wires.inc"] + made["board_pins.h"])
        for name in ("wiring.html", "wiring.svg", "page.md"):
            self.assertNotIn("<script", made[name], name)
            self.assertIn("&lt;script", made[name], name)
        for name in ("openocd.cfg", "board.ucf"):
            for line in made[name].splitlines():
                self.assertTrue("int x" not in line or line.startswith("#"), line)

    def test_the_name_of_the_folder_is_safe_in_generated_files(self):
        expected = ("expected a folder with the name of the board, at most 64 letters, digits, '.',"
                    " '_' and '-', got ")
        for folder in ('my "board"', "a\nb", "\u0428", "a" * 65, "-a"):
            self.assertEqual(self.read(KIT.path.read_text(), folder), f"{expected}'{folder}'")


FILE = "expected the name of a file without its ending: lower-case letters, digits and -, got "
# Text of a board that is derived from the kit -> error.
VARIANTS = {
    "title = 3": "title: expected a text of one line, got 3",
    'title = "a\\n#error"': 'title: expected a text of one line, got "a\\n#error"',
    'nets = [{ name = "D99", fpga = "A5" }]': "nets: unknown name D99; did you mean D9?",
    "nets = 3": "nets: expected a list of tables, got 3",
    'nets = ["A0"]': 'nets[0]: expected a table with name, got "A0"',
    'nets = [{ mcu = "PF0" }]': "nets[0]: missing key 'name'",
    'nets = [{ name = ["A0"] }]':
        'nets[0].name: expected the name of a signal, such as "NWE", got ["A0"]',
    "fpga = 3": "fpga: expected a table with part, got 3",
    "mcu = []": "mcu: expected a table with part, got []",
    "without = 3": "without: expected a list of texts, got 3",
    'without = "A0"': 'without: expected a list of texts, got "A0"',
    "without = [{ a = 1 }]": 'without[0]: expected a text of one line, got {"a": 1}',
    'without = ["A99"]':
        "without: expected a net of nucleo-qmtech, got 'A99'; did you mean A9?",
    'base = "nucleo-qmtec"':
        "base: expected a board of boards/, got 'nucleo-qmtec'; did you mean nucleo-qmtech?",
    'base = "nucleo-qmtech-muxed"':
        "base: expected a board without a base, got 'nucleo-qmtech-muxed'",
    'base = "../nucleo-qmtech"': f'base: {FILE}"../nucleo-qmtech"',
    "base = 3": f"base: {FILE}3",
    f'base = "{"a" * 5000}"': f'base: {FILE}"{"a" * 59}',
}
# Part of the kit's board.toml, its replacement, and the error.
CHANGES = [
    ("hse_hz = 8000000", f"hse_hz = 8{'0' * 5000}", "a number has too many digits"),
    ("hse_hz = 8000000", "hse_hz = 8e6",
     "mcu.hse_hz: expected a frequency in Hz, 1000000 to 200000000, got 8000000.0"),
    ("hse_hz = 8000000", "hse_hz = true",
     "mcu.hse_hz: expected a frequency in Hz, 1000000 to 200000000, got true"),
    ("banks = [3.3", "banks = [nan", "fpga.banks[0]: expected a voltage, 0 to 24, got NaN"),
    ('mcu = "PF0"', 'mcu = "PF\u0660"',
     'nets[0].mcu: expected a pin of the microcontroller, such as "PD14", got "PF\u0660"'),
    ("[modem]", "[fpga]", "Cannot declare ('fpga',) twice (at line 124, column 6)"),
    ("[mcu]", "without = []\n[mcu]", "without: expected only in a board with 'base'"),
    ("[mcu]", "a = " + "[" * 2000 + "]" * 2000 + "\n[mcu]", "brackets are nested too deeply"),
    ('part = "stm32f207zgt6"', 'part = "stm32f407"',
     "mcu.part: expected stm32f207vgt6 or stm32f207zgt6, got 'stm32f407'; did you mean "
     "stm32f207zgt6?"),
    ('part = "xc6slx16-ftg256"', 'part = "stm32f207zgt6"',
     "fpga.part: expected xc6slx16-ftg256, got 'stm32f207zgt6'"),
    ('part = "stm32f207zgt6"', 'part = "../x"', f'mcu.part: {FILE}"../x"'),
    ('module = "nucleo-f207zg"', 'module = "nucleo"',
     "mcu.module: expected nucleo-f207zg or qmtech-xc6slx16-ddr3 or xbee, got 'nucleo'; did you "
     "mean nucleo-f207zg?"),
    ('module = "nucleo-f207zg"', 'module = "xbee"',
     "mcu.module: expected a module with the part stm32f207zgt6, got 'xbee' with xbee"),
]

if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
