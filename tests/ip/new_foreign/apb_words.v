`include "timescale.v"
// SPDX-License-Identifier: MIT
//
// apb_words: an APB core as others write them: old Verilog with a delay and a signal named int, a parameter, several
// interrupts. It waits a clock in each access, and refuses word 3. Word 0 counts the transfers that begin as they must.

module apb_words #(parameter WORDS = 1) (
    input             PCLK, PRESETn,
    input             PSEL, PENABLE, PWRITE,
    input      [3:0]  PADDR,
    input      [2:0]  PPROT,
    input      [3:0]  PSTRB,
    input      [31:0] PWDATA,
    output     [31:0] PRDATA,
    output            PREADY, PSLVERR,
    input      [1:0]  clk_div,
    output reg [1:0]  irq
);
    reg [31:0] words [1:WORDS];
    reg [31:0] begun;
    reg        waited, int;
    wire [1:0] word = PADDR[3:2];
    assign PREADY  = waited;
    assign PSLVERR = waited && word > WORDS;
    assign PRDATA  = word == 2'd0 ? begun : words[word];
    always @(posedge PCLK or negedge PRESETn)
        if (!PRESETn) begin
            {waited, int, irq} <= 4'd0;
            begun <= 32'd0;
        end else begin
            waited <= #1 PSEL && PENABLE && !waited;
            int    <= #1 PSEL && !PENABLE;
            if (PSEL && PENABLE && int)
                begun <= #1 begun + 1;
            if (PSEL && PENABLE && waited && PWRITE && &PSTRB && word != 2'd0)
                words[word] <= #1 PWDATA;
            irq <= #1 {clk_div == 2'd3, 1'b0};
        end
endmodule
