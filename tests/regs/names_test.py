# SPDX-License-Identifier: MIT
"""names_test: checks that names that collide in a generated file, or that a language does not
allow, are rejected before anything is written. The message must contain both names. Texts must not
be able to end a comment."""
import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from icesoc import TREE
from icesoc.regs import generate


def register(name, word=3, **more):
    return {"word": word, "name": name, "access": "rw", "doc": "", **more}


def one(name):
    return {"name": name, "lsb": 4, "width": 1, "doc": ""}


class Names(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.work = Path(folder.name)

    def generate(self, *registers, block="pair", doc="", **more):
        description = {"block": block, "doc": doc, "type": "0x5041", "version": "0x0100",
                       "registers": registers, **more}
        file = self.work / "pair.regs.json"
        file.write_text(json.dumps(description))
        sys.argv = ["regs", str(file), "--block", "--output-dir", str(self.work)]
        try:
            generate.main()
        except SystemExit as end:
            return 1, str(end)
        return 0, ""

    def test_a_missing_file_or_folder_is_named_without_a_number(self):
        status, said = self.generate()
        self.assertEqual(status, 0, said)
        for words, text in (
                (["none.regs.json"], "none.regs.json: error: No such file or directory"),
                ([str(self.work / "pair.regs.json"), "--output-dir", "none"],
                 "regs: --output-dir: expected a folder, got 'none'; create it first")):
            sys.argv = ["regs", *words]
            with self.assertRaises(SystemExit) as end:
                generate.main()
            self.assertEqual(str(end.exception), text)

    def refused(self, words, *registers, **more):
        status, said = self.generate(*registers, **more)
        self.assertEqual(status, 1, (words, said))
        for word in words:
            self.assertIn(word, said)
        self.assertEqual([p.name for p in self.work.iterdir()], ["pair.regs.json"])

    def test_two_names_that_become_one(self):
        fields = {"fields": [one("DONE")]}
        self.refused(["TABLE"], register("TABLE"))
        self.refused(["TX.DONE", "TX_DONE_MASK"], register("TX", **fields),
                     register("TX_DONE_MASK", 4))
        self.refused(["TX.DONE", "TX_DONE_WIDTH"], register("TX", **fields),
                     register("TX_DONE_WIDTH", 4))
        self.refused(["TX.DONE", "TX_DONE_LSB"], register("TX_DONE_LSB"),
                     register("TX", 4, **fields))
        self.refused(["A_B.C", "A.B_C"], register("A_B", fields=[one("C")]),
                     register("A", 4, fields=[one("B_C")]))
        self.refused(["Mode", "MODE"], register("Mode"), register("MODE", 4))
        self.refused(["A.on", "A.ON"], register("A", fields=[
            one("on"), {"name": "ON", "lsb": 0, "width": 1, "doc": ""}]))
        self.refused(["ID_VALUE"], register("ID_VALUE"))
        self.refused(["EVENT.GO", "EVENT_GO_MASK"], register("EVENT_GO_MASK"),
                     events=[{"name": "GO", "bit": 0, "doc": ""}])
        self.refused(["LIMIT: duplicate"], register("LIMIT"),
                     constants=[{"name": "LIMIT", "value": 1, "doc": ""}])
        self.refused(["EVENT: duplicate"], register("EVENT"))

    def test_pages(self):
        paged = register("BANK", 8, page=32)
        status, said = self.generate(paged, register("BANK_PAGE", 9, page=32))
        self.assertEqual(status, 1)
        self.assertIn("BANK", said)
        self.assertIn("BANK_PAGE", said)

    def test_ports_of_the_register_block(self):
        self.refused(["event GO", "GO_EVENT"], register("GO_EVENT", access="ro"),
                     events=[{"name": "GO", "bit": 0, "doc": ""}])
        self.refused(["clk_i", "CLK"], register("CLK", access="ro"))
        self.refused(["irq_o", "IRQ"], register("IRQ"))
        self.refused(["A.B", "A_B"], register("A", fields=[one("B"), {
            "name": "C", "lsb": 0, "width": 1, "doc": ""}]), register("A_B", 4))

    def test_names_that_vhdl_does_not_take(self):
        for name in ("A__B", "C_", "_D", "1E", "F G", "\u00c4"):
            self.refused(["expected a name"], register(name))
            self.refused(["expected a name"], register("A", fields=[one(name)]))
            self.refused(["expected a name"], block=name)

    def test_names_of_c(self):
        self.refused(["INT_MAX"], register("MAX"), block="int")
        self.refused(["EXIT_SUCCESS"], register("SUCCESS"), block="exit")
        self.refused(["HW", "reserved by the project"], register("A"), block="HW")

    def test_keywords_and_texts(self):
        """Keywords of each language as names, and texts that end a comment or contain a command."""
        texts = ["ends in a backslash \\", "a /* comment", "a trigraph ??/", "verilator lint_off X",
                 "synthesis translate_off", "a | b **c** `d` <e>", "// x", "-- y",
                 "gr\u00f6\u00dfer"]
        words = ["signal", "reg", "wire", "entity", "int", "module", "register", "logic", "type",
                 "string"]
        registers = [register(word, n + 3, doc=text, fields=[
            {"name": word, "lsb": 0, "width": 3, "doc": text},
            {"name": words[n - 1], "lsb": 5, "width": 1, "doc": text}])
            for n, (word, text) in enumerate(zip(words, texts))]
        status, said = self.generate(*registers, doc="a text\\", constants=[
            {"name": f"C{n}", "value": n, "doc": text} for n, text in enumerate(texts)])
        self.assertEqual((status, said), (0, ""))
        for command in (["verilator", "--lint-only", "-Wall", f"-I{TREE / 'bus'}", "pair_regs.v"],
                        ["iverilog", "-g2005", f"-I{TREE / 'bus'}", "-t", "null", "pair_regs.v"],
                        ["yosys", "-q", "-p", f"read_verilog -I{TREE / 'bus'} pair_regs.v; proc"]):
            run = subprocess.run([*command, f"-I{self.work}"] if command[0] != "yosys" else command,
                                 cwd=self.work, capture_output=True, text=True, check=False)
            self.assertEqual((run.returncode, run.stderr), (0, ""), command)
        (self.work / "pair.c").write_text('#include "pair_regs.h"\nint main(void) { return 0; }\n')
        run = subprocess.run(["gcc", "-std=c90", "-pedantic", "-Wall", "-Wextra", "-Werror",
                              "-fsyntax-only", "pair.c"], cwd=self.work, capture_output=True,
                             text=True, check=False)
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        ghdl = TREE / "build/main/ghdl/ghdl"
        if ghdl.exists():
            run = subprocess.run([ghdl, "-a", "--std=08", "pair_regs_pkg.vhd", "pair_regs.vhd"],
                                 cwd=self.work, capture_output=True, text=True, check=False)
            self.assertEqual((run.returncode, run.stdout + run.stderr), (0, ""))

    def test_a_text_cannot_end_a_comment(self):
        self.refused(["expected a text"], register("A", doc="x */ y"))
        self.refused(["expected a text"], register("A", doc="two\nlines"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:])
