// SPDX-License-Identifier: MIT
//
// i2c_master: a slot with OpenCores' I2C master (Wishbone B3, 8 bits) behind bus_to_wishbone. This file is all that
// a Wishbone core needs.

`default_nettype none

module i2c_master (
    input  wire        clk_i,
    input  wire        rst_i,
    // register bus
    input  wire        bus_valid_i,
    input  wire        bus_write_i,
    input  wire [3:0]  bus_addr_i,
    input  wire [31:0] bus_wdata_i,
    output wire        bus_ready_o,
    output wire [31:0] bus_rdata_o,
    output wire        bus_error_o,
    output wire        irq_o,
    // I2C: the lines as they are, and whether this side pulls them low
    input  wire        scl_i,
    input  wire        sda_i,
    output wire        scl_low_o,
    output wire        sda_low_o
);
    `include "i2c_master_regs.vh"

    wire        cyc, stb, we, ack, irq, scl, sda, scl_off, sda_off;
    wire [5:0]  adr;
    wire [3:0]  sel;
    wire [31:0] wdata;
    wire [7:0]  rdata;

    bus_to_wishbone #(.ID_VALUE(I2C_MASTER_ID_VALUE), .ADDR_WIDTH(6)) u_bus (
        .clk_i(clk_i), .rst_i(rst_i),
        .bus_valid_i(bus_valid_i), .bus_write_i(bus_write_i), .bus_addr_i(bus_addr_i),
        .bus_wdata_i(bus_wdata_i), .bus_ready_o(bus_ready_o), .bus_rdata_o(bus_rdata_o),
        .bus_error_o(bus_error_o), .irq_o(irq_o),
        .wb_cyc_o(cyc), .wb_stb_o(stb), .wb_we_o(we), .wb_adr_o(adr), .wb_sel_o(sel), .wb_dat_o(wdata),
        .wb_dat_i({24'd0, rdata}), .wb_ack_i(ack), .wb_err_i(1'b0), .wb_rty_i(1'b0), .wb_stall_i(1'b0),
        .irq_i(irq));

    i2c_master_top #(.ARST_LVL(1'b1)) u_core (
        .wb_clk_i(clk_i), .wb_rst_i(rst_i), .arst_i(1'b0),
        .wb_adr_i(adr[4:2]), .wb_dat_i(wdata[7:0]), .wb_dat_o(rdata), .wb_we_i(we), .wb_stb_i(stb),
        .wb_cyc_i(cyc), .wb_ack_o(ack), .wb_inta_o(irq),
        .scl_pad_i(scl_i), .scl_pad_o(scl), .scl_padoen_o(scl_off),
        .sda_pad_i(sda_i), .sda_pad_o(sda), .sda_padoen_o(sda_off));
    assign scl_low_o = !scl_off && !scl;
    assign sda_low_o = !sda_off && !sda;
endmodule
