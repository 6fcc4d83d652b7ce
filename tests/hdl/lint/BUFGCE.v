// SPDX-License-Identifier: MIT
//
// BUFGCE: ports of the clock buffer with enable of Xilinx (UG382), for lint.

(* blackbox *)
module BUFGCE (
    input  wire I,
    input  wire CE,
    output wire O
);
endmodule
