// SPDX-License-Identifier: MIT
//
// mig: declares the ports of MIG's core (UG388, one 64-bit port in bank 3), so that the complete
// wrapper can be linted.
/* verilator lint_off UNDRIVEN */
/* verilator lint_off UNUSEDSIGNAL */

`default_nettype none

module mig (
    input  wire        c3_sys_clk, c3_sys_rst_i,
    output wire        c3_clk0, c3_rst0, c3_calib_done,
    inout  wire [15:0] mcb3_dram_dq,
    output wire [13:0] mcb3_dram_a,
    output wire [2:0]  mcb3_dram_ba,
    output wire        mcb3_dram_ras_n, mcb3_dram_cas_n, mcb3_dram_we_n, mcb3_dram_odt,
    output wire        mcb3_dram_reset_n, mcb3_dram_cke, mcb3_dram_dm, mcb3_dram_udm,
    inout  wire        mcb3_dram_udqs, mcb3_dram_udqs_n, mcb3_dram_dqs, mcb3_dram_dqs_n,
    output wire        mcb3_dram_ck, mcb3_dram_ck_n,
    inout  wire        mcb3_rzq, mcb3_zio,
    input  wire        c3_p0_cmd_clk, c3_p0_cmd_en,
    input  wire [2:0]  c3_p0_cmd_instr,
    input  wire [5:0]  c3_p0_cmd_bl,
    input  wire [29:0] c3_p0_cmd_byte_addr,
    output wire        c3_p0_cmd_empty, c3_p0_cmd_full,
    input  wire        c3_p0_wr_clk, c3_p0_wr_en,
    input  wire [7:0]  c3_p0_wr_mask,
    input  wire [63:0] c3_p0_wr_data,
    output wire        c3_p0_wr_full, c3_p0_wr_empty,
    output wire [6:0]  c3_p0_wr_count,
    output wire        c3_p0_wr_underrun, c3_p0_wr_error,
    input  wire        c3_p0_rd_clk, c3_p0_rd_en,
    output wire [63:0] c3_p0_rd_data,
    output wire        c3_p0_rd_full, c3_p0_rd_empty,
    output wire [6:0]  c3_p0_rd_count,
    output wire        c3_p0_rd_overflow, c3_p0_rd_error
);
endmodule
