// SPDX-License-Identifier: MIT
//
// memory_words: four words behind select and write enable; what is read is there LATE clocks later.

module memory_words #(parameter LATE = 0) (
    input         clk, rst,
    input         cs, we,
    input  [1:0]  address,
    input  [31:0] write_data,
    output [31:0] read_data
);
    reg  [31:0] words [0:3];
    wire [31:0] value [0:LATE];
    assign value[0]  = cs ? words[address] : 32'hBAD0BAD0;
    assign read_data = value[LATE];
    generate
        genvar i;
        for (i = 0; i < LATE; i = i + 1) begin : later
            reg [31:0] held;
            always @(posedge clk) held <= value[i];
            assign value[i+1] = held;
        end
    endgenerate
    always @(posedge clk)
        if (cs && we)
            words[address] <= write_data;
    wire unused = rst;
endmodule
