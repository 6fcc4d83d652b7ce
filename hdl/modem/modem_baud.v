// SPDX-License-Identifier: MIT
//
// modem_baud: phase step of a BD code: bit rate / CLK_HZ in 1/2**26. BD 7 is 111,111 baud, as the modem.
//
// Error of the mean rate: below 0.1 % for every code from 2 MHz to 100 MHz.

`default_nettype none

module modem_baud #(
    parameter CLK_HZ = 100000000 // Hz
) (
    input  wire [2:0]  bd_i,
    output reg  [25:0] step_o
);
    localparam [31:0] CLK = CLK_HZ;

    function [25:0] step(input [63:0] baud);
        // verilator lint_off WIDTH
        step = ((baud << 26) + CLK / 2) / CLK; // below 2**26, since no rate is above CLK_HZ
        // verilator lint_on WIDTH
    endfunction

    always @* begin
        case (bd_i)
            3'd0:    step_o = step(64'd1200);
            3'd1:    step_o = step(64'd2400);
            3'd2:    step_o = step(64'd4800);
            3'd3:    step_o = step(64'd9600);
            3'd4:    step_o = step(64'd19200);
            3'd5:    step_o = step(64'd38400);
            3'd6:    step_o = step(64'd57600);
            default: step_o = step(64'd111111);
        endcase
    end
endmodule
