// SPDX-License-Identifier: MIT
//
// req_words: a core with a request that lasts until it is granted, two clocks later; word 3 is never granted.

module req_words (
    input             clock, nrst,
    input             req, wr,
    input      [3:2]  where,
    input      [31:0] value,
    output reg [31:0] held,
    output reg        gnt
);
    reg [31:0] words [0:3];
    reg        seen;
    always @(posedge clock) begin
        seen <= req && !gnt;
        gnt  <= req && seen && !gnt && where != 2'd3;
        held <= words[where];
        if (req && wr)
            words[where] <= value;
        if (!nrst)
            {seen, gnt} <= 2'b00;
    end
endmodule
