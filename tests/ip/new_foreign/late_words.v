// SPDX-License-Identifier: MIT
//
// late_words: four words of 16 bits, written by bytes, whose values come a clock after their strobe; a read clears its word.

module late_words (
    input             mclk, rst_ni,
    input             en,
    input      [1:0]  wen,
    input      [1:0]  where,
    input      [15:0] value,
    output reg [15:0] held
);
    reg [15:0] words [0:3];
    always @(posedge mclk) begin
        held <= words[where];
        if (en && wen == 2'd0)
            words[where] <= 16'd0;
        if (en && wen[0])
            words[where][7:0] <= value[7:0];
        if (en && wen[1])
            words[where][15:8] <= value[15:8];
        if (!rst_ni)
            held <= 16'd0;
    end
endmodule
