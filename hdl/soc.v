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
    output reg         irq_o,
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
    `include "wiring.vh"

    localparam SLOTS = MAP_SLOT_COUNT;
    localparam PORTS = MAP_NPI_PORT_COUNT;

    // The reset as all blocks see it: from a flip-flop, so that no path leads from the pin through
    // their logic (which a simulator would follow whenever an input moves: 1.07 times slower).
    wire rst, calib_done, irq;
    cdc_reset u_rst (.clk_i(clk_i), .rst_async_i(rst_i), .rst_o(rst));
    cdc_bit u_calib_done (.clk_i(clk_i), .bit_async_i(mcb_calib_done_i), .bit_sync_o(calib_done));
    // The processor's interrupt input looks for edges: no glitch of a LUT may reach it.
    always @(posedge clk_i) irq_o <= irq;

    // Register bus
    wire        bus_valid, bus_write, bus_ready, bus_error;
    wire [9:0]  bus_addr;
    wire [31:0] bus_wdata, bus_rdata;
    `SLOT_WIRES(SLOTS)

    `NPI_WIRES(PORTS)

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
        `NPI(MAP_NPI_PORT_FSMC)
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

    modem #(.CLK_HZ(CLK_HZ)) u_modem (
        .clk_i(clk_i), .rst_i(rst),
        `SLOT(MAP_SLOT_MODEM),
        .irq_o(slot_irq[MAP_SLOT_MODEM]),
        `NPI(MAP_NPI_PORT_MODEM),
        .modem_rxd_i(modem_rxd_i), .modem_txd_o(modem_txd_o), .modem_cts_n_i(modem_cts_n_i),
        .modem_rts_n_o(modem_rts_n_o), .modem_reset_n_o(modem_reset_n_o)
    );

    // Cores and the hashes of all slots' registers: generated from ip/cores.list.
    `include "soc_cores.vh"

    system_slot #(.SLOTS(SLOTS), .CLK_HZ(CLK_HZ), .CONTRACTS(CONTRACTS)) u_system_slot (
        .clk_i(clk_i), .rst_i(rst),
        `SLOT(MAP_SLOT_SYSTEM),
        .slot_irq_i(slot_irq), .irq_o(irq), .page_o(page),
        .access_error_i(access_error), .error_memory_i(error_memory),
        .error_addr_i(error_addr), .error_write_i(error_write), .late_i(late)
    );

    wire unused = &{1'b0, slot_addr, 1'b0}; // of slots without a core

    // The bridge and the modem take what they read in the cycle it comes: no FIFO.
    localparam [31:0] NO_READ_FIFO = 1 << MAP_NPI_PORT_FSMC | 1 << MAP_NPI_PORT_MODEM;
    memory_mcb #(.PORTS(PORTS), .READ_FIFO(~NO_READ_FIFO[PORTS-1:0])) u_memory (
        .clk_i(clk_i), .rst_i(rst),
        `NPI_MEMORY,
        .mcb_cmd_en_o(mcb_cmd_en_o), .mcb_cmd_instr_o(mcb_cmd_instr_o),
        .mcb_cmd_bl_o(mcb_cmd_bl_o), .mcb_cmd_byte_addr_o(mcb_cmd_byte_addr_o),
        .mcb_cmd_full_i(mcb_cmd_full_i), .mcb_wr_en_o(mcb_wr_en_o),
        .mcb_wr_mask_o(mcb_wr_mask_o), .mcb_wr_data_o(mcb_wr_data_o),
        .mcb_wr_full_i(mcb_wr_full_i), .mcb_rd_en_o(mcb_rd_en_o),
        .mcb_rd_data_i(mcb_rd_data_i), .mcb_rd_empty_i(mcb_rd_empty_i),
        .mcb_calib_done_i(calib_done)
    );
endmodule
