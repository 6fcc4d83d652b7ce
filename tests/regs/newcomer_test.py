# SPDX-License-Identifier: MIT
"""newcomer_test: checks that one line in a register description is enough for a new register.

A line is added to ip/camera/camera.regs.json. The register is then in the Verilog (where it can be
written and read), VHDL, C, the page, the reference, SVD, SystemRDL and IP-XACT.
"""
import re
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ET
from pathlib import Path

from icesoc import TREE
from icesoc.regs.generate import markdown
from icesoc.regs.model import Block
from icesoc.web import mission

LINE = ('    {"word": 11, "name": "EXPOSURE", "access": "rw", "width": 12, "reset": "0x7", '
        '"doc": "lines of exposure"},\n')
BENCH = """\
`default_nettype none
module bench;
    reg clk = 0, rst = 1, valid = 0, write = 0;
    wire ready, error, irq;
    wire [11:0] exposure;
    wire [31:0] rdata;
    camera_regs dut (
        .clk_i(clk), .rst_i(rst), .bus_valid_i(valid), .bus_write_i(write), .bus_addr_i(4'd11),
        .bus_wdata_i(32'hFFFFF5A5), .bus_ready_o(ready), .bus_rdata_o(rdata), .bus_error_o(error),
        .irq_o(irq), .exposure_o(exposure));
    always #1 clk = !clk;
    initial begin
        #4 rst = 0; #1 $display("%0d", exposure);
        valid = 1; write = 1; #2 write = 0; #2 $display("%h %h %b", exposure, rdata, error);
        $finish;
    end
endmodule
"""


class Newcomer(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.out = Path(folder.name)
        self.description = self.out / "camera.regs.json"
        text = (TREE / "ip/camera/camera.regs.json").read_text()
        before = re.search(r'^ *\{"word": 10, ', text, re.M).start()
        self.description.write_text(text[:before] + LINE + text[before:])

    def run_tool(self, module, *words):
        run = subprocess.run([TREE / "tools/python", "-m", module, *words], capture_output=True,
                             text=True, check=False)
        self.assertEqual(run.returncode, 0, run.stderr)

    def has(self, name, *patterns):
        text = (self.out / name).read_text()
        for pattern in patterns:
            self.assertRegex(text, re.compile(pattern, re.M), name)

    def test_a_register_is_one_line(self):
        self.run_tool("icesoc.regs.generate", self.description, "--block", "--output-dir", self.out)
        self.has("camera_regs.vh", r"CAMERA_EXPOSURE = 4'd11;.*lines of exposure")
        self.has("camera_regs.h", r"^#define CAMERA_EXPOSURE 11U ",
                 r'"EXPOSURE"\}, Hw_rw, 11, 0, 12')
        self.has("camera_regs_pkg.vhd", r"constant CAMERA_EXPOSURE : natural := 11;")
        self.has("camera_regs.vhd", r"exposure_o *: out std_logic_vector\(11 downto 0\)")
        self.has("camera_regs.md",
                 r"^\| 11 \| \*\*EXPOSURE\*\* \| rw \| 11..0 \| lines of exposure")
        block = Block.read(self.description)
        self.assertIn("**EXPOSURE**", markdown(block))
        shown = mission.register(block, 11, 5, mission.WRITTEN)
        self.assertEqual((shown["name"], shown["doc"]), ("EXPOSURE", "lines of exposure"))
        # In the hardware, the register can be reset, written and read.
        bench = self.out / "bench.v"
        bench.write_text(BENCH)
        includes = [f"-I{TREE / 'bus'}", f"-I{self.out}"]
        subprocess.run(["iverilog", "-g2005", "-o", self.out / "bench", *includes, bench,
                        self.out / "camera_regs.v"], check=True)
        said = subprocess.run(["vvp", "-n", self.out / "bench"], capture_output=True, text=True,
                              check=True).stdout
        self.assertEqual(said.split("\n")[:2], ["7", "5a5 000005a5 0"])

    def test_other_tools_see_it(self):
        cores = self.out / "cores.list"
        cores.write_text("camera\n")
        self.run_tool("icesoc.chip.coremap", cores, "--base", TREE / "bus/map.regs.json",
                      f"--core=camera={TREE}/ip/camera/core.toml={self.description}",
                      "--output-dir", self.out)
        device = ET.parse(self.out / "icesoc.svd")
        register = device.find(".//register[name='EXPOSURE']")
        self.assertEqual(register.findtext("addressOffset"), "0x2C")
        self.assertEqual(register.findtext("access"), "read-write")
        self.has("icesoc.rdl", r"WORD\[11:0\] = 0x7;\n *\} EXPOSURE @ 0x2C;")
        self.has("icesoc.ipxact.xml", "<ipxact:name>EXPOSURE</ipxact:name>")


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
