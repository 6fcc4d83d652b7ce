// SPDX-License-Identifier: MIT
//
// DCM_CLKGEN: declares those ports of the Spartan-6 clock generator (UG382) that core_clock.v
// connects, for lint.

(* blackbox *)
module DCM_CLKGEN #(
    parameter CLKFX_MULTIPLY = 4,
    parameter CLKFX_DIVIDE   = 1
) (
    input  wire CLKIN,
    input  wire RST,
    input  wire FREEZEDCM,
    input  wire PROGCLK,
    input  wire PROGDATA,
    input  wire PROGEN,
    output wire CLKFX
);
    wire unused = &{1'b0, CLKFX_MULTIPLY[0], CLKFX_DIVIDE[0], 1'b0};
endmodule
