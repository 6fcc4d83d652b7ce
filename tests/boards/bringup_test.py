# SPDX-License-Identifier: MIT
"""bringup_test: checks that `./icesoc board bringup` reads the output of the self-test, even if
the output is damaged or ends too early, and writes the report as JSON and as a page."""
import html.parser
import json
import os
import sys
import tempfile
import threading
import types
import unittest
from pathlib import Path
from unittest import mock

from icesoc.board import bringup, model
from icesoc.cli.commands import bringup as command
from icesoc.util.errors import Stop

KIT = model.find("nucleo-qmtech")
GOOD = """BOARD nucleo-qmtech
STEP supply: the microcontroller runs from its crystal at 120 MHz
PASS supply: 120 MHz
INFO read path ns: 11.0 to 12.6
END 0
"""
BAD = """BOARD nucleo-qmtech
STEP wires: each line carries its number
FAIL wires D3 open: driven, and the FPGA's pin does not follow; check: the wire
FAIL wires D1-D2 short: one follows the other; check: a solder bridge
NEXT load the chip's bitstream
END 2
"""


def report_of(text):
    report = bringup.Report(KIT)
    for line in text.splitlines(True):
        report.take(line)
    return report


class Page(html.parser.HTMLParser):
    """Collects the texts and tags of a page, and checks that tags are closed in the correct
    order."""
    EMPTY = {"meta", "br"}

    def __init__(self, text):
        super().__init__()
        self.open, self.tags, self.text = [], [], ""
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        if tag not in self.EMPTY:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag, tag

    def handle_data(self, data):
        self.text += data


class Reports(unittest.TestCase):
    def test_a_good_board_passes(self):
        report = report_of(GOOD)
        self.assertEqual(report.data["result"], "passed")
        self.assertEqual(report.steps[0]["figures"], "120 MHz")
        self.assertEqual(report.steps[0]["notes"], ["read path ns: 11.0 to 12.6"])

    def test_a_failure_has_the_places_of_each_wire(self):
        report = report_of(BAD)
        self.assertEqual(report.data["result"], "failed")
        self.assertEqual([f["wire"] for f in report.failures], ["D3", "D1-D2"])
        self.assertEqual(report.failures[0]["places"],
                         ["D3: microcontroller PD1 (CN11 pin 55), FPGA B16 (U7 pin 8)"])
        self.assertEqual(len(report.failures[1]["places"]), 2)
        self.assertEqual(report.data["next"], "load the chip's bitstream")

    def test_a_report_that_ends_too_early_is_stopped(self):
        for text in ("", GOOD.partition("END")[0], "STEP wires: each"):
            self.assertEqual(report_of(text).data["result"], "stopped", text)

    def test_damaged_lines_are_kept_and_do_no_harm(self):
        for line in ("FAIL", "FAIL wires", "FAIL wires D3", "PASS", "STEP", "END", "END x",
                     "\0\xff\x1b[2J", "FAIL wires D99-QQ open: a; check: b", "INFO", "NEXT"):
            report = report_of("INFO early\nSTEP wires: all\n" + line + "\n")
            self.assertNotEqual(report.data["result"], "passed", line)
            self.assertIn(line, report.log)
            Page(bringup.page(report))

    def test_files_are_json_and_a_page_in_which_nothing_is_markup(self):
        report = report_of(BAD.replace("one follows", "<script>alert(1)</script>"))
        report.data["modem"] = KIT.modem
        with tempfile.TemporaryDirectory() as folder:
            pretty, data = bringup.write(report, Path(folder) / "new")
            found = json.loads(data.read_text())
            page = Page(pretty.read_text())
        self.assertEqual(found["modem"], "xb3")
        self.assertEqual(found["steps"][0]["failures"][0]["kind"], "open")
        self.assertEqual(found["console"], BAD.replace(
            "one follows", "<script>alert(1)</script>").splitlines())
        self.assertNotIn("script", page.tags)
        self.assertEqual(page.open, [])
        for text in ("D3 open", "CN11 pin 55", "check: the wire", "Modem: xb3"):
            self.assertIn(text, page.text)


class Listening(unittest.TestCase):
    def listen(self, text, silence=5.0, closes=False):
        """Writes a text to a pseudo-terminal, and returns the report about the text that
        arrived."""
        ours, theirs = os.openpty()
        command.set_rate(theirs)
        report = bringup.Report(KIT)
        with mock.patch.object(command, "say"):
            os.write(ours, text)
            closer = threading.Timer(0.1, os.close, [ours])
            if closes:
                closer.start()
            command.listen(theirs, silence, report)
            closer.join() if closes else os.close(ours)
        os.close(theirs)
        return report

    def test_ends_at_the_line_end(self):
        self.assertEqual(self.listen(BAD.encode() + b"more\n").data["result"], "failed")

    def test_ends_after_silence_and_when_the_adapter_is_unplugged(self):
        self.assertEqual(self.listen(b"STEP supply: x\nPAS", silence=0.2).data["result"],
                         "stopped")
        self.assertEqual(self.listen(b"STEP supply: x\n", closes=True).data["result"], "stopped")

    def test_bytes_that_are_no_text_are_kept(self):
        report = self.listen(b"\xff\x00\x80garbage\n" + GOOD.encode())
        self.assertEqual(report.data["result"], "passed")
        self.assertIn("garbage", report.log[0])


class Programs(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.report = bringup.Report(KIT)
        said = mock.patch.object(command, "say")
        said.start()
        self.addCleanup(said.stop)

    def programs(self, **scripts):
        """Creates programs in a folder, which is the only folder in PATH."""
        for name, text in scripts.items():
            path = self.folder / name
            path.write_text("#!/bin/sh\n" + text)
            path.chmod(0o755)
        path = mock.patch.dict(os.environ, PATH=str(self.folder))
        path.start()
        self.addCleanup(path.stop)

    def build(self):
        build = mock.MagicMock()
        build.__truediv__ = lambda _, name: self.folder / name
        return build

    def test_a_console_that_does_not_exist_is_named(self):
        values = types.SimpleNamespace(device=str(self.folder / "tty"), listen=False, silence=1)
        with self.assertRaisesRegex(Stop, "cannot open the console .*tty: No such file"):
            command.on_board(values, self.build(), self.report, self.folder)

    def test_openocd_that_is_missing_or_fails_is_named(self):
        (self.folder / "tty").touch()
        values = types.SimpleNamespace(device=str(self.folder / "tty"), listen=False, silence=1)
        self.programs()
        with self.assertRaisesRegex(Stop, "expected the program openocd, got none in PATH"):
            command.on_board(values, self.build(), self.report, self.folder)
        self.programs(openocd="exit 3")
        with self.assertRaisesRegex(Stop, "OpenOCD failed .above.; start the self-test"):
            command.on_board(values, self.build(), self.report, self.folder)

    def call(self, **scripts):
        """Runs the last step of the bring-up with programs that replace OpenOCD, the program that
        sets the key, and the call."""
        keys = self.folder / "sw/ground/clients/provide_key.py"
        keys.parent.mkdir(parents=True)
        self.programs(**{"openocd": "exit 0", "icesoc": "exit 0", "key": "exit 0", **scripts})
        (self.folder / "key").rename(keys)
        values = types.SimpleNamespace(device="/dev/c", cable="/dev/x")
        with mock.patch.multiple(command, TREE=self.folder, BREAK_SECONDS=0, LOAD_TIMEOUT=2):
            command.over_cable(values, self.build(), self.report, self.folder)

    def test_the_call_over_a_cable_is_a_step_of_the_report(self):
        self.call(key='test "$*" = "--port /dev/c --open"',
                  icesoc='test "$*" = "call --device /dev/x --wire --timeout 30 '
                         'hwengine1.ice_ping"')
        self.assertEqual(self.report.data["result"], "passed", self.report.log)
        self.assertEqual(self.report.steps[0]["name"], "call")

    def test_each_part_of_the_call_that_fails_is_named(self):
        self.call(openocd="exit 3")
        self.assertEqual(self.report.failures[0]["wire"], "MCU")
        self.assertIn("openocd ended with status 3", self.report.failures[0]["seen"])

    def test_a_console_without_an_answer_is_named(self):
        self.call(key="exit 1")
        self.assertEqual(self.report.failures[0]["wire"], "CONSOLE_TX-CONSOLE_RX")

    def test_a_call_without_an_answer_names_the_lines(self):
        self.call(icesoc="exit 1")
        self.assertEqual(self.report.data["result"], "failed")
        self.assertEqual(self.report.failures[0]["wire"], "MODEM_TXD-MODEM_RXD")
        self.assertIn("JUMPER_WIRED", self.report.failures[0]["check"])

    def test_a_program_that_hangs_is_ended(self):
        self.call(openocd="exec /bin/sleep 20")
        self.assertIn("openocd did not end within 2 s", self.report.failures[0]["seen"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
