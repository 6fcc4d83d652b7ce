// SPDX-License-Identifier: MIT
//
// soc: the chip: wiring, and its reset's flip-flop. Its cores are the lines of ip/cores.list; slots,
// memory ports and the cores' pins are numbered in the generated map_regs.vh.

`default_nettype none

module soc #(
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
    output wire        irq_o,
    // modem pins
    input  wire        modem_rxd_i, // from the modem
    output wire        modem_txd_o,
    input  wire        modem_cts_n_i,
    output wire        modem_rts_n_o,
    output wire        modem_reset_n_o,
    // pins of cores
    input  wire [31:0] core_pins_i,
    output wire [31:0] core_pins_o,
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
    `include "map_regs.vh"

    localparam SLOTS = MAP_SLOT_COUNT;
    localparam PORTS = MAP_NPI_PORT_COUNT;
    localparam SYSTEM = MAP_SLOT_SYSTEM, MODEM = MAP_SLOT_MODEM;

    // The reset as all blocks see it: from a flip-flop, so that no path leads from the pin through
    // their logic (which a simulator would follow whenever an input moves: 1.07 times slower).
    reg rst;
    initial rst = 1'b1;
    always @(posedge clk_i) rst <= rst_i;

    // Register bus
    wire        bus_valid, bus_write, bus_ready, bus_error;
    wire [9:0]  bus_addr;
    wire [31:0] bus_wdata, bus_rdata;
    wire [SLOTS-1:0]    slot_valid, slot_ready, slot_error;
    wire [32*SLOTS-1:0] slot_rdata;
    wire [4*SLOTS-1:0]  slot_addr;
    wire [31:0]         slot_wdata;
    wire                slot_write;
    wire [SLOTS-1:1]    slot_irq;

    // Memory ports
    wire [32*PORTS-1:0] npi_addr;
    wire [PORTS-1:0]    npi_addr_req, npi_addr_ack, npi_rnw, npi_wr_push, npi_wr_empty;
    wire [PORTS-1:0]    npi_wr_almost_full, npi_wr_flush, npi_rd_pop, npi_rd_empty, npi_rd_flush;
    wire [4*PORTS-1:0]  npi_size, npi_rd_word;
    wire [64*PORTS-1:0] npi_wr_data, npi_rd_data;
    wire [8*PORTS-1:0]  npi_wr_be;
    wire [PORTS-1:0]    npi_rmw, npi_init_done;

    wire [5:0] page;
    wire       access_error, error_memory, error_write, late;
    wire [9:0] error_addr;

    fsmc_bridge u_fsmc_bridge (
        .clk_i(clk_i), .rst_i(rst),
        .fsmc_a_i(fsmc_a_i), .fsmc_d_i(fsmc_d_i), .fsmc_d_o(fsmc_d_o), .fsmc_d_oe_o(fsmc_d_oe_o),
        .fsmc_ne_n_i(fsmc_ne_n_i), .fsmc_noe_n_i(fsmc_noe_n_i), .fsmc_nwe_n_i(fsmc_nwe_n_i),
        .fsmc_nbl_n_i(fsmc_nbl_n_i), .fsmc_nadv_n_i(fsmc_nadv_n_i), .fsmc_clk_i(1'b0),
        .fsmc_nwait_n_o(fsmc_nwait_n_o),
        .page_i(page), .access_error_o(access_error),
        .error_memory_o(error_memory), .error_addr_o(error_addr),
        .error_write_o(error_write), .late_o(late),
        .bus_valid_o(bus_valid), .bus_write_o(bus_write), .bus_addr_o(bus_addr),
        .bus_wdata_o(bus_wdata), .bus_ready_i(bus_ready), .bus_rdata_i(bus_rdata),
        .bus_error_i(bus_error),
        .npi_addr_o(npi_addr[32*MAP_NPI_PORT_FSMC +: 32]),
        .npi_addr_req_o(npi_addr_req[MAP_NPI_PORT_FSMC]),
        .npi_addr_ack_i(npi_addr_ack[MAP_NPI_PORT_FSMC]),
        .npi_rnw_o(npi_rnw[MAP_NPI_PORT_FSMC]),
        .npi_size_o(npi_size[4*MAP_NPI_PORT_FSMC +: 4]),
        .npi_rmw_o(npi_rmw[MAP_NPI_PORT_FSMC]),
        .npi_wr_data_o(npi_wr_data[64*MAP_NPI_PORT_FSMC +: 64]),
        .npi_wr_be_o(npi_wr_be[8*MAP_NPI_PORT_FSMC +: 8]),
        .npi_wr_push_o(npi_wr_push[MAP_NPI_PORT_FSMC]),
        .npi_wr_empty_i(npi_wr_empty[MAP_NPI_PORT_FSMC]),
        .npi_wr_almost_full_i(npi_wr_almost_full[MAP_NPI_PORT_FSMC]),
        .npi_wr_flush_o(npi_wr_flush[MAP_NPI_PORT_FSMC]),
        .npi_rd_data_i(npi_rd_data[64*MAP_NPI_PORT_FSMC +: 64]),
        .npi_rd_word_i(npi_rd_word[4*MAP_NPI_PORT_FSMC +: 4]),
        .npi_rd_pop_o(npi_rd_pop[MAP_NPI_PORT_FSMC]),
        .npi_rd_empty_i(npi_rd_empty[MAP_NPI_PORT_FSMC]),
        .npi_rd_flush_o(npi_rd_flush[MAP_NPI_PORT_FSMC]),
        .npi_init_done_i(npi_init_done[MAP_NPI_PORT_FSMC])
    );

    bus_decoder #(.SLOTS(SLOTS)) u_bus_decoder (
        .clk_i(clk_i),
        .bus_valid_i(bus_valid), .bus_write_i(bus_write), .bus_addr_i(bus_addr),
        .bus_wdata_i(bus_wdata), .bus_ready_o(bus_ready), .bus_rdata_o(bus_rdata),
        .bus_error_o(bus_error),
        .slot_valid_o(slot_valid), .slot_write_o(slot_write), .slot_addr_o(slot_addr),
        .slot_wdata_o(slot_wdata), .slot_ready_i(slot_ready), .slot_rdata_i(slot_rdata),
        .slot_error_i(slot_error)
    );

    system_slot #(.SLOTS(SLOTS), .CLK_HZ(CLK_HZ)) u_system_slot (
        .clk_i(clk_i), .rst_i(rst),
        .bus_valid_i(slot_valid[SYSTEM]), .bus_write_i(slot_write), .bus_addr_i(slot_addr[4*SYSTEM +: 4]),
        .bus_wdata_i(slot_wdata), .bus_ready_o(slot_ready[SYSTEM]),
        .bus_rdata_o(slot_rdata[32*SYSTEM +: 32]), .bus_error_o(slot_error[SYSTEM]),
        .slot_irq_i(slot_irq), .irq_o(irq_o), .page_o(page),
        .access_error_i(access_error), .error_memory_i(error_memory),
        .error_addr_i(error_addr), .error_write_i(error_write), .late_i(late)
    );

    modem #(.CLK_HZ(CLK_HZ)) u_modem (
        .clk_i(clk_i), .rst_i(rst),
        .bus_valid_i(slot_valid[MODEM]), .bus_write_i(slot_write), .bus_addr_i(slot_addr[4*MODEM +: 4]),
        .bus_wdata_i(slot_wdata), .bus_ready_o(slot_ready[MODEM]),
        .bus_rdata_o(slot_rdata[32*MODEM +: 32]), .bus_error_o(slot_error[MODEM]),
        .irq_o(slot_irq[MODEM]),
        .npi_addr_o(npi_addr[32*MAP_NPI_PORT_MODEM +: 32]),
        .npi_addr_req_o(npi_addr_req[MAP_NPI_PORT_MODEM]),
        .npi_addr_ack_i(npi_addr_ack[MAP_NPI_PORT_MODEM]),
        .npi_rnw_o(npi_rnw[MAP_NPI_PORT_MODEM]),
        .npi_size_o(npi_size[4*MAP_NPI_PORT_MODEM +: 4]),
        .npi_rmw_o(npi_rmw[MAP_NPI_PORT_MODEM]),
        .npi_wr_data_o(npi_wr_data[64*MAP_NPI_PORT_MODEM +: 64]),
        .npi_wr_be_o(npi_wr_be[8*MAP_NPI_PORT_MODEM +: 8]),
        .npi_wr_push_o(npi_wr_push[MAP_NPI_PORT_MODEM]),
        .npi_wr_empty_i(npi_wr_empty[MAP_NPI_PORT_MODEM]),
        .npi_wr_almost_full_i(npi_wr_almost_full[MAP_NPI_PORT_MODEM]),
        .npi_wr_flush_o(npi_wr_flush[MAP_NPI_PORT_MODEM]),
        .npi_rd_data_i(npi_rd_data[64*MAP_NPI_PORT_MODEM +: 64]),
        .npi_rd_word_i(npi_rd_word[4*MAP_NPI_PORT_MODEM +: 4]),
        .npi_rd_pop_o(npi_rd_pop[MAP_NPI_PORT_MODEM]),
        .npi_rd_empty_i(npi_rd_empty[MAP_NPI_PORT_MODEM]),
        .npi_rd_flush_o(npi_rd_flush[MAP_NPI_PORT_MODEM]),
        .npi_init_done_i(npi_init_done[MAP_NPI_PORT_MODEM]),
        .modem_rxd_i(modem_rxd_i), .modem_txd_o(modem_txd_o), .modem_cts_n_i(modem_cts_n_i),
        .modem_rts_n_o(modem_rts_n_o), .modem_reset_n_o(modem_reset_n_o)
    );

    // Cores: generated from ip/cores.list.
    `include "soc_cores.vh"

    wire unused = &{1'b0, slot_addr, 1'b0}; // of slots without a core

    // The bridge and the modem take what they read in the cycle it comes: no FIFO.
    localparam [31:0] NO_READ_FIFO = 1 << MAP_NPI_PORT_FSMC | 1 << MAP_NPI_PORT_MODEM;
    memory_mcb #(.PORTS(PORTS), .READ_FIFO(~NO_READ_FIFO[PORTS-1:0])) u_memory (
        .clk_i(clk_i), .rst_i(rst),
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
endmodule
