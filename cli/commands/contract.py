# SPDX-License-Identifier: MIT
"""contract: what crosses hardware and software, the registers of blocks."""
from cli.build_folder import configured
from cli.command import GROUPS, command
from cli.options import BUILD, FILE, FOLDER, JOBS, TEXT, Option
from cli.runner import run

GROUPS["contract"] = "registers of cores"


@command("contract diff",
         [Option("base", TEXT, "the commit to compare with", "", positional=True), BUILD, JOBS],
         make="contract-diff", brief="contract diff HEAD", examples=["contract diff main"])
def contract_diff(values):
    """what changed in the cores' registers since a commit; exit status 1: software of then would
    break"""
    build = configured(values, "slice2c")
    return run(["bus/contract_diff.py", build / "slice/slice2c", ".", values.base], check=False)


@command("contract from-rdl", [Option("rdl", FILE, "the SystemRDL file", "", positional=True),
                               Option("out", FOLDER, "folder that they are written to", "")],
         make="from-rdl", brief="contract from-rdl build/main/gen/icesoc.rdl --out build/brief/rdl",
         examples=["contract from-rdl spi.rdl --out ip/spi"])
def from_rdl(values):
    """register descriptions (*.regs.json) of SystemRDL"""
    return run(["bus/rdl.py", values.rdl, values.out], check=False)
