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
    wire [1:0]  slot_valid;
    wire        slot_write, modem_ready, modem_error;
    wire [7:0]  slot_addr;
    wire [31:0] slot_wdata, modem_rdata;

    wire [63:0]  npi_addr;
    wire [1:0]   npi_addr_req, npi_addr_ack, npi_rnw, npi_rmw, npi_wr_push, npi_wr_empty;
    wire [1:0]   npi_wr_almost_full, npi_wr_flush, npi_rd_pop, npi_rd_empty, npi_rd_flush;
    wire [1:0]   npi_init_done;
    wire [7:0]   npi_size, npi_rd_word;
    wire [127:0] npi_wr_data, npi_rd_data;
    wire [15:0]  npi_wr_be;

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
        .npi_addr_o(npi_addr[32*FSMC +: 32]), .npi_addr_req_o(npi_addr_req[FSMC]),
        .npi_addr_ack_i(npi_addr_ack[FSMC]), .npi_rnw_o(npi_rnw[FSMC]),
        .npi_size_o(npi_size[4*FSMC +: 4]), .npi_rmw_o(npi_rmw[FSMC]),
        .npi_wr_data_o(npi_wr_data[64*FSMC +: 64]), .npi_wr_be_o(npi_wr_be[8*FSMC +: 8]),
        .npi_wr_push_o(npi_wr_push[FSMC]), .npi_wr_empty_i(npi_wr_empty[FSMC]),
        .npi_wr_almost_full_i(npi_wr_almost_full[FSMC]), .npi_wr_flush_o(npi_wr_flush[FSMC]),
        .npi_rd_data_i(npi_rd_data[64*FSMC +: 64]), .npi_rd_word_i(npi_rd_word[4*FSMC +: 4]),
        .npi_rd_pop_o(npi_rd_pop[FSMC]), .npi_rd_empty_i(npi_rd_empty[FSMC]),
        .npi_rd_flush_o(npi_rd_flush[FSMC]), .npi_init_done_i(npi_init_done[FSMC])
    );

    bus_decoder #(.SLOTS(2)) u_bus_decoder (
        .clk_i(clk_i),
        .bus_valid_i(bus_valid), .bus_write_i(bus_write), .bus_addr_i(bus_addr),
        .bus_wdata_i(bus_wdata), .bus_ready_o(bus_ready), .bus_rdata_o(bus_rdata),
        .bus_error_o(bus_error),
        .slot_valid_o(slot_valid), .slot_write_o(slot_write), .slot_addr_o(slot_addr),
        .slot_wdata_o(slot_wdata), .slot_ready_i({modem_ready, 1'b1}),
        .slot_rdata_i({modem_rdata, 32'd0}), .slot_error_i({modem_error, 1'b1})
    );

    modem #(.CLK_HZ(CLK_HZ)) u_modem (
        .clk_i(clk_i), .rst_i(rst_i),
        .bus_valid_i(slot_valid[MODEM]), .bus_write_i(slot_write), .bus_addr_i(slot_addr[4*MODEM +: 4]),
        .bus_wdata_i(slot_wdata), .bus_ready_o(modem_ready), .bus_rdata_o(modem_rdata),
        .bus_error_o(modem_error), .irq_o(irq_o),
        .npi_addr_o(npi_addr[32*RADIO +: 32]), .npi_addr_req_o(npi_addr_req[RADIO]),
        .npi_addr_ack_i(npi_addr_ack[RADIO]), .npi_rnw_o(npi_rnw[RADIO]),
        .npi_size_o(npi_size[4*RADIO +: 4]), .npi_rmw_o(npi_rmw[RADIO]),
        .npi_wr_data_o(npi_wr_data[64*RADIO +: 64]), .npi_wr_be_o(npi_wr_be[8*RADIO +: 8]),
        .npi_wr_push_o(npi_wr_push[RADIO]), .npi_wr_empty_i(npi_wr_empty[RADIO]),
        .npi_wr_almost_full_i(npi_wr_almost_full[RADIO]), .npi_wr_flush_o(npi_wr_flush[RADIO]),
        .npi_rd_data_i(npi_rd_data[64*RADIO +: 64]), .npi_rd_word_i(npi_rd_word[4*RADIO +: 4]),
        .npi_rd_pop_o(npi_rd_pop[RADIO]), .npi_rd_empty_i(npi_rd_empty[RADIO]),
        .npi_rd_flush_o(npi_rd_flush[RADIO]), .npi_init_done_i(npi_init_done[RADIO]),
        .modem_rxd_i(modem_rxd_i), .modem_txd_o(modem_txd_o), .modem_cts_n_i(modem_cts_n_i),
        .modem_rts_n_o(modem_rts_n_o), .modem_reset_n_o(modem_reset_n_o)
    );

    memory_mcb #(.PORTS(2), .READ_FIFO(2'b00)) u_memory (
        .clk_i(clk_i), .rst_i(rst_i),
        .npi_addr_i(npi_addr), .npi_addr_req_i(npi_addr_req), .npi_addr_ack_o(npi_addr_ack),
        .npi_rnw_i(npi_rnw), .npi_size_i(npi_size), .npi_rmw_i(npi_rmw),
        .npi_wr_data_i(npi_wr_data), .npi_wr_be_i(npi_wr_be), .npi_wr_push_i(npi_wr_push),
        .npi_wr_empty_o(npi_wr_empty), .npi_wr_almost_full_o(npi_wr_almost_full),
        .npi_wr_flush_i(npi_wr_flush),
        .npi_rd_data_o(npi_rd_data), .npi_rd_word_o(npi_rd_word), .npi_rd_pop_i(npi_rd_pop),
        .npi_rd_empty_o(npi_rd_empty), .npi_rd_flush_i(npi_rd_flush),
        .npi_init_done_o(npi_init_done),
        .mcb_cmd_en_o(mcb_cmd_en_o), .mcb_cmd_instr_o(mcb_cmd_instr_o),
        .mcb_cmd_bl_o(mcb_cmd_bl_o), .mcb_cmd_byte_addr_o(mcb_cmd_byte_addr_o),
        .mcb_cmd_full_i(mcb_cmd_full_i), .mcb_wr_en_o(mcb_wr_en_o),
        .mcb_wr_mask_o(mcb_wr_mask_o), .mcb_wr_data_o(mcb_wr_data_o),
        .mcb_wr_full_i(mcb_wr_full_i), .mcb_rd_en_o(mcb_rd_en_o),
        .mcb_rd_data_i(mcb_rd_data_i), .mcb_rd_empty_i(mcb_rd_empty_i),
        .mcb_calib_done_i(mcb_calib_done_i)
    );

    wire unused = &{1'b0, slot_valid[0], slot_addr[3:0], 1'b0};
endmodule
