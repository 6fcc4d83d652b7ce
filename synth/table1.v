// SPDX-License-Identifier: MIT
//
// table1: the blocks in the paper's Table I: FSMC bridge, memory controller with two NPI ports,
// radio IP. With MODEM_API = 1, the modem controller is the same as in the chip that flies
// (hdl/soc.v).
//
// The table does not include the system slot (page register, errors). Therefore the signals of the
// system slot are ports of this module, and slot 0 answers like an empty slot.

`default_nettype none

module table1 #(
    parameter CLK_HZ    = 100000000, // Hz
    // 1: the modem controller has API frames, as in the chip that flies; 0: it has none, as in the
    // paper
    parameter MODEM_API = 0
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
    // modem pins
    input  wire        modem_rxd_i, // serial line, from the modem
    output wire        modem_txd_o,
    input  wire        modem_cts_n_i,
    output wire        modem_rts_n_o,
    output wire        modem_reset_n_o,
    // user port of the Spartan-6 MCB, 64 bits
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
    input  wire        mcb_calib_done_i,
    // system slot
    input  wire [5:0]  page_i,
    output wire        access_error_o,
    output wire        error_memory_o,
    output wire [9:0]  error_addr_o,
    output wire        error_write_o,
    output wire        late_o,
    // interrupt to the processor
    output reg         irq_o
);
    localparam SLOTS = 2, PORTS = 2, READ_FIFO = 2'b00, BYTES = 2'b10;

    // As in the chip, a flip-flop drives the reset (hdl/soc.v).
    wire rst;
    cdc_reset u_rst (.clk_i(clk_i), .rst_async_i(rst_i), .rst_o(rst));

    // register bus of all slots
    wire [SLOTS-1:0]     slot_valid, slot_ready, slot_error;
    wire [32*SLOTS-1:0]  slot_rdata;
    wire [4*SLOTS-1:0]   slot_addr;
    wire [31:0]          slot_wdata;
    wire                 slot_write;
    wire [SLOTS-1:1]     slot_irq;
    // memory ports; port 0, the port of the bridge, is inside the platform
    wire [32*PORTS-1:32] npi_addr;
    wire [PORTS-1:1]     npi_addr_req, npi_addr_ack, npi_rnw, npi_rmw, npi_wr_push, npi_wr_empty;
    wire [PORTS-1:1]     npi_wr_almost_full, npi_wr_flush, npi_rd_pop, npi_rd_empty, npi_rd_flush;
    wire [PORTS-1:1]     npi_init_done;
    wire [4*PORTS-1:4]   npi_size, npi_rd_word;
    wire [64*PORTS-1:64] npi_wr_data, npi_rd_data;
    wire [8*PORTS-1:8]   npi_wr_be;

    platform #(
        .SLOTS(SLOTS), .PORTS(PORTS), .READ_FIFO(READ_FIFO), .BYTES(BYTES)
    ) u_platform (
        .clk_i(clk_i), .rst_i(rst),
        .slot_valid_o(slot_valid), .slot_write_o(slot_write), .slot_addr_o(slot_addr),
        .slot_wdata_o(slot_wdata), .slot_ready_i(slot_ready), .slot_rdata_i(slot_rdata),
        .slot_error_i(slot_error),
        .npi_addr_i(npi_addr), .npi_addr_req_i(npi_addr_req), .npi_addr_ack_o(npi_addr_ack),
        .npi_rnw_i(npi_rnw), .npi_size_i(npi_size), .npi_rmw_i(npi_rmw),
        .npi_wr_data_i(npi_wr_data), .npi_wr_be_i(npi_wr_be), .npi_wr_push_i(npi_wr_push),
        .npi_wr_empty_o(npi_wr_empty), .npi_wr_almost_full_o(npi_wr_almost_full),
        .npi_wr_flush_i(npi_wr_flush), .npi_rd_data_o(npi_rd_data), .npi_rd_word_o(npi_rd_word),
        .npi_rd_pop_i(npi_rd_pop), .npi_rd_empty_o(npi_rd_empty), .npi_rd_flush_i(npi_rd_flush),
        .npi_init_done_o(npi_init_done),
        .page_i(page_i), .access_error_o(access_error_o), .error_memory_o(error_memory_o),
        .error_addr_o(error_addr_o), .error_write_o(error_write_o), .late_o(late_o),
        .fsmc_a_i(fsmc_a_i), .fsmc_d_i(fsmc_d_i), .fsmc_d_o(fsmc_d_o), .fsmc_d_oe_o(fsmc_d_oe_o),
        .fsmc_ne_n_i(fsmc_ne_n_i), .fsmc_noe_n_i(fsmc_noe_n_i), .fsmc_nwe_n_i(fsmc_nwe_n_i),
        .fsmc_nbl_n_i(fsmc_nbl_n_i), .fsmc_nadv_n_i(fsmc_nadv_n_i),
        .fsmc_nwait_n_o(fsmc_nwait_n_o),
        .mcb_cmd_en_o(mcb_cmd_en_o), .mcb_cmd_instr_o(mcb_cmd_instr_o),
        .mcb_cmd_bl_o(mcb_cmd_bl_o), .mcb_cmd_byte_addr_o(mcb_cmd_byte_addr_o),
        .mcb_cmd_full_i(mcb_cmd_full_i), .mcb_wr_en_o(mcb_wr_en_o),
        .mcb_wr_mask_o(mcb_wr_mask_o), .mcb_wr_data_o(mcb_wr_data_o),
        .mcb_wr_full_i(mcb_wr_full_i), .mcb_rd_en_o(mcb_rd_en_o),
        .mcb_rd_data_i(mcb_rd_data_i), .mcb_rd_empty_i(mcb_rd_empty_i),
        .mcb_calib_done_i(mcb_calib_done_i)
    );

    modem #(.CLK_HZ(CLK_HZ), .API(MODEM_API)) u_modem (
        .clk_i(clk_i), .rst_i(rst),
        .bus_valid_i(slot_valid[1]), .bus_write_i(slot_write),
        .bus_addr_i(slot_addr[4*1 +: 4]), .bus_wdata_i(slot_wdata),
        .bus_ready_o(slot_ready[1]), .bus_rdata_o(slot_rdata[32*1 +: 32]),
        .bus_error_o(slot_error[1]),
        .npi_addr_o(npi_addr[32*1 +: 32]), .npi_addr_req_o(npi_addr_req[1]),
        .npi_addr_ack_i(npi_addr_ack[1]), .npi_rnw_o(npi_rnw[1]),
        .npi_size_o(npi_size[4*1 +: 4]), .npi_rmw_o(npi_rmw[1]),
        .npi_wr_data_o(npi_wr_data[64*1 +: 64]), .npi_wr_be_o(npi_wr_be[8*1 +: 8]),
        .npi_wr_push_o(npi_wr_push[1]), .npi_wr_empty_i(npi_wr_empty[1]),
        .npi_wr_almost_full_i(npi_wr_almost_full[1]), .npi_wr_flush_o(npi_wr_flush[1]),
        .npi_rd_data_i(npi_rd_data[64*1 +: 64]), .npi_rd_word_i(npi_rd_word[4*1 +: 4]),
        .npi_rd_pop_o(npi_rd_pop[1]), .npi_rd_empty_i(npi_rd_empty[1]),
        .npi_rd_flush_o(npi_rd_flush[1]), .npi_init_done_i(npi_init_done[1]),
        .irq_o(slot_irq[1]),
        .modem_rxd_i(modem_rxd_i), .modem_txd_o(modem_txd_o), .modem_cts_n_i(modem_cts_n_i),
        .modem_rts_n_o(modem_rts_n_o), .modem_reset_n_o(modem_reset_n_o)
    );

    // slot 0 is empty: it answers immediately with an error
    assign slot_ready[0] = 1'b1, slot_error[0] = 1'b1, slot_rdata[31:0] = 32'd0;
    always @(posedge clk_i) irq_o <= slot_irq[1];
    wire unused = &{1'b0, slot_valid[0], slot_addr[3:0], 1'b0};
endmodule
