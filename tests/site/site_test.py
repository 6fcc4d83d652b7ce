#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""site_test: tests the documentation site: how HDL files are read, links, and errors that stop the
build.

Usage: site_test.py CASE WORK-FOLDER
"""
import os, sys, tempfile, unittest.mock
from pathlib import Path
from types import SimpleNamespace

from icesoc.cli.commands import docs
from icesoc.site import build, doxygen_filter, hdl, reference, symbol
from icesoc.util.browser import Browser
from icesoc.util.errors import Stop
from script import TREE, Script, fresh, main, write

WORK = Path(sys.argv[2])
VERILOG = """// SPDX-License-Identifier: MIT
//
// pair: two registers
// in two clocks.
//
// More about it.

module pair #(
    parameter WIDTH = 8, // bits
    parameter [3:0] KIND = 4'd2
) (
    // writer
    input  wire             a_clk_i,
    input  wire [WIDTH-1:0] data_i, // new value (any)
    // pins
    output reg              led_o
);
endmodule
"""


class Cases(Script):
    def test_missing(self):
        """A missing package is reported by its name, before anything is rendered."""
        sys.modules["furo"] = None  # hides an installed module
        with self.assertRaisesRegex(Stop, "^docs: missing packages: (.*, )?furo(, .*)?; "):
            docs.docs(SimpleNamespace(out=WORK))

    def test_hdl(self):
        """The purpose, parameters, ports, groups and clocks of a module are read from its file."""
        write(fresh(WORK) / "pair.v", VERILOG)
        entity = hdl.read(WORK / "pair.v", TREE)
        self.assertEqual((entity.name, entity.summary, entity.text),
                         ("pair", "two registers in two clocks.", "More about it."))
        self.assertEqual([(p.name, p.default, p.meaning) for p in entity.parameters],
                         [("WIDTH", "8", "bits"), ("KIND", "4'd2", "")])
        self.assertEqual(
            [(p.name, p.direction, p.width, p.clock, p.meaning) for p in entity.ports],
            [("a_clk_i", "input", "", "clock", ""),
             ("data_i", "input", "[WIDTH-1:0]", "a_clk_i", "new value (any)"),
             ("led_o", "output", "", "asynchronous", "")])
        self.assertIn(">data_i [WIDTH-1:0]</text>", symbol.draw(entity))

    def test_every_module(self):
        """In the reference, each module of the platform has a purpose and at least one port."""
        for path in sorted([*TREE.glob("hdl/**/*.v"), *TREE.glob("bus/*.v")]):
            entity = hdl.read(path, TREE)
            if entity and not reference.NOT_HARDWARE.search(path.stem):
                self.assertTrue(entity.summary, path)
                self.assertTrue(entity.ports, path)

    def test_links(self):
        """A link to a page becomes a link to the place of this page in the site; a link to another
        file becomes code."""
        moved = {"docs/bus.md": "bus", "ip/fir/README.md": "reference/cores/fir"}
        text = "[bus](../../docs/bus.md#slots) [code](fir.v) ![p](x.png) [web](https://a.b)"
        self.assertEqual(
            build.relink(text, "ip/fir/README.md", "reference/cores/fir", moved),
            "[bus](../../bus.md#slots) code (`ip/fir/fir.v`) ![p](x.png) [web](https://a.b)")

    def test_comments(self):
        """Plain C comments become Doxygen comments, whether they come before or after the item that
        they describe."""
        text = doxygen_filter.convert(
            "/* Returns it. */\nint f(void);\nint a; /* bytes */\n", "f.h")
        self.assertEqual(text, "/** Returns it. */\nint f(void);\nint a; /**< bytes */\n")
        self.assertEqual(doxygen_filter.convert("typedef BUFFERS(1, 2) All;\n", "f.h"),
                         "typedef struct All All;\n")

    def test_browser(self):
        """A browser that a test has started leaves no files behind."""
        with tempfile.TemporaryDirectory() as folder, \
                unittest.mock.patch.object(tempfile, "tempdir", folder), \
                unittest.mock.patch.dict(os.environ, {"TMPDIR": folder}):
            with Browser() as browser:
                browser.open("about:blank")
            self.assertEqual(os.listdir(folder), [])

    def test_broken_link(self):
        """A browser can read the site from files, without a server: its scripts run, and the reader
        can select light or dark. A link to a page that does not exist fails the build, and the
        error names the link."""
        tree = fresh(WORK) / "tree"
        for part in ("docs/conf.py", "docs/_static/site.css", "sw/fsmc/fsmc.h",
                     "synth/baseline.json", "synth/ise/chip.ucf"):
            write(tree / part, (TREE / part).read_text())
        write(tree / "docs/index.md", "# Site\n\n```{toctree}\n:glob:\n*\nreference/**\n```\n")
        write(tree / "docs/bus.md", "# Bus\n\n[site](index.md)\n")
        build.build(tree, WORK / "site", {"run": "help"})
        with Browser(width=1400, height=1000) as browser:
            browser.open((WORK / "site/html/bus.html").absolute().as_uri())
            browser.until("document.querySelector('.theme-toggle') !== null")
            before = browser.run("document.body.dataset.theme")
            browser.run("document.querySelector('.theme-toggle').click()")
            self.assertNotEqual(browser.run("document.body.dataset.theme"), before)
            self.assertEqual(browser.errors, [])
        write(tree / "docs/bus.md", "# Bus\n\n[lost](no_such_page.md)\n")
        with self.assertRaisesRegex(Stop, "no_such_page.md"):
            build.build(tree, WORK / "site", {"run": "help"})


main(Cases)
