// SPDX-License-Identifier: MIT
//
// cdc_skew: models how bits that change with src_clk_i arrive in the clock domain dst_clk_i; for
// simulation only (cdc_random.vh).
//
// If src_clk_i has had an edge since the last edge of dst_clk_i, each bit that changed at that edge
// arrives with its old or its new value, independently of the other bits. Therefore a Gray-coded
// count arrives as one of two values, but a binary count may arrive as a value that it never had.

`default_nettype none

module cdc_skew #(
    parameter WIDTH = 4
) (
    input  wire             src_clk_i,
    input  wire [WIDTH-1:0] bits_i,
    input  wire             dst_clk_i,
    output wire [WIDTH-1:0] bits_o
);
`ifdef VERILATOR
    localparam TOGETHER = 0;
    `include "cdc_random.vh"
    reg [WIDTH-1:0] before_step, before_edge, drawn;
    always @(posedge src_clk_i)
        before_step <= bits_i;
    always @(posedge dst_clk_i) begin
        before_edge <= bits_i;
        if (bits_i != before_edge)
            drawn <= late({WIDTH{1'b1}});
    end
    assign bits_o = bits_i ^ (drawn & (bits_i ^ before_step) & (bits_i ^ before_edge));
`else
    assign bits_o = bits_i;
`endif
endmodule
