// SPDX-License-Identifier: MIT
//
// soc: the complete chip: platform, modem, system slot, and the cores in ip/cores.list.
//
// The generated file map_regs.vh numbers the slots, the memory ports and the pins of cores. The
// generated file soc_cores.vh instantiates the cores.

`default_nettype none

module soc #(
    parameter CLK_HZ = 100000000, // Hz
    parameter GATES  = 0 // 1: each core that has an output idle_o gets a clock gate (core_gate.v)
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
    // pins of cores
    input  wire [31:0] core_pins_i,
    output wire [31:0] core_pins_o,
    // interrupt to the processor
    output reg         irq_o
);
    `include "map_regs.vh"

    localparam SLOTS = MAP_SLOT_COUNT;
    localparam PORTS = MAP_NPI_PORT_COUNT;
    localparam SYSTEM = MAP_SLOT_SYSTEM, MODEM = MAP_SLOT_MODEM, MODEM_PORT = MAP_NPI_PORT_MODEM;
    `include "memory_fifos.vh"

    // A flip-flop drives the reset of all blocks, so that no combinational path leads from the
    // reset pin through their logic. A simulator would have to evaluate such a path at each
    // change of an input, and would be 1.07 times slower.
    wire rst;
    cdc_reset u_rst (.clk_i(clk_i), .rst_async_i(rst_i), .rst_o(rst));

    wire [5:0] page;
    wire       access_error, error_memory, error_write, late;
    wire [9:0] error_addr;
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
        .page_i(page), .access_error_o(access_error), .error_memory_o(error_memory),
        .error_addr_o(error_addr), .error_write_o(error_write), .late_o(late),
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

    modem #(.CLK_HZ(CLK_HZ), .API(1)) u_modem (
        .clk_i(clk_i), .rst_i(rst),
        .bus_valid_i(slot_valid[MODEM]), .bus_write_i(slot_write),
        .bus_addr_i(slot_addr[4*MODEM +: 4]), .bus_wdata_i(slot_wdata),
        .bus_ready_o(slot_ready[MODEM]), .bus_rdata_o(slot_rdata[32*MODEM +: 32]),
        .bus_error_o(slot_error[MODEM]),
        .npi_addr_o(npi_addr[32*MODEM_PORT +: 32]), .npi_addr_req_o(npi_addr_req[MODEM_PORT]),
        .npi_addr_ack_i(npi_addr_ack[MODEM_PORT]), .npi_rnw_o(npi_rnw[MODEM_PORT]),
        .npi_size_o(npi_size[4*MODEM_PORT +: 4]), .npi_rmw_o(npi_rmw[MODEM_PORT]),
        .npi_wr_data_o(npi_wr_data[64*MODEM_PORT +: 64]),
        .npi_wr_be_o(npi_wr_be[8*MODEM_PORT +: 8]),
        .npi_wr_push_o(npi_wr_push[MODEM_PORT]), .npi_wr_empty_i(npi_wr_empty[MODEM_PORT]),
        .npi_wr_almost_full_i(npi_wr_almost_full[MODEM_PORT]),
        .npi_wr_flush_o(npi_wr_flush[MODEM_PORT]),
        .npi_rd_data_i(npi_rd_data[64*MODEM_PORT +: 64]),
        .npi_rd_word_i(npi_rd_word[4*MODEM_PORT +: 4]),
        .npi_rd_pop_o(npi_rd_pop[MODEM_PORT]), .npi_rd_empty_i(npi_rd_empty[MODEM_PORT]),
        .npi_rd_flush_o(npi_rd_flush[MODEM_PORT]), .npi_init_done_i(npi_init_done[MODEM_PORT]),
        .irq_o(slot_irq[MODEM]),
        .modem_rxd_i(modem_rxd_i), .modem_txd_o(modem_txd_o), .modem_cts_n_i(modem_cts_n_i),
        .modem_rts_n_o(modem_rts_n_o), .modem_reset_n_o(modem_reset_n_o)
    );

    `include "soc_cores.vh"

    wire irq;
    system_slot #(.SLOTS(SLOTS), .CLK_HZ(CLK_HZ), .CONTRACTS(CONTRACTS)) u_system_slot (
        .clk_i(clk_i), .rst_i(rst),
        .bus_valid_i(slot_valid[SYSTEM]), .bus_write_i(slot_write),
        .bus_addr_i(slot_addr[4*SYSTEM +: 4]), .bus_wdata_i(slot_wdata),
        .bus_ready_o(slot_ready[SYSTEM]), .bus_rdata_o(slot_rdata[32*SYSTEM +: 32]),
        .bus_error_o(slot_error[SYSTEM]),
        .slot_irq_i(slot_irq), .irq_o(irq), .page_o(page),
        .access_error_i(access_error), .error_memory_i(error_memory),
        .error_addr_i(error_addr), .error_write_i(error_write), .late_i(late)
    );
    // The interrupt input of the processor is edge-sensitive, so the interrupt line comes from a
    // flip-flop, which has no glitches.
    always @(posedge clk_i) irq_o <= irq;

    wire unused = &{1'b0, slot_addr, 1'b0}; // addresses of slots that are empty
endmodule
