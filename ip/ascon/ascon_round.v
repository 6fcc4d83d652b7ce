// SPDX-License-Identifier: MIT
//
// ascon_round: computes one round of Ascon's permutation (NIST SP 800-232, section 3),
// combinationally. The words of the state are bits 63..0 (S0) to 319..256 (S4).

`default_nettype none

module ascon_round (
    input  wire [319:0] state_i,
    // index of the round, 0..11; a permutation of 8 rounds begins with index 4
    input  wire [3:0]   round_i,
    output wire [319:0] state_o
);
    function [63:0] right(input [63:0] word, input integer bits);
        right = (word >> bits) | (word << (64 - bits));
    endfunction

    // Constant addition
    wire [63:0] a0 = state_i[63:0],    a1 = state_i[127:64], a3 = state_i[255:192],
        a4 = state_i[319:256];
    wire [63:0] a2 = state_i[191:128] ^ {56'd0, ~round_i, round_i};
    // Substitution layer: 64 S-boxes of 5 bits, in parallel.
    wire [63:0] b0 = a0 ^ a4, b1 = a1, b2 = a2 ^ a1, b3 = a3, b4 = a4 ^ a3;
    wire [63:0] c0 = b0 ^ (~b1 & b2), c1 = b1 ^ (~b2 & b3), c2 = b2 ^ (~b3 & b4);
    wire [63:0] c3 = b3 ^ (~b4 & b0), c4 = b4 ^ (~b0 & b1);
    wire [63:0] d0 = c0 ^ c4, d1 = c1 ^ c0, d2 = ~c2, d3 = c3 ^ c2, d4 = c4;
    // Linear diffusion
    assign state_o[63:0]    = d0 ^ right(d0, 19) ^ right(d0, 28);
    assign state_o[127:64]  = d1 ^ right(d1, 61) ^ right(d1, 39);
    assign state_o[191:128] = d2 ^ right(d2, 1) ^ right(d2, 6);
    assign state_o[255:192] = d3 ^ right(d3, 10) ^ right(d3, 17);
    assign state_o[319:256] = d4 ^ right(d4, 7) ^ right(d4, 41);
endmodule
