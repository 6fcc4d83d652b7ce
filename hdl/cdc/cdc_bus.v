// SPDX-License-Identifier: MIT
//
// cdc_bus: hands each word of src_clk_i over once in dst_clk_i, two to three clocks later.
//
// A word stays in the source's register; a copy of it is taken in the clock in which the event's second
// flip-flop turns, so the next word may come two dst_clk_i clocks and the paths' skew later, without a handshake.
// There is no reset. Constraint: a dst_clk_i period from src_data's register to the copy, and that of cdc_bit.

`default_nettype none

module cdc_bus #(
    parameter WIDTH = 8
) (
    input  wire             src_clk_i,
    input  wire             src_valid_i,
    input  wire [WIDTH-1:0] src_data_i,
    output reg  [WIDTH-1:0] src_data_o,     // the word taken last, in src_clk_i
    input  wire             dst_clk_i,
    output wire             dst_valid_o,    // one cycle
    output wire [WIDTH-1:0] dst_data_o,     // valid from dst_valid_o until src_clk_i takes the next word
    output wire             pending_sync_o, // pending_async_o as dst_clk_i sees it
    output wire             pending_async_o // a word has not been handed over yet
);
    always @(posedge src_clk_i)
        if (src_valid_i)
            src_data_o <= src_data_i;

    cdc_pulse u_cdc_pulse (
        .src_clk_i(src_clk_i), .src_valid_i(src_valid_i), .dst_clk_i(dst_clk_i), .dst_valid_o(dst_valid_o),
        .pending_sync_o(pending_sync_o), .pending_async_o(pending_async_o)
    );
    cdc_copy #(.WIDTH(WIDTH)) u_cdc_copy (.clk_i(dst_clk_i), .bus_async_i(src_data_o), .bus_sync_o(dst_data_o));

`ifdef FORMAL
`include "cdc_bus_proof.vh"
`endif
endmodule
