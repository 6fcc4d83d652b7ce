// SPDX-License-Identifier: MIT
//
// reader: replaces a flip-flop that depends on a pin, or on a register of another clock, without
// hdl/cdc. Yosys maps such flip-flops to this module (CMakeLists.txt).
//
// Each bit that has changed since the falling edge of the clock is sampled with its old or its new
// value, independently of the other bits (cdc_random.vh). Benches change synchronous inputs before
// that edge, and pins after it.

`default_nettype none

`ifdef VERILATOR
module reader #(
    parameter             WIDTH   = 1,
    parameter [WIDTH-1:0] INITIAL = 0
) (
    input  wire             clk_i,
    input  wire [WIDTH-1:0] bits_i,
    output reg  [WIDTH-1:0] bits_o
);
    localparam TOGETHER = 0;
    `include "cdc_random.vh"
    reg [WIDTH-1:0] early;
    initial bits_o = INITIAL;
    always @(negedge clk_i)
        early <= bits_i;
    always @(posedge clk_i)
        bits_o <= bits_i ^ late(bits_i ^ early);
endmodule
`else
module \$dff (input CLK, input [WIDTH-1:0] D, output [WIDTH-1:0] Q);
    parameter WIDTH = 1, CLK_POLARITY = 1'b1;
    parameter [WIDTH-1:0] _TECHMAP_WIREINIT_Q_ = 0;
    wire [WIDTH-1:0] _TECHMAP_REMOVEINIT_Q_ = ~0;
    reader #(.WIDTH(WIDTH), .INITIAL(_TECHMAP_WIREINIT_Q_)) _TECHMAP_REPLACE_ (
        .clk_i(CLK), .bits_i(D), .bits_o(Q));
endmodule
`endif
