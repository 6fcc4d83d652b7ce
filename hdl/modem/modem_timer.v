// SPDX-License-Identifier: MIT
//
// modem_timer: counts units of a millisecond and a sixteenth: the margin covers the modem's own clock.

`default_nettype none

module modem_timer #(
    parameter CLK_HZ = 100000000 // Hz, a multiple of 16000
) (
    input  wire        clk_i,
    input  wire        rst_i,
    input  wire        clear_i,
    output reg         tick_o, // once a unit
    output reg  [11:0] time_o  // since clear_i
);
    localparam [31:0] CLOCKS = CLK_HZ / 16000 * 17;
    localparam [16:0] LAST   = CLOCKS[16:0] - 17'd2;

    reg [16:0] clocks;

    wire unused = &{1'b0, CLOCKS[31:17], 1'b0};

    always @(posedge clk_i) begin
        clocks <= clocks + 17'd1;
        tick_o <= clocks == LAST && !clear_i;
        if (tick_o)
            time_o <= time_o + 12'd1;
        if (rst_i || clear_i || tick_o)
            clocks <= 17'd0;
        if (rst_i || clear_i)
            time_o <= 12'd0;
    end

`ifdef FORMAL
`include "modem_timer_proof.vh"
`endif
endmodule
