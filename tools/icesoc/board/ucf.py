# SPDX-License-Identifier: MIT
"""ucf: generates the constraints of a board for ngdbuild: pin locations, supplies, pulls, and the
clock of the FPGA.

synth/ise/chip.ucf has the constraints that all boards share: FSMC timing, clock domain crossings,
I/O standards."""
from icesoc.board.check import multiplier
from icesoc.board.model import Board

# With a multiplexed address, NADV's rising edge stores the address, which the data pins carry from
# 8 ns before this edge to 14 ns after it (HCLK 120 MHz, ADDSET 2, ADDHLD 2, and the delays in
# testbench/fsmc/pin_delays.h). The groups soc_clk and fsmc_nwe are defined in synth/ise/chip.ucf.
MUXED = """
# The address on the data pins, stored when NADV rises.
NET "fsmc_nadv_n_i" TNM_NET = "fsmc_nadv";
TIMESPEC "TS_fsmc_nadv" = PERIOD "fsmc_nadv" 33 ns HIGH 50%;
TIMEGRP "fsmc_stored" = PADS("fsmc_d_io<*>" : "fsmc_ne_n_i<*>");
TIMEGRP "fsmc_stored" OFFSET = IN 8 ns VALID 22 ns BEFORE "fsmc_nadv_n_i" RISING;
TIMESPEC "TS_nadv_to_clk" = FROM "fsmc_nadv" TO "soc_clk" 10 ns DATAPATHONLY;
TIMESPEC "TS_nadv_to_nwe" = FROM "fsmc_nadv" TO "fsmc_nwe" 10 ns DATAPATHONLY;"""
PULLS = {"up": "PULLUP", "down": "PULLDOWN"}


def head(board: Board):
    """Yields the comment with the settings of MIG's core for this board."""
    fpga = board.facts["fpga"]
    clock = fpga["clock_hz"]
    yield "# SPDX-License-Identifier: MIT"
    yield "#"
    yield f"# Generated from boards/{board.name}/board.toml: do not edit. {board.facts['title']}."
    yield "#"
    yield f"# MIG's core `mig`: clock {clock / 1e6:g} MHz, C3_CLKFBOUT_MULT = {multiplier(clock)},"
    yield f"# C3_RST_ACT_LOW = {int(fpga.get('reset_low', False))}, memory clock 300 MHz (DDR3-600,"
    yield "# 3333 ps), user clock C3_CLKOUT2_DIVIDE = 6 (100 MHz)."
    if board.ddr:
        yield f"# Memory: {board.ddr['part']} at bank {board.ddr['bank']}; its places come with"
        yield f"# MIG's file. chip.v's parameter ROWS is {board.ddr['rows']}."


def constraints(board: Board):
    """Returns the text of the board's UCF."""
    fpga = board.facts["fpga"]
    lines = [*head(board), f"CONFIG VCCAUX = {fpga.get('vccaux', 3.3):g};"]
    clock = board.net("CLOCK")
    if clock:
        lines += ["", "# The oscillator.",
                  'NET "sys_clk_i" TNM_NET = "sys_clk";',
                  f'TIMESPEC "TS_sys_clk" = PERIOD "sys_clk" {1e9 / fpga["clock_hz"]:g} ns '
                  'HIGH 50%;']
    if board.muxed:
        lines.append(MUXED)
    bank = None
    known = board.parts["fpga"]
    placed = [net for net in board.nets if net.get("fpga") and net.signal.port]
    for net in sorted(placed, key=lambda n: known[n.get("fpga")].bank):
        ball = known[net.get("fpga")]
        if ball.bank != bank:
            bank = ball.bank
            lines += ["", f"# Bank {bank}: {board.banks[bank]:g} V."]
        pull = f" | {PULLS[net.get('pull')]}" if net.get("pull") else ""
        lines.append(f'NET "{net.signal.port}" LOC = "{ball.name}"{pull};')
    return "\n".join(lines) + "\n"
