// SPDX-License-Identifier: MIT
//
// fsmc_nwait: last gate of NWAIT. Synthesis maps this module to one LUT and does not merge it with
// other logic.
//
// A single LUT does not glitch if its inputs change one at a time, or in the same direction;
// fsmc_bridge ensures this. KEEP_HIERARCHY makes XST map the module separately, and the scripts in
// synth/yosys use the same attribute.

`default_nettype none

(* KEEP_HIERARCHY = "YES" *)
module fsmc_nwait #(
    parameter WAIT_HIGH = 0 // 1: NWAIT is active high
) (
    input  wire ne1_i,    // the access is to memory
    input  wire holds1_i, // an access to memory must wait; counts_i gives the exception
    // the access is a read from memory that need not wait if its data is in a buffer
    input  wire counts_i,
    // same_i && found_i: the data is in a buffer (rd_same_o and rd_found_o of fsmc_memory)
    input  wire same_i,
    input  wire found_i,
    input  wire holds2_i, // the access is to a register and must wait
    output wire nwait_n_o
);
    wire waits = (ne1_i && holds1_i && !(counts_i && same_i && found_i)) || holds2_i;
    assign nwait_n_o = (WAIT_HIGH != 0) ^ !waits;
endmodule
