// SPDX-License-Identifier: MIT
//
// chip: top level for ISE, which connects soc (from EDIF), the memory controller that MIG
// generates, and the pads.
//
// This is a template. `mig` and its ports have the names that MIG 3.x gives to a core called "mig"
// for the MCB of bank 3 with one 64-bit port (UG388). c3_clk0 is the user clock of 100 MHz that MIG
// generates from sys_clk_i. ROWS is the number of address lines of the memory: 13 for 1 Gbit, 14
// for 2 Gbit (x16).

`default_nettype none

module chip #(
    parameter ROWS = 14
) (
    input  wire        sys_clk_i,
    input  wire        sys_rst_i,
    // FSMC pins
    input  wire [24:0] fsmc_a_i,
    inout  wire [15:0] fsmc_d_io,
    input  wire [1:0]  fsmc_ne_n_i,
    input  wire        fsmc_noe_n_i,
    input  wire        fsmc_nwe_n_i,
    input  wire [1:0]  fsmc_nbl_n_i,
    input  wire        fsmc_nadv_n_i,
    output wire        fsmc_nwait_n_o,
    output wire        irq_o,
    // modem pins
    input  wire        modem_rxd_i,
    output wire        modem_txd_o,
    input  wire        modem_cts_n_i,
    output wire        modem_rts_n_o,
    output wire        modem_reset_n_o,
    // pins of cores (build/main/gen/map_regs.md)
    input  wire [31:0] core_pins_i,
    output wire [31:0] core_pins_o,
    // DDR3 pins
    inout  wire [15:0] mcb3_dram_dq,
    output wire [ROWS-1:0] mcb3_dram_a,
    output wire [2:0]  mcb3_dram_ba,
    output wire        mcb3_dram_ras_n,
    output wire        mcb3_dram_cas_n,
    output wire        mcb3_dram_we_n,
    output wire        mcb3_dram_odt,
    output wire        mcb3_dram_reset_n,
    output wire        mcb3_dram_cke,
    output wire        mcb3_dram_dm,
    output wire        mcb3_dram_udm,
    inout  wire        mcb3_dram_udqs,
    inout  wire        mcb3_dram_udqs_n,
    inout  wire        mcb3_dram_dqs,
    inout  wire        mcb3_dram_dqs_n,
    output wire        mcb3_dram_ck,
    output wire        mcb3_dram_ck_n,
    inout  wire        mcb3_rzq,
    inout  wire        mcb3_zio
);
    wire        clk, rst, calib_done;
    wire        cmd_en, cmd_full, wr_en, wr_full, rd_en, rd_empty;
    wire [2:0]  cmd_instr;
    wire [5:0]  cmd_bl;
    wire [29:0] cmd_byte_addr;
    wire [7:0]  wr_mask;
    wire [63:0] wr_data, rd_data;
    wire [15:0] fsmc_d;
    wire        fsmc_d_oe;

    assign fsmc_d_io = fsmc_d_oe ? fsmc_d : 16'hzzzz;

    soc u_soc (
        .clk_i(clk), .rst_i(rst),
        .fsmc_a_i(fsmc_a_i), .fsmc_d_i(fsmc_d_io), .fsmc_d_o(fsmc_d), .fsmc_d_oe_o(fsmc_d_oe),
        .fsmc_ne_n_i(fsmc_ne_n_i), .fsmc_noe_n_i(fsmc_noe_n_i), .fsmc_nwe_n_i(fsmc_nwe_n_i),
        .fsmc_nbl_n_i(fsmc_nbl_n_i), .fsmc_nadv_n_i(fsmc_nadv_n_i),
        .fsmc_nwait_n_o(fsmc_nwait_n_o), .irq_o(irq_o),
        .modem_rxd_i(modem_rxd_i), .modem_txd_o(modem_txd_o), .modem_cts_n_i(modem_cts_n_i),
        .modem_rts_n_o(modem_rts_n_o), .modem_reset_n_o(modem_reset_n_o),
        .core_pins_i(core_pins_i), .core_pins_o(core_pins_o),
        .mcb_cmd_en_o(cmd_en), .mcb_cmd_instr_o(cmd_instr), .mcb_cmd_bl_o(cmd_bl),
        .mcb_cmd_byte_addr_o(cmd_byte_addr), .mcb_cmd_full_i(cmd_full),
        .mcb_wr_en_o(wr_en), .mcb_wr_mask_o(wr_mask), .mcb_wr_data_o(wr_data),
        .mcb_wr_full_i(wr_full), .mcb_rd_en_o(rd_en), .mcb_rd_data_i(rd_data),
        .mcb_rd_empty_i(rd_empty), .mcb_calib_done_i(calib_done)
    );

    mig u_mig (
        .c3_sys_clk(sys_clk_i), .c3_sys_rst_i(sys_rst_i),
        .c3_clk0(clk), .c3_rst0(rst), .c3_calib_done(calib_done),
        .mcb3_dram_dq(mcb3_dram_dq), .mcb3_dram_a(mcb3_dram_a), .mcb3_dram_ba(mcb3_dram_ba),
        .mcb3_dram_ras_n(mcb3_dram_ras_n), .mcb3_dram_cas_n(mcb3_dram_cas_n),
        .mcb3_dram_we_n(mcb3_dram_we_n), .mcb3_dram_odt(mcb3_dram_odt),
        .mcb3_dram_reset_n(mcb3_dram_reset_n), .mcb3_dram_cke(mcb3_dram_cke),
        .mcb3_dram_dm(mcb3_dram_dm), .mcb3_dram_udm(mcb3_dram_udm),
        .mcb3_dram_udqs(mcb3_dram_udqs), .mcb3_dram_udqs_n(mcb3_dram_udqs_n),
        .mcb3_dram_dqs(mcb3_dram_dqs), .mcb3_dram_dqs_n(mcb3_dram_dqs_n),
        .mcb3_dram_ck(mcb3_dram_ck), .mcb3_dram_ck_n(mcb3_dram_ck_n),
        .mcb3_rzq(mcb3_rzq), .mcb3_zio(mcb3_zio),
        .c3_p0_cmd_clk(clk), .c3_p0_cmd_en(cmd_en), .c3_p0_cmd_instr(cmd_instr),
        .c3_p0_cmd_bl(cmd_bl), .c3_p0_cmd_byte_addr(cmd_byte_addr), .c3_p0_cmd_empty(),
        .c3_p0_cmd_full(cmd_full),
        .c3_p0_wr_clk(clk), .c3_p0_wr_en(wr_en), .c3_p0_wr_mask(wr_mask), .c3_p0_wr_data(wr_data),
        .c3_p0_wr_full(wr_full), .c3_p0_wr_empty(), .c3_p0_wr_count(), .c3_p0_wr_underrun(),
        .c3_p0_wr_error(),
        .c3_p0_rd_clk(clk), .c3_p0_rd_en(rd_en), .c3_p0_rd_data(rd_data), .c3_p0_rd_full(),
        .c3_p0_rd_empty(rd_empty), .c3_p0_rd_count(), .c3_p0_rd_overflow(), .c3_p0_rd_error()
    );
endmodule
