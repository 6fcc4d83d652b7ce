// SPDX-License-Identifier: MIT
//
// fsmc_found: decides whether the requested halfword is in the read buffer. Synthesis maps this
// module to one LUT and does not merge it with other logic (see fsmc_nwait).
//
// The output does not glitch while the address is stable: full_i and have_one_i are flip-flops, and
// the other inputs change only while have_one_i is 0 (fsmc_memory).

`default_nettype none

(* KEEP_HIERARCHY = "YES" *)
module fsmc_found (
    input  wire       block_i,    // block that the address selects, 0 or 1
    input  wire [1:0] full_i,     // bit n: all words of block n have arrived
    input  wire       have_one_i, // the single word (fetched without its block) has arrived
    input  wire       one_block_i, // block of the single word
    // the address selects the single word's position in a block
    input  wire       is_one_i,
    output wire       found_o
);
    assign found_o = full_i[block_i] || (have_one_i && one_block_i == block_i && is_one_i);
endmodule
