// SPDX-License-Identifier: MIT
//
// wbs_names: Wishbone's signals by names as others write them, without strobe and acknowledge, of a core that is a master, too.

module wbs_names (
    input         wbs_clk, rst_ni, gate_clk_pad_i,
    input  [3:0]  clk_div,
    input         wbs_cyc_i, wbs_we_i,
    input  [2:0]  wbs_cti_i,
    input  [1:0]  wbs_adr_i,
    input  [31:0] wbs_dat_i,
    output [31:0] wbs_dat_o,
    output        intr, spare
);
    assign {wbs_dat_o, intr, spare} = 34'd0;
endmodule
