// SPDX-License-Identifier: MIT
//
// platform: the part that every chip has: FSMC bridge, register bus, modem, memory, and the wires
// between them.
//
// An item of a module that has clk_i, platform_ports.vh, the reset `rst`, CLK_HZ, SLOTS, PORTS,
// MODEM_API (modem's API), READ_FIFO (a bit for each memory port), and the numbers MAP_* of the
// modem's slot and of the bridge's and modem's ports. It leaves to that module: `page` (in), the
// errors of accesses, the slots' and ports' wires of wiring.vh.

`include "wiring.vh"

wire        bus_valid, bus_write, bus_ready, bus_error;
wire [9:0]  bus_addr;
wire [31:0] bus_wdata, bus_rdata;
`SLOT_WIRES(SLOTS)

`NPI_WIRES(PORTS)

wire [5:0] page;
wire       access_error, error_memory, error_write, late;
wire [9:0] error_addr;

wire calib_done;
cdc_bit u_calib_done (.clk_i(clk_i), .bit_async_i(mcb_calib_done_i), .bit_sync_o(calib_done));

memory_mcb #(.PORTS(PORTS), .READ_FIFO(READ_FIFO)) u_memory (
    .clk_i(`MEMORY_CLOCK), .rst_i(rst),
    `NPI_MEMORY,
    .mcb_cmd_en_o(mcb_cmd_en_o), .mcb_cmd_instr_o(mcb_cmd_instr_o),
    .mcb_cmd_bl_o(mcb_cmd_bl_o), .mcb_cmd_byte_addr_o(mcb_cmd_byte_addr_o),
    .mcb_cmd_full_i(mcb_cmd_full_i), .mcb_wr_en_o(mcb_wr_en_o),
    .mcb_wr_mask_o(mcb_wr_mask_o), .mcb_wr_data_o(mcb_wr_data_o),
    .mcb_wr_full_i(mcb_wr_full_i), .mcb_rd_en_o(mcb_rd_en_o),
    .mcb_rd_data_i(mcb_rd_data_i), .mcb_rd_empty_i(mcb_rd_empty_i),
    .mcb_calib_done_i(calib_done)
);

fsmc_bridge u_fsmc_bridge (
    .clk_i(`PLATFORM_CLOCK), .rst_i(rst),
    .fsmc_a_i(fsmc_a_i), .fsmc_d_i(fsmc_d_i), .fsmc_d_o(fsmc_d_o), .fsmc_d_oe_o(fsmc_d_oe_o),
    .fsmc_ne_n_i(fsmc_ne_n_i), .fsmc_noe_n_i(fsmc_noe_n_i), .fsmc_nwe_n_i(fsmc_nwe_n_i),
    .fsmc_nbl_n_i(fsmc_nbl_n_i), .fsmc_nadv_n_i(fsmc_nadv_n_i),
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
    .clk_i(`PLATFORM_CLOCK),
    .bus_valid_i(bus_valid), .bus_write_i(bus_write), .bus_addr_i(bus_addr),
    .bus_wdata_i(bus_wdata), .bus_ready_o(bus_ready), .bus_rdata_o(bus_rdata),
    .bus_error_o(bus_error),
    .slot_valid_o(slot_valid), .slot_write_o(slot_write), .slot_addr_o(slot_addr),
    .slot_wdata_o(slot_wdata), .slot_ready_i(slot_ready), .slot_rdata_i(slot_rdata),
    .slot_error_i(slot_error)
);

modem #(.CLK_HZ(CLK_HZ), .API(MODEM_API)) u_modem (
    .clk_i(`PLATFORM_CLOCK), .rst_i(rst),
    `SLOT(MAP_SLOT_MODEM),
    .irq_o(slot_irq[MAP_SLOT_MODEM]),
    `NPI(MAP_NPI_PORT_MODEM),
    .modem_rxd_i(modem_rxd_i), .modem_txd_o(modem_txd_o), .modem_cts_n_i(modem_cts_n_i),
    .modem_rts_n_o(modem_rts_n_o), .modem_reset_n_o(modem_reset_n_o)
);
