// SPDX-License-Identifier: MIT
//
// core_clock: generates a clock with the frequency of clk_i * MULTIPLY / DIVIDE, not faster than
// clk_i; on Xilinx FPGAs with a DCM_CLKGEN.
//
// It is unrelated to clk_i: crossings go through hdl/cdc. In simulation its edges are at edges of
// clk_i, so a fractional ratio holds on average, as for a clock with jitter.

`default_nettype none

module core_clock #(
    parameter MULTIPLY = 2, // 2..256
    parameter DIVIDE   = 2  // 1..256
) (
    input  wire clk_i,
    output wire clk_o
);
`ifdef VERILATOR
    reg [9:0] phase; // phase of half a clock, in units of 1 / DIVIDE
    reg       level;
    assign clk_o = level;
    initial {phase, level} = 11'd0;
    always @(posedge clk_i or negedge clk_i) begin
        phase <= phase + MULTIPLY[9:0] -
            (phase + MULTIPLY[9:0] >= DIVIDE[9:0] ? DIVIDE[9:0] : 10'd0);
        level <= level ^ (phase + MULTIPLY[9:0] >= DIVIDE[9:0]);
    end
`else
    wire made;
    DCM_CLKGEN #(.CLKFX_MULTIPLY(MULTIPLY), .CLKFX_DIVIDE(DIVIDE)) u_dcm (
        .CLKIN(clk_i), .RST(1'b0), .FREEZEDCM(1'b0), .PROGCLK(1'b0), .PROGDATA(1'b0), .PROGEN(1'b0),
        .CLKFX(made));
    BUFGCE u_buffer (.I(made), .CE(1'b1), .O(clk_o));
`endif
endmodule
