// SPDX-License-Identifier: MIT
//
// cdc_bit: two-stage synchroniser for bits from another clock domain or from pins.
//
// Each bit arrives one to three clocks later, independently of the other bits. A level that lasts
// for two clocks is certain to be seen. A bus may use this module only if it is in Gray code or its
// bits are independent. With TOGETHER the bits are not independent: constraints keep the skew
// between them shorter than the time for which they are stable (docs/fsmc.md). The module has no
// reset: the output is INITIAL for the first two clocks. Constraints: at most one period of clk_i
// to bit_meta (FROM:TO), and the whole period from bit_meta to bit_sync. In proofs, and in
// simulations with +cdc_random, bit_meta may take the input of the previous clock. This models all
// effects of metastability and routing.

`default_nettype none

module cdc_bit #(
    parameter             WIDTH    = 1,
    // 0: each bit may be late, independently of the others. N > 0: the bits that change in one
    // clock are all late, or all in time. In simulation, they are late only if one of the N most
    // significant bits changes in that clock.
    parameter             TOGETHER = 0,
    // 1: bits are never late here, because a cdc_skew in front of this module delays them
    parameter             EXACT    = 0,
    parameter [WIDTH-1:0] INITIAL  = 0
) (
    input  wire             clk_i,
    input  wire [WIDTH-1:0] bit_async_i,
    output wire [WIDTH-1:0] bit_sync_o
);
    (* ASYNC_REG = "TRUE", SHREG_EXTRACT = "NO", KEEP = "TRUE" *)
    reg [WIDTH-1:0] bit_meta, bit_sync;
    initial {bit_meta, bit_sync} = {2{INITIAL}};
    assign bit_sync_o = bit_sync;
    always @(posedge clk_i)
        bit_sync <= bit_meta;

`ifdef VERILATOR
    `include "cdc_random.vh"
    reg  [WIDTH-1:0] bit_was;
    initial bit_was = INITIAL;
    wire [WIDTH-1:0] moved = bit_async_i ^ bit_was;
    always @(posedge clk_i) begin
        bit_was  <= bit_async_i;
        if (EXACT != 0 || (TOGETHER != 0 && moved >> (WIDTH - TOGETHER) == 0))
            bit_meta <= bit_async_i;
        else
            bit_meta <= bit_async_i ^ late(moved);
    end
`elsif FORMAL
    reg  [WIDTH-1:0] bit_was;
    wire [WIDTH-1:0] late; // 1 for each bit that arrives late; the prover chooses freely
    wire [WIDTH-1:0] old = EXACT != 0 ? {WIDTH{1'b0}} : TOGETHER != 0 ? {WIDTH{late[0]}} : late;
    initial bit_was = INITIAL;
    always @(posedge clk_i) begin
        bit_was  <= bit_async_i;
        bit_meta <= (bit_async_i & ~old) | (bit_was & old);
    end
`else
    always @(posedge clk_i)
        bit_meta <= bit_async_i;
    wire unused = &{1'b0, TOGETHER[0], EXACT[0], 1'b0};
`endif
endmodule
