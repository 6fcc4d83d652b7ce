`include "timescale.v"
// SPDX-License-Identifier: MIT
//
// apb_words: an APB 5 core for tests, in the style of other people: old Verilog with a delay and a
// signal named int, a parameter, several interrupts, a gated clock. It waits for `waits` clocks in
// each access; if `waits` is 0, PREADY is always high. It takes the data of a read in the set-up
// phase, and rejects word 3. Word 0 counts the correct transfers: they begin correctly, while the
// core is awake, and have strobes only in a write. While the core is not ready, its outputs are
// meaningless.

module apb_words #(parameter WORDS = 1) (
    input             PCLK, PCLKG, PRESETn, PWAKEUP,
    input             PSEL, PENABLE, PWRITE,
    input      [3:0]  PADDR,
    input      [2:0]  PPROT,
    input      [7:0]  PAUSER,
    input      [3:0]  PSTRB,
    input      [31:0] PWDATA,
    output reg [31:0] PRDATA,
    output            PREADY, PSLVERR,
    output     [7:0]  PBUSER,
    input      [2:0]  waits,
    input      [1:0]  clk_div,
    output reg [1:0]  irq
);
    reg [31:0] words [1:WORDS];
    reg [31:0] begun;
    reg [2:0]  waited;
    reg        int;
    wire [1:0] word = PADDR[3:2];
    assign PREADY  = waited == waits;
    assign PSLVERR = !PREADY || word > WORDS;
    assign PBUSER  = PAUSER;
    always @(posedge PCLKG or negedge PRESETn)
        if (!PRESETn) begin
            {waited, int, irq} <= 6'd0;
            begun <= 32'd0;
        end else begin
            waited <= #1 PSEL && PENABLE && !PREADY ? waited + 1 : 0;
            int    <= #1 PSEL && !PENABLE;
            if (PSEL && PENABLE && int && PWAKEUP && PSTRB == {4{PWRITE}})
                begun <= #1 begun + 1;
            if (PSEL && !PENABLE)
                PRDATA <= #1 word == 2'd0 ? begun : words[word];
            if (PSEL && PENABLE && PREADY && PWRITE && &PSTRB && word != 2'd0)
                words[word] <= #1 PWDATA;
            irq <= #1 {clk_div == 2'd3, 1'b0};
        end
endmodule
