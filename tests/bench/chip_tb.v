// SPDX-License-Identifier: MIT
//
// chip_tb: the chip at rest for +clocks=n clocks, for Icarus, as the simulator with --every-clock.

`timescale 1ns / 1ps
`default_nettype none

module chip_tb;
    reg     clk = 1'b0, rst = 1'b1;
    integer clocks = 0, most = 0;
    always #5 clk = ~clk;

    soc u_soc (
        .clk_i(clk), .rst_i(rst),
        .fsmc_a_i(25'd0), .fsmc_d_i(16'd0), .fsmc_d_o(), .fsmc_d_oe_o(), .fsmc_ne_n_i(2'b11), .fsmc_noe_n_i(1'b1),
        .fsmc_nwe_n_i(1'b1), .fsmc_nbl_n_i(2'b11), .fsmc_nadv_n_i(1'b1), .fsmc_nwait_n_o(), .irq_o(),
        .modem_rxd_i(1'b1), .modem_txd_o(), .modem_cts_n_i(1'b0), .modem_rts_n_o(), .modem_reset_n_o(),
        .core_pins_i(32'd0), .core_pins_o(),
        .mcb_cmd_en_o(), .mcb_cmd_instr_o(), .mcb_cmd_bl_o(), .mcb_cmd_byte_addr_o(), .mcb_cmd_full_i(1'b0),
        .mcb_wr_en_o(), .mcb_wr_mask_o(), .mcb_wr_data_o(), .mcb_wr_full_i(1'b0), .mcb_rd_en_o(),
        .mcb_rd_data_i(64'd0), .mcb_rd_empty_i(1'b1), .mcb_calib_done_i(1'b1)
    );

    always @(posedge clk) begin
        clocks <= clocks + 1;
        if (clocks == 8)
            rst <= 1'b0;
        if (clocks == most) begin
            $display("clocks %0d", clocks);
            $finish;
        end
    end
    initial if (!$value$plusargs("clocks=%d", most)) most = 1000;
endmodule
