// SPDX-License-Identifier: MIT
//
// wb_words: Wishbone as a pipelined core has it: it stalls each strobe for `stalls` clocks and answers `late` clocks after
// it took one, in the same clock if 0. Without STALL it is a classic core, and counts from the strobe's begin. Its addresses
// count bytes.

module wb_words (
    input             wb_clk_i, wb_rst_i,
    input             wb_cyc_i, wb_stb_i, wb_we_i,
    input      [3:0]  wb_adr_i,
    input      [3:0]  wb_sel_i,
    input      [31:0] wb_dat_i,
    output     [31:0] wb_dat_o,
    output            wb_ack_o, wb_stall_o,
    input      [2:0]  stalls, late
);
    reg  [31:0] words [0:3];
    reg  [3:0]  waited; // clocks since the strobe began
    reg         we;
    reg  [1:0]  word;
    wire        begins = wb_cyc_i && wb_stb_i && waited <= stalls;
    wire [1:0]  at     = begins ? wb_adr_i[3:2] : word;
    assign wb_stall_o = waited < stalls;
    assign wb_ack_o   = wb_cyc_i && (wb_stb_i || waited != 0) && waited == stalls + late;
    assign wb_dat_o   = wb_ack_o && &wb_sel_i ? words[at] : 32'hBAD0BAD0;
    always @(posedge wb_clk_i) begin
        waited <= wb_cyc_i && (wb_stb_i || waited != 0) && !wb_ack_o ? waited + 1 : 0;
        if (begins) begin
            {we, word} <= {wb_we_i, wb_adr_i[3:2]};
            if (wb_we_i && waited == stalls)
                words[at] <= wb_dat_i;
        end
        if (wb_rst_i)
            waited <= 0;
    end
endmodule
