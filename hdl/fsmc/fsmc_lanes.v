// SPDX-License-Identifier: MIT
//
// fsmc_lanes: returns the byte enables of a halfword in a word of four halfwords. Synthesis maps
// this module separately (see fsmc_found), so that two of its outputs share a LUT site.

`default_nettype none

(* KEEP_HIERARCHY = "YES" *)
module fsmc_lanes (
    input  wire       valid_i,
    input  wire [1:0] halfword_i, // position in the word
    input  wire [1:0] be_i,       // byte enables of the halfword
    output wire [7:0] be_o
);
    wire [3:0] lane = 4'd1 << halfword_i;
    assign be_o = {{2{lane[3]}}, {2{lane[2]}}, {2{lane[1]}}, {2{lane[0]}}} & {4{be_i}} &
        {8{valid_i}};
endmodule
