// SPDX-License-Identifier: MIT
//
// soc: the chip: wiring, and its reset's flip-flop. Its cores are the lines of ip/cores.list; slots,
// memory ports and the cores' pins are numbered in the generated map_regs.vh.

`default_nettype none

module soc #(
    parameter CLK_HZ = 100000000, // Hz
    parameter GATES  = 0          // 1: the clock of each core that says when it is idle has a gate (core_gate.v)
) (
    input  wire        clk_i,
    input  wire        rst_i,
    `include "platform_ports.vh"
    // pins of cores
    input  wire [31:0] core_pins_i,
    output wire [31:0] core_pins_o,
    output reg         irq_o
`ifdef PLATFORM_RESTS
    ,
    input  wire        rests_i, memory_clk_i, // the platform has no clock, its memory one of its own
    output wire        stirs_o  // it needs one, by what cores and memory tell it
`endif
);
    `include "map_regs.vh"

    localparam SLOTS = MAP_SLOT_COUNT;
    localparam PORTS = MAP_NPI_PORT_COUNT;
    localparam MODEM_API = 1; // set-up chooses the modem's mode
    // The bridge and the modem take read words in the cycle they come, so they need no FIFO.
    localparam [31:0] NO_READ_FIFO = 1 << MAP_NPI_PORT_FSMC | 1 << MAP_NPI_PORT_MODEM;
    localparam [PORTS-1:0] READ_FIFO = ~NO_READ_FIFO[PORTS-1:0];

    // The reset of all blocks comes from a flip-flop, so no path leads from the pin through their
    // logic (a simulator would follow it whenever an input moves: 1.07 times slower).
    wire rst, irq;
    cdc_reset u_rst (.clk_i(clk_i), .rst_async_i(rst_i), .rst_o(rst));
    `include "wiring.vh"
`ifdef PLATFORM_RESTS
    wire platform_clk = clk_i && !rests_i;
`endif
    // The processor's interrupt input sees edges, so no glitch of a LUT may reach it.
    always @(posedge `PLATFORM_CLOCK) irq_o <= irq;

    `include "platform.vh"

    // Cores and the hashes of all slots' registers: generated from ip/cores.list.
    `include "soc_cores.vh"
`ifdef PLATFORM_RESTS
    // A probe would see the counters of a platform that rests stand still.
    assign stirs_o = PROBES != 0 || !calib_done || bus_valid || irq != irq_o ||
                     |((npi_addr_ack | ~npi_rd_empty) & NO_READ_FIFO[PORTS-1:0]);
`endif

    system_slot #(.SLOTS(SLOTS), .CLK_HZ(CLK_HZ), .CONTRACTS(CONTRACTS)) u_system_slot (
        .clk_i(`PLATFORM_CLOCK), .rst_i(rst),
        `SLOT(MAP_SLOT_SYSTEM),
        .slot_irq_i(slot_irq), .irq_o(irq), .page_o(page),
        .access_error_i(access_error), .error_memory_i(error_memory),
        .error_addr_i(error_addr), .error_write_i(error_write), .late_i(late)
    );

    wire unused = &{1'b0, slot_addr, 1'b0}; // of slots without a core
endmodule
