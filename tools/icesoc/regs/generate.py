# SPDX-License-Identifier: MIT
"""generate: writes the files that hardware and software use to access the registers of a block.

<block>_regs.vh (Verilog localparams), <block>_regs.h (C90 macros), <block>_regs_pkg.vhd (VHDL
package) and <block>_regs.md (page for people). With --block, also writes the register block itself:
<block>_regs.v with its proof, and <block>_regs.vhd.
"""
import argparse
import functools
import re
import sys
from pathlib import Path

from icesoc.regs import names, verilog, vhdl
from icesoc.regs.model import ACCESSES, Block, Wrong, check
from icesoc.util import templates
from icesoc.util.errors import reason_of

FILES = {"regs.vh.j2": "{}_regs.vh", "regs.h.j2": "{}_regs.h", "regs_pkg.vhd.j2": "{}_regs_pkg.vhd",
         "regs.md.j2": "{}_regs.md"}
BLOCK_FILES = {"regs.v.j2": "{}_regs.v", "regs_proof.vh.j2": "{}_regs_proof.vh",
               "regs.vhd.j2": "{}_regs.vhd"}


def table_rows(b):
    """Returns the registers and their fields as initialisers of Hw_Register."""
    rows = []
    for r in b.registers:
        parts = [(r.name, 0, r.width, r.access)]
        parts += [(f"{r.name}.{f.name}", f.lsb, f.width, f.access) for f in r.fields]
        rows += [f'{{{{{len(name)}, "{name}"}}, Hw_{access}, {r.word}, {lsb}, {width}, {r.page}}}'
                 for name, lsb, width, access in parts]
    return rows


def cell(text):
    """Returns a text that is escaped for a cell of a Markdown table."""
    return re.sub(r"([\\|*`<\[])", r"\\\1", text)


@functools.cache
def environment():
    """Returns Jinja's environment."""
    return templates.environment(Path(__file__).with_name("templates"), **verilog.GLOBALS,
                                 **vhdl.GLOBALS, table_rows=table_rows, cell=cell,
                                 accesses=ACCESSES)


def render(template, **values):
    return environment().get_template(template).render(**values)


def markdown(block):
    """Returns the documentation page of a register block."""
    return render("regs.md.j2", b=block)


def views(block, has_block):
    """Returns the files of a block as {name: text}."""
    files = dict(FILES)
    if has_block:
        check(block.has_register_block,
              "register block: expected a slot (type, version), and registers without pages")
        try:
            names.check_ports(block)
        except names.Collision as e:
            raise Wrong(str(e)) from None
        files |= BLOCK_FILES
    return {name.format(block.name): render(template, b=block) for template, name in files.items()}


def save(path, text):
    """Writes a text. If the file already has this text, its time is not changed, so that the build
    does not repeat later steps."""
    path = Path(path)
    if not path.is_file() or path.read_bytes() != text.encode():
        path.write_bytes(text.encode())


def main():
    parser = argparse.ArgumentParser(
        prog="regs", description="Generates the Verilog, C, VHDL and Markdown views of a block's "
                                 "registers.")
    parser.add_argument("descriptions", nargs="+", metavar="description",
                        help="register description, *.regs.json")
    parser.add_argument("--output-dir", default=".", help="folder of the files (default .)")
    parser.add_argument("--block", action="store_true",
                        help="also the register block in Verilog and VHDL, and its proof")
    args = parser.parse_args()
    if not Path(args.output_dir).is_dir():
        sys.exit(f"regs: --output-dir: expected a folder, got '{args.output_dir}'; create it first")
    for description in args.descriptions:
        try:
            block = Block.read(description)
            for name, text in views(block, args.block).items():
                save(Path(args.output_dir) / name, text)
        except (Wrong, OSError) as e:
            sys.exit(f"{description}: error: {reason_of(e)}")


if __name__ == "__main__":
    main()
