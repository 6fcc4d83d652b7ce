#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""page_test: the regression tool's page, in Chromium. Usage: page_test.py page work build-folder"""
import json
import re
from pathlib import Path

from project import BUILD, TREE, Project, main, write
import look

VCD = """$timescale 1ns $end
$scope module top $end $var wire 1 ! clk_i $end
$scope module u_fifo $end $var wire 1 ! clk_i $end
$var reg 8 " level [7:0] $end $var reg 8 & mask [7:0] $end $upscope $end $upscope $end
$scope module program $end $var string 1 p.task task $end $upscope $end $enddefinitions $end
#0 0! b0 " b1010 & sUAV_radioTask p.task #5 1! #10 0! b10100111 " #15 1!
"""
FIFO = {"file": "hdl/fifo/fifo.v", "percent": 97, "lines": 200, "gate": 95, "toggles": 96,
        "toggle_points": 9, "toggle_gate": 95, "why": "", "missed": ["12: level_o[3]", "40"]}


class Cases(Project):
    def browse(self, page):
        self.said = look.browse(Path(page).resolve().as_uri())[0]

    def test_page(self):
        write("t.vcd", VCD)
        self.tests("""add_test(NAME formal.broken COMMAND sh -c "echo 'Assert failed in broken'
    echo 'broken: trace: ${CMAKE_SOURCE_DIR}/t.vcd'; exit 1")
""")
        write("build/coverage/summary.json",
              json.dumps({"total": 97, "toggles": 95, "files": [FIFO]}))
        self.regress("", 1)
        written = "build/regress/report.html"
        page = Path(written).read_text()
        self.lacks('src="http|href="http', written)  # offline
        # If the libraries could not be fetched, the page is complete and says how to get them.
        write("plain.html", re.sub("(?m)^(!function.*Tabulator=|.*var uPlot=).*\n", "", page))
        self.browse("plain.html")
        self.has("Tabulator and uPlot could not be fetched. With a network",
                 "<td>test_c.Flicker</td>", 'class="dot dp"')
        if not (BUILD / "page/libraries.js").stat().st_size:
            self.skipTest("Tabulator and uPlot could not be fetched")
        clicks = Path(__file__).with_name("clicks.js").read_text()
        write("clicked.html", page.replace("</body>", f"<script>\n{clicks}</script></body>"))
        self.browse("clicked.html")
        self.has(
            "seen: sorted test_d.Crash test_c.Flicker test_b.Bad test_a.Two test_a.One "
            "formal.thing formal.broken;", "filtered test_c.Flicker;",
            'csv "test",.* / "test_c.Flicker","passed",',
            "of 2000 some; largest b &lt;a&gt;; picked b; open b c &lt;a&gt;; at .*c.*; folded b "
            "&lt;a&gt;; canvas true true; read iii no. 2 2; moved i no. 0 2;",
            "3 failed", 'class="waveform"',
            ">top.clk_i<",  # the outermost of its names
            ">top.u_fifo.level<", ">a7<", ">UAV_radioTask<",
            ">top.u_fifo.mask<",  # it stays constant
            'id="results"', "test_c.Flicker",
            'id="runs".*>one<',  # the commit's subject
            "<div>test_b.Bad: value 1 is not 7", 'class="dot dp"', "12 clauses with 3 flops",
            r'<a href="../../hdl/fifo/fifo.v">hdl/fifo/fifo.v:12: level_o\[3\]</a><br>'
            '<a href="../../hdl/fifo/fifo.v">hdl/fifo/fifo.v:40</a>', 'id="seeds"',
            'at <a href="../../x.cpp">x.cpp:12</a>; '
            'log <a href="failures/test_b.Bad-1.log"',
            'to have passed: <a href="../../tests/room/CMakeLists.txt">'
            r"tests/room/CMakeLists.txt:8</a> \(2 lines\)")
        write("tests/plan.toml", '[a]\n"It works" = "test_a.One"\n"It waits" = "test_c.*"\n')
        write("tests/room/other", "new\n")
        self.regress("--name a.One")
        self.browse(written)
        self.has("Requirements: 1 of 1 that were tested proven", ">It works<",
                 "<summary>1 whose tests did not run with these sources</summary>")
        self.lacks(">It waits<")
        self.assertEqual(look.fault(written), "")
        write("wrong.html", page.replace("of data.lights", "of data.lihgts"))
        self.assertRegex(look.fault("wrong.html"), "^wrong.html:[0-9]*: Uncaught TypeError: "
                         "data.lihgts is not iterable: for [(]const light")
        self.ask("env", "ICESOC_TREE=.", TREE / "icesoc", "build", "pictures", "--from", "build",
                 "--to", ".", "regression")
        picture = Path("regression.png").read_bytes()
        self.assertEqual(picture[1:4], b"PNG")
        self.assertLess(len(picture), 100000)


main(Cases)
