// SPDX-License-Identifier: MIT
//
// cdc_bit: two flip-flops take bits of another clock, or of a pin, into clk_i.
//
// Each bit arrives by itself, one to two clocks late; a level that lasts for less than a clock may be missed. A bus
// therefore goes through it only in Gray code, or as bits that mean nothing together (TOGETHER says otherwise:
// routing holds their skew below the time that they rest, docs/fsmc.md).
// Reset: none; INITIAL until two clocks have come. Constraint: the path to bit_meta is no timing path
// (TIG or FROM:TO of a clock's period), that from bit_meta to bit_sync has the whole period for itself.
// With CDC_RANDOM, and in proofs, bit_meta may take what the input was a clock ago: all that metastability and
// routing can do.

`default_nettype none

module cdc_bit #(
    parameter             WIDTH    = 1,
    parameter             TOGETHER = 0, // 1: uncertainty is the same for all bits
    parameter [WIDTH-1:0] INITIAL  = 0
) (
    input  wire             clk_i,
    input  wire [WIDTH-1:0] bit_async_i,
    output wire [WIDTH-1:0] bit_sync_o
);
    (* ASYNC_REG = "TRUE", SHREG_EXTRACT = "NO", KEEP = "TRUE" *) reg [WIDTH-1:0] bit_meta, bit_sync;
    initial {bit_meta, bit_sync} = {2{INITIAL}};
    wire [WIDTH-1:0] bit_seen;
    assign bit_sync_o = bit_sync;

    always @(posedge clk_i) begin
        bit_meta <= bit_seen;
        bit_sync <= bit_meta;
    end

`ifdef CDC_RANDOM
    `define CDC_UNCERTAIN
`endif
`ifdef FORMAL
    `define CDC_UNCERTAIN
`endif
`ifdef CDC_UNCERTAIN
    reg [WIDTH-1:0] bit_was;
    initial bit_was = INITIAL;
    always @(posedge clk_i) bit_was <= bit_async_i;
`ifdef FORMAL
    wire [WIDTH-1:0] late; // free
`else
    reg [WIDTH-1:0] late;
    integer b;
    always @(posedge clk_i)
        for (b = 0; b < WIDTH; b = b + 1)
            late[b] <= |($urandom & 32'd1);
`endif
    wire [WIDTH-1:0] old = TOGETHER != 0 ? {WIDTH{late[0]}} : late;
    assign bit_seen = (bit_async_i & ~old) | (bit_was & old);
`else
    assign bit_seen = bit_async_i;
    wire unused = &{1'b0, TOGETHER[0], 1'b0};
`endif
endmodule
