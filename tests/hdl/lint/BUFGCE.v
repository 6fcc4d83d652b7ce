// SPDX-License-Identifier: MIT
//
// BUFGCE: declares the ports of the Xilinx clock buffer with enable (UG382), for lint.

(* blackbox *)
module BUFGCE (
    input  wire I,
    input  wire CE,
    output wire O
);
endmodule
