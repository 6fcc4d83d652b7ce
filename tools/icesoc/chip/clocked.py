# SPDX-License-Identifier: MIT
"""clocked: generates NAME_clocked.v, which connects a core with a separate clock to its slot
through bus_crossing.v.

    python -m icesoc.chip.clocked core.toml NAME.regs.json NAME_clocked.v
"""
import sys

from icesoc.chip import manifest
from icesoc.chip.core_output import render
from icesoc.regs.generate import save
from icesoc.regs.model import Wrong, check
from icesoc.util.errors import reason_of


def clocked(block, has_clk_hz):
    """Returns the Verilog of a module that has the ports of a slot and contains a block with a
    separate clock."""
    check(not block.description.get("memory_port"),
          "a core with a memory port uses the chip clock, as the port does; for a part of the core "
          "with a separate clock use hdl/cdc/async_fifo.v, as ip/camera does")
    return render("clocked.v.j2", b=block, has_clk_hz=has_clk_hz,
                  pins=block.description.get("pins", []))


def main():
    file, registers, output = sys.argv[1:]
    try:
        core = manifest.read(file)
        save(output, clocked(manifest.block_of(core, registers), core.facts.get("clk_hz", False)))
    except (Wrong, OSError) as e:
        sys.exit(f"{file}: error: {reason_of(e)}")


if __name__ == "__main__":
    main()
