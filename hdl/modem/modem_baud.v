// SPDX-License-Identifier: MIT
//
// modem_baud: gives eight ticks a bit time, from a phase accumulator; rates below 38400 are 38400 / 2**n.
//
// Error of the mean rate: below 0.1 % for every code from 2 to 100 MHz.
//
//   bd_i  0..5  1200 << bd_i     6  57,600     7  111,111, as the modem's "115200"     8..15  250,000

`default_nettype none

module modem_baud #(
    parameter CLK_HZ = 100000000 // Hz, at least 2 MHz
) (
    input  wire       clk_i,
    input  wire       rst_i,
    input  wire [3:0] bd_i,
    output reg        tick_o
);
    localparam WIDTH = 18; // 38400 baud at 100 MHz is 805 / 2**18 within 0.04 %
    // Phase steps: 8 * rate * 2**18 / CLK_HZ, rounded.
    localparam [31:0] KHZ   = CLK_HZ / 1000,
                      BASE  = (32'd80530637 + KHZ / 2) / KHZ,
                      BD6   = (32'd120795955 + KHZ / 2) / KHZ,
                      BD7   = (32'd233016361 + KHZ / 2) / KHZ,
                      EXACT = (32'd524288000 + KHZ / 2) / KHZ,
                      BD8   = EXACT >> WIDTH != 32'd0 ? (32'd1 << WIDTH) - 32'd1 : EXACT;

    reg  [WIDTH:0]   phase; // its highest bit is the carry
    reg  [4:0]       count; // ticks of 38400 baud

    // The step is chosen by a chain of conditions, because Yosys makes a ROM of a case and puts
    // registers before it. It is negative: only in a difference is the phase sure to be the operand
    // that the carry chain takes without a LUT.
    localparam [WIDTH:0] FULL = 0;
    wire [WIDTH:0] minus = bd_i[3] ? FULL - BD8[WIDTH:0] : bd_i == 4'd7 ? FULL - BD7[WIDTH:0]
                         : bd_i == 4'd6 ? FULL - BD6[WIDTH:0] : FULL - BASE[WIDTH:0];
    // Bits of count that must be 0 for a tick.
    wire [4:0] hide = {bd_i < 4'd1, bd_i < 4'd2, bd_i < 4'd3, bd_i < 4'd4, bd_i < 4'd5};

    always @(posedge clk_i) begin
        phase <= {1'b0, phase[WIDTH-1:0]} - minus;
        count <= count + {4'd0, phase[WIDTH]};
        tick_o <= phase[WIDTH] && (count & hide) == 5'd0;
        if (rst_i) begin
            phase <= 0;
            count <= 5'd0;
            tick_o <= 1'b0;
        end
    end

`ifdef FORMAL
`include "modem_baud_proof.vh"
`endif
endmodule
