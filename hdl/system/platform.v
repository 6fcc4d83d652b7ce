// SPDX-License-Identifier: MIT
//
// platform: the blocks that connect all other blocks of the chip: the processor's FSMC bridge, the
// register bus with SLOTS slots, and the memory controller with PORTS ports.
//
// Memory port 0 belongs to the bridge. The signals of the slots, and of memory ports 1 and up, are
// packed. In a signal with 1 bit per slot, slot s has bit s; in a signal with 4 bits per slot, it
// has bits 4s+3..4s; with 32 bits per slot, bits 32s+31..32s (docs/bus.md, docs/memory.md).

`default_nettype none

module platform #(
    parameter             SLOTS     = 3, // number of slots, 1 to 64
    parameter             PORTS     = 2, // number of memory ports, 2 to 8
    // one bit per memory port: 1 if the port needs a FIFO for read words
    parameter [PORTS-1:0] READ_FIFO = 0,
    // one bit per memory port: 1 if the port writes only single bytes (npi_arbiter)
    parameter [PORTS-1:0] BYTES     = 0
) (
    input  wire                 clk_i,
    input  wire                 rst_i,
    // register bus, to the slots
    output wire [SLOTS-1:0]     slot_valid_o,
    output wire                 slot_write_o,
    output wire [4*SLOTS-1:0]   slot_addr_o,
    output wire [31:0]          slot_wdata_o,
    input  wire [SLOTS-1:0]     slot_ready_i,
    input  wire [32*SLOTS-1:0]  slot_rdata_i,
    input  wire [SLOTS-1:0]     slot_error_i,
    // memory ports
    input  wire [32*PORTS-1:32] npi_addr_i,
    input  wire [PORTS-1:1]     npi_addr_req_i,
    output wire [PORTS-1:1]     npi_addr_ack_o,
    input  wire [PORTS-1:1]     npi_rnw_i,
    input  wire [4*PORTS-1:4]   npi_size_i,
    input  wire [PORTS-1:1]     npi_rmw_i,
    input  wire [64*PORTS-1:64] npi_wr_data_i,
    input  wire [8*PORTS-1:8]   npi_wr_be_i,
    input  wire [PORTS-1:1]     npi_wr_push_i,
    output wire [PORTS-1:1]     npi_wr_empty_o,
    output wire [PORTS-1:1]     npi_wr_almost_full_o,
    input  wire [PORTS-1:1]     npi_wr_flush_i,
    output wire [64*PORTS-1:64] npi_rd_data_o,
    output wire [4*PORTS-1:4]   npi_rd_word_o,
    input  wire [PORTS-1:1]     npi_rd_pop_i,
    output wire [PORTS-1:1]     npi_rd_empty_o,
    input  wire [PORTS-1:1]     npi_rd_flush_i,
    output wire [PORTS-1:1]     npi_init_done_o,
    // system slot
    input  wire [5:0]           page_i,         // DDR3 address bits 31..26
    output wire                 access_error_o, // one cycle
    output wire                 error_memory_o,
    output wire [9:0]           error_addr_o,
    output wire                 error_write_o,
    output wire                 late_o,
    // FSMC pins
    input  wire [24:0]          fsmc_a_i,
    input  wire [15:0]          fsmc_d_i,
    output wire [15:0]          fsmc_d_o,
    output wire                 fsmc_d_oe_o,
    input  wire [1:0]           fsmc_ne_n_i,
    input  wire                 fsmc_noe_n_i,
    input  wire                 fsmc_nwe_n_i,
    input  wire [1:0]           fsmc_nbl_n_i,
    input  wire                 fsmc_nadv_n_i,
    output wire                 fsmc_nwait_n_o,
    // user port of the Spartan-6 MCB, 64 bits
    output wire                 mcb_cmd_en_o,
    output wire [2:0]           mcb_cmd_instr_o,
    output wire [5:0]           mcb_cmd_bl_o,
    output wire [29:0]          mcb_cmd_byte_addr_o,
    input  wire                 mcb_cmd_full_i,
    output wire                 mcb_wr_en_o,
    output wire [7:0]           mcb_wr_mask_o,
    output wire [63:0]          mcb_wr_data_o,
    input  wire                 mcb_wr_full_i,
    output wire                 mcb_rd_en_o,
    input  wire [63:0]          mcb_rd_data_i,
    input  wire                 mcb_rd_empty_i,
    input  wire                 mcb_calib_done_i // asynchronous to clk_i
);
    // register bus, from the bridge
    wire        bus_valid, bus_write, bus_ready, bus_error;
    wire [9:0]  bus_addr;
    wire [31:0] bus_wdata, bus_rdata;
    // memory port of the bridge
    wire [31:0] npi_addr;
    wire [3:0]  npi_size, npi_rd_word;
    wire [63:0] npi_wr_data, npi_rd_data;
    wire [7:0]  npi_wr_be;
    wire        npi_addr_req, npi_addr_ack, npi_rnw, npi_rmw, npi_wr_push, npi_wr_empty;
    wire        npi_wr_almost_full, npi_wr_flush, npi_rd_pop, npi_rd_empty, npi_rd_flush;
    wire        npi_init_done;

    // The macro FSMC_SYNC_BRIDGE selects the bridge that samples its pins (docs/fsmc.md). The macro
    // FSMC_MUXED builds the bridge for a board with data pins that also carry the address.
`ifdef FSMC_SYNC_BRIDGE
    fsmc_sync_bridge
`else
    fsmc_bridge
`endif
`ifdef FSMC_MUXED
    #(.MUXED(1))
`endif
    u_fsmc_bridge (
        .clk_i(clk_i), .rst_i(rst_i),
        .fsmc_a_i(fsmc_a_i), .fsmc_d_i(fsmc_d_i), .fsmc_d_o(fsmc_d_o), .fsmc_d_oe_o(fsmc_d_oe_o),
        .fsmc_ne_n_i(fsmc_ne_n_i), .fsmc_noe_n_i(fsmc_noe_n_i), .fsmc_nwe_n_i(fsmc_nwe_n_i),
        .fsmc_nbl_n_i(fsmc_nbl_n_i), .fsmc_nadv_n_i(fsmc_nadv_n_i),
        .fsmc_nwait_n_o(fsmc_nwait_n_o),
        .page_i(page_i), .access_error_o(access_error_o), .error_memory_o(error_memory_o),
        .error_addr_o(error_addr_o), .error_write_o(error_write_o), .late_o(late_o),
        .bus_valid_o(bus_valid), .bus_write_o(bus_write), .bus_addr_o(bus_addr),
        .bus_wdata_o(bus_wdata), .bus_ready_i(bus_ready), .bus_rdata_i(bus_rdata),
        .bus_error_i(bus_error),
        .npi_addr_o(npi_addr), .npi_addr_req_o(npi_addr_req), .npi_addr_ack_i(npi_addr_ack),
        .npi_rnw_o(npi_rnw), .npi_size_o(npi_size), .npi_rmw_o(npi_rmw),
        .npi_wr_data_o(npi_wr_data), .npi_wr_be_o(npi_wr_be), .npi_wr_push_o(npi_wr_push),
        .npi_wr_empty_i(npi_wr_empty), .npi_wr_almost_full_i(npi_wr_almost_full),
        .npi_wr_flush_o(npi_wr_flush), .npi_rd_data_i(npi_rd_data), .npi_rd_word_i(npi_rd_word),
        .npi_rd_pop_o(npi_rd_pop), .npi_rd_empty_i(npi_rd_empty), .npi_rd_flush_o(npi_rd_flush),
        .npi_init_done_i(npi_init_done)
    );

    bus_decoder #(.SLOTS(SLOTS)) u_bus_decoder (
        .clk_i(clk_i),
        .bus_valid_i(bus_valid), .bus_write_i(bus_write), .bus_addr_i(bus_addr),
        .bus_wdata_i(bus_wdata), .bus_ready_o(bus_ready), .bus_rdata_o(bus_rdata),
        .bus_error_o(bus_error),
        .slot_valid_o(slot_valid_o), .slot_write_o(slot_write_o), .slot_addr_o(slot_addr_o),
        .slot_wdata_o(slot_wdata_o), .slot_ready_i(slot_ready_i), .slot_rdata_i(slot_rdata_i),
        .slot_error_i(slot_error_i)
    );

    wire calib_done;
    cdc_bit u_calib_done (
        .clk_i(clk_i), .bit_async_i(mcb_calib_done_i), .bit_sync_o(calib_done)
    );

    // The bridge writes words in parts.
    memory_mcb #(
        .PORTS(PORTS), .READ_FIFO(READ_FIFO), .BYTES(BYTES), .MERGE({{(PORTS-1){1'b0}}, 1'b1})
    ) u_memory (
        .clk_i(clk_i), .rst_i(rst_i),
        .npi_addr_i({npi_addr_i, npi_addr}),
        .npi_addr_req_i({npi_addr_req_i, npi_addr_req}),
        .npi_addr_ack_o({npi_addr_ack_o, npi_addr_ack}),
        .npi_rnw_i({npi_rnw_i, npi_rnw}), .npi_size_i({npi_size_i, npi_size}),
        .npi_rmw_i({npi_rmw_i, npi_rmw}),
        .npi_wr_data_i({npi_wr_data_i, npi_wr_data}), .npi_wr_be_i({npi_wr_be_i, npi_wr_be}),
        .npi_wr_push_i({npi_wr_push_i, npi_wr_push}),
        .npi_wr_empty_o({npi_wr_empty_o, npi_wr_empty}),
        .npi_wr_almost_full_o({npi_wr_almost_full_o, npi_wr_almost_full}),
        .npi_wr_flush_i({npi_wr_flush_i, npi_wr_flush}),
        .npi_rd_data_o({npi_rd_data_o, npi_rd_data}),
        .npi_rd_word_o({npi_rd_word_o, npi_rd_word}),
        .npi_rd_pop_i({npi_rd_pop_i, npi_rd_pop}),
        .npi_rd_empty_o({npi_rd_empty_o, npi_rd_empty}),
        .npi_rd_flush_i({npi_rd_flush_i, npi_rd_flush}),
        .npi_init_done_o({npi_init_done_o, npi_init_done}),
        .mcb_cmd_en_o(mcb_cmd_en_o), .mcb_cmd_instr_o(mcb_cmd_instr_o),
        .mcb_cmd_bl_o(mcb_cmd_bl_o), .mcb_cmd_byte_addr_o(mcb_cmd_byte_addr_o),
        .mcb_cmd_full_i(mcb_cmd_full_i), .mcb_wr_en_o(mcb_wr_en_o),
        .mcb_wr_mask_o(mcb_wr_mask_o), .mcb_wr_data_o(mcb_wr_data_o),
        .mcb_wr_full_i(mcb_wr_full_i), .mcb_rd_en_o(mcb_rd_en_o),
        .mcb_rd_data_i(mcb_rd_data_i), .mcb_rd_empty_i(mcb_rd_empty_i),
        .mcb_calib_done_i(calib_done)
    );
endmodule
