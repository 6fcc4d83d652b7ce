// SPDX-License-Identifier: MIT
//
// memory_litedram: PORTS NPI ports (docs/memory.md) on a 64-bit native port of LiteDRAM: wiring only.

`default_nettype none

module memory_litedram #(
    parameter             PORTS      = 2, // 2..8
    parameter [PORTS-1:0] URGENT     = 0, // these: npi_arbiter
    parameter [2:0]       URGENT_RUN = 3'd3,
    parameter [PORTS-1:0] READ_FIFO  = {PORTS{1'b1}},
    parameter             BLOCK_RAM  = 1,
    parameter             ADDR_WIDTH = 27
) (
    input  wire                clk_i,
    input  wire                rst_i,
    // memory ports, packed
    input  wire [32*PORTS-1:0] npi_addr_i,
    input  wire [PORTS-1:0]    npi_addr_req_i,
    output wire [PORTS-1:0]    npi_addr_ack_o,
    input  wire [PORTS-1:0]    npi_rnw_i,
    input  wire [4*PORTS-1:0]  npi_size_i,
    input  wire [PORTS-1:0]    npi_rmw_i,
    input  wire [64*PORTS-1:0] npi_wr_data_i,
    input  wire [8*PORTS-1:0]  npi_wr_be_i,
    input  wire [PORTS-1:0]    npi_wr_push_i,
    output wire [PORTS-1:0]    npi_wr_empty_o,
    output wire [PORTS-1:0]    npi_wr_almost_full_o,
    input  wire [PORTS-1:0]    npi_wr_flush_i,
    output wire [64*PORTS-1:0] npi_rd_data_o,
    output wire [4*PORTS-1:0]  npi_rd_word_o,
    input  wire [PORTS-1:0]    npi_rd_pop_i,
    output wire [PORTS-1:0]    npi_rd_empty_o,
    input  wire [PORTS-1:0]    npi_rd_flush_i,
    output wire [PORTS-1:0]    npi_init_done_o,
    // LiteDRAM native port
    output wire                  dram_cmd_valid_o,
    input  wire                  dram_cmd_ready_i,
    output wire                  dram_cmd_we_o,
    output wire [ADDR_WIDTH-4:0] dram_cmd_addr_o,
    output wire                  dram_wdata_valid_o,
    input  wire                  dram_wdata_ready_i,
    output wire [7:0]            dram_wdata_we_o,
    output wire [63:0]           dram_wdata_data_o,
    input  wire                  dram_rdata_valid_i,
    output wire                  dram_rdata_ready_o,
    input  wire [63:0]           dram_rdata_data_i,
    input  wire                  dram_init_done_i
);
    `include "memory_arbiter.vh"

    assign npi_init_done_o = {PORTS{dram_init_done_i}};

    litedram_backend #(.ADDR_WIDTH(ADDR_WIDTH)) u_backend (
        .clk_i(clk_i), .rst_i(rst_i),
        .cmd_valid_i(cmd_valid), .cmd_read_i(cmd_read), .cmd_addr_i(cmd_addr),
        .cmd_last_i(cmd_last), .cmd_ready_o(cmd_ready),
        .wr_valid_i(wr_valid), .wr_data_i(wr_data), .wr_be_i(wr_be), .wr_ready_o(wr_ready),
        .rd_valid_o(rd_valid), .rd_data_o(rd_data), .rd_ready_i(rd_ready),
        .dram_cmd_valid_o(dram_cmd_valid_o), .dram_cmd_ready_i(dram_cmd_ready_i),
        .dram_cmd_we_o(dram_cmd_we_o), .dram_cmd_addr_o(dram_cmd_addr_o),
        .dram_wdata_valid_o(dram_wdata_valid_o), .dram_wdata_ready_i(dram_wdata_ready_i),
        .dram_wdata_we_o(dram_wdata_we_o), .dram_wdata_data_o(dram_wdata_data_o),
        .dram_rdata_valid_i(dram_rdata_valid_i), .dram_rdata_ready_o(dram_rdata_ready_o),
        .dram_rdata_data_i(dram_rdata_data_i), .dram_init_done_i(dram_init_done_i)
    );
endmodule
