// SPDX-License-Identifier: MIT
//
// core_clock: generates a clock with the frequency of clk_i times MULTIPLY / DIVIDE, which is at
// most 1. On Xilinx FPGAs it uses a DCM_CLKGEN.
//
// The generated clock has no fixed phase to clk_i, so signals cross through hdl/cdc. In simulation
// its edges coincide with edges of clk_i, so a fractional ratio is reached only on average, as with
// a clock that has jitter.

`default_nettype none

module core_clock #(
    parameter MULTIPLY = 2, // 2..256
    parameter DIVIDE   = 2  // 1..256
) (
    input  wire clk_i,
    output wire clk_o
);
`ifdef VERILATOR
    reg [9:0] phase; // position in the half period of clk_o, in units of 1 / DIVIDE
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
