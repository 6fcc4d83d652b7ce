// SPDX-License-Identifier: MIT
//
// table1: what the paper's Table I counts: FSMC bridge, memory controller with two NPI ports, radio IP.
//
// Wiring only, as in soc.v. The system slot (page register, errors) is not in the table: its signals
// are ports here, and its slot answers as an empty one does.

`default_nettype none

module table1 #(
    parameter CLK_HZ = 100000000 // Hz
) (
    input  wire        clk_i,
    input  wire        rst_i,
    // FSMC pins
    input  wire [24:0] fsmc_a_i,
    input  wire [15:0] fsmc_d_i,
    output wire [15:0] fsmc_d_o,
    output wire        fsmc_d_oe_o,
    input  wire [1:0]  fsmc_ne_n_i,
    input  wire        fsmc_noe_n_i,
    input  wire        fsmc_nwe_n_i,
    input  wire [1:0]  fsmc_nbl_n_i,
    input  wire        fsmc_nadv_n_i,
    output wire        fsmc_nwait_n_o,
    // system slot
    input  wire [5:0]  page_i,
    output wire        access_error_o,
    output wire        error_memory_o,
    output wire [9:0]  error_addr_o,
    output wire        error_write_o,
    output wire        late_o,
    output wire        irq_o,
    // modem pins
    input  wire        modem_rxd_i,
    output wire        modem_txd_o,
    input  wire        modem_cts_n_i,
    output wire        modem_rts_n_o,
    output wire        modem_reset_n_o,
    // MCB user port
    output wire        mcb_cmd_en_o,
    output wire [2:0]  mcb_cmd_instr_o,
    output wire [5:0]  mcb_cmd_bl_o,
    output wire [29:0] mcb_cmd_byte_addr_o,
    input  wire        mcb_cmd_full_i,
    output wire        mcb_wr_en_o,
    output wire [7:0]  mcb_wr_mask_o,
    output wire [63:0] mcb_wr_data_o,
    input  wire        mcb_wr_full_i,
    output wire        mcb_rd_en_o,
    input  wire [63:0] mcb_rd_data_i,
    input  wire        mcb_rd_empty_i,
    input  wire        mcb_calib_done_i
);
    localparam FSMC = 0, RADIO = 1; // memory ports
    localparam MODEM = 1;           // slot, as in bus/map.regs.json

    wire        bus_valid, bus_write, bus_ready, bus_error;
    wire [9:0]  bus_addr;
    wire [31:0] bus_wdata, bus_rdata;
    `include "wiring.vh"
    `SLOT_WIRES(2)
    `NPI_WIRES(2)

    // nothing in slot 0
    assign slot_ready[0] = 1'b1, slot_error[0] = 1'b1, slot_rdata[31:0] = 32'd0;
    reg  irq;
    wire calib_done;
    assign irq_o = irq;
    always @(posedge clk_i) irq <= slot_irq[MODEM];
    cdc_bit u_calib_done (.clk_i(clk_i), .bit_async_i(mcb_calib_done_i), .bit_sync_o(calib_done));

    fsmc_bridge u_fsmc_bridge (
        .clk_i(clk_i), .rst_i(rst_i),
        .fsmc_a_i(fsmc_a_i), .fsmc_d_i(fsmc_d_i), .fsmc_d_o(fsmc_d_o), .fsmc_d_oe_o(fsmc_d_oe_o),
        .fsmc_ne_n_i(fsmc_ne_n_i), .fsmc_noe_n_i(fsmc_noe_n_i), .fsmc_nwe_n_i(fsmc_nwe_n_i),
        .fsmc_nbl_n_i(fsmc_nbl_n_i), .fsmc_nadv_n_i(fsmc_nadv_n_i), .fsmc_clk_i(1'b0),
        .fsmc_nwait_n_o(fsmc_nwait_n_o),
        .page_i(page_i), .access_error_o(access_error_o),
        .error_memory_o(error_memory_o), .error_addr_o(error_addr_o),
        .error_write_o(error_write_o), .late_o(late_o),
        .bus_valid_o(bus_valid), .bus_write_o(bus_write), .bus_addr_o(bus_addr),
        .bus_wdata_o(bus_wdata), .bus_ready_i(bus_ready), .bus_rdata_i(bus_rdata),
        .bus_error_i(bus_error),
        `NPI(FSMC)
    );

    bus_decoder #(.SLOTS(2)) u_bus_decoder (
        .clk_i(clk_i),
        .bus_valid_i(bus_valid), .bus_write_i(bus_write), .bus_addr_i(bus_addr),
        .bus_wdata_i(bus_wdata), .bus_ready_o(bus_ready), .bus_rdata_o(bus_rdata),
        .bus_error_o(bus_error),
        .slot_valid_o(slot_valid), .slot_write_o(slot_write), .slot_addr_o(slot_addr),
        .slot_wdata_o(slot_wdata), .slot_ready_i(slot_ready), .slot_rdata_i(slot_rdata),
        .slot_error_i(slot_error)
    );

    modem #(.CLK_HZ(CLK_HZ)) u_modem (
        .clk_i(clk_i), .rst_i(rst_i),
        `SLOT(MODEM), .irq_o(slot_irq[MODEM]),
        `NPI(RADIO),
        .modem_rxd_i(modem_rxd_i), .modem_txd_o(modem_txd_o), .modem_cts_n_i(modem_cts_n_i),
        .modem_rts_n_o(modem_rts_n_o), .modem_reset_n_o(modem_reset_n_o)
    );

    memory_mcb #(.PORTS(2), .READ_FIFO(2'b00)) u_memory (
        .clk_i(clk_i), .rst_i(rst_i),
        `NPI_MEMORY,
        .mcb_cmd_en_o(mcb_cmd_en_o), .mcb_cmd_instr_o(mcb_cmd_instr_o),
        .mcb_cmd_bl_o(mcb_cmd_bl_o), .mcb_cmd_byte_addr_o(mcb_cmd_byte_addr_o),
        .mcb_cmd_full_i(mcb_cmd_full_i), .mcb_wr_en_o(mcb_wr_en_o),
        .mcb_wr_mask_o(mcb_wr_mask_o), .mcb_wr_data_o(mcb_wr_data_o),
        .mcb_wr_full_i(mcb_wr_full_i), .mcb_rd_en_o(mcb_rd_en_o),
        .mcb_rd_data_i(mcb_rd_data_i), .mcb_rd_empty_i(mcb_rd_empty_i),
        .mcb_calib_done_i(calib_done)
    );

    wire unused = &{1'b0, slot_valid[0], slot_addr[3:0], 1'b0};
endmodule
