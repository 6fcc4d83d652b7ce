// SPDX-License-Identifier: MIT
//
// store: 32 words of 6 bits, for tests; this is one RAM32M, which occupies four LUTs.

`default_nettype none

module store (
    input  wire       clk_i,
    input  wire       write_i,
    input  wire [4:0] write_addr_i,
    input  wire [5:0] data_i,
    input  wire [4:0] read_addr_i,
    output wire [5:0] data_o
);
    reg [5:0] words [0:31];
    assign data_o = words[read_addr_i];
    always @(posedge clk_i)
        if (write_i)
            words[write_addr_i] <= data_i;
endmodule
