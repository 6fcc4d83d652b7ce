// SPDX-License-Identifier: MIT
//
// late_words: a core for tests with four words of 16 bits, which are written byte by byte. Read
// data is valid one clock after its strobe, and a read clears the word. A file contains the initial
// values.

module late_words (
    input             mclk, rst_ni,
    input             en,
    input      [1:0]  wen,
    input      [15:0] where,
    input      [`WORD-1:0] value,
    output reg [`WORD-1:0] held
);
    reg [15:0] words [0:3];
    initial $readmemh("late_words.hex", words);
    always @(posedge mclk) begin
        held <= words[where[1:0]];
        if (en && wen == 2'd0)
            words[where[1:0]] <= 16'd0;
        if (en && wen[0])
            words[where[1:0]][7:0] <= value[7:0];
        if (en && wen[1])
            words[where[1:0]][15:8] <= value[15:8];
        if (!rst_ni)
            held <= 16'd0;
    end
endmodule
