// SPDX-License-Identifier: MIT
//
// memory_mcb: memory controller with PORTS NPI ports (docs/memory.md) on a 64-bit user port of the
// Spartan-6 MCB. It connects an npi_arbiter to an mcb_backend.

`default_nettype none

module memory_mcb #(
    parameter             PORTS      = 2, // number of ports, 2..8
    // this parameter and the following ones are explained in npi_arbiter
    parameter [PORTS-1:0] URGENT     = 0,
    parameter [2:0]       URGENT_RUN = 3'd3,
    parameter [PORTS-1:0] READ_FIFO  = {PORTS{1'b1}},
    parameter [PORTS-1:0] BYTES      = 0,
    parameter [PORTS-1:0] MERGE      = 0,
    parameter             BLOCK_RAM  = 1,
    parameter             ADDR_WIDTH = 27
) (
    input  wire                clk_i,
    input  wire                rst_i,
    `include "npi_ports.vh"
    `include "mcb_ports.vh"
    output wire [PORTS-1:0]    npi_init_done_o
);
    wire        cmd_valid, cmd_read, cmd_ready, wr_valid, wr_ready, rd_valid, rd_ready;
    wire [ADDR_WIDTH-1:0] cmd_addr;
    wire [4:0]  cmd_last; // number of words minus 1
    wire [63:0] wr_data, rd_data;
    wire [7:0]  wr_be;

    npi_arbiter #(
        .PORTS(PORTS), .URGENT(URGENT), .URGENT_RUN(URGENT_RUN), .READ_FIFO(READ_FIFO),
        .BYTES(BYTES), .MERGE(MERGE), .BLOCK_RAM(BLOCK_RAM), .ADDR_WIDTH(ADDR_WIDTH)
    ) u_arbiter (
        .clk_i(clk_i), .rst_i(rst_i),
        .npi_addr_i(npi_addr_i), .npi_addr_req_i(npi_addr_req_i), .npi_addr_ack_o(npi_addr_ack_o),
        .npi_rnw_i(npi_rnw_i), .npi_size_i(npi_size_i), .npi_rmw_i(npi_rmw_i),
        .npi_wr_data_i(npi_wr_data_i), .npi_wr_be_i(npi_wr_be_i), .npi_wr_push_i(npi_wr_push_i),
        .npi_wr_empty_o(npi_wr_empty_o), .npi_wr_almost_full_o(npi_wr_almost_full_o),
        .npi_wr_flush_i(npi_wr_flush_i),
        .npi_rd_data_o(npi_rd_data_o), .npi_rd_word_o(npi_rd_word_o),
        .npi_rd_pop_i(npi_rd_pop_i), .npi_rd_empty_o(npi_rd_empty_o),
        .npi_rd_flush_i(npi_rd_flush_i),
        .cmd_valid_o(cmd_valid), .cmd_read_o(cmd_read), .cmd_addr_o(cmd_addr),
        .cmd_last_o(cmd_last), .cmd_ready_i(cmd_ready),
        .wr_valid_o(wr_valid), .wr_data_o(wr_data), .wr_be_o(wr_be), .wr_ready_i(wr_ready),
        .rd_valid_i(rd_valid), .rd_data_i(rd_data), .rd_ready_o(rd_ready)
    );

    assign npi_init_done_o = {PORTS{mcb_calib_done_i}};

    mcb_backend #(.ADDR_WIDTH(ADDR_WIDTH)) u_backend (
        .clk_i(clk_i), .rst_i(rst_i),
        .cmd_valid_i(cmd_valid), .cmd_read_i(cmd_read), .cmd_addr_i(cmd_addr),
        .cmd_last_i(cmd_last), .cmd_ready_o(cmd_ready),
        .wr_valid_i(wr_valid), .wr_data_i(wr_data), .wr_be_i(wr_be), .wr_ready_o(wr_ready),
        .rd_valid_o(rd_valid), .rd_data_o(rd_data), .rd_ready_i(rd_ready),
        .mcb_cmd_en_o(mcb_cmd_en_o), .mcb_cmd_instr_o(mcb_cmd_instr_o),
        .mcb_cmd_bl_o(mcb_cmd_bl_o), .mcb_cmd_byte_addr_o(mcb_cmd_byte_addr_o),
        .mcb_cmd_full_i(mcb_cmd_full_i), .mcb_wr_en_o(mcb_wr_en_o),
        .mcb_wr_mask_o(mcb_wr_mask_o), .mcb_wr_data_o(mcb_wr_data_o),
        .mcb_wr_full_i(mcb_wr_full_i), .mcb_rd_en_o(mcb_rd_en_o),
        .mcb_rd_data_i(mcb_rd_data_i), .mcb_rd_empty_i(mcb_rd_empty_i),
        .mcb_calib_done_i(mcb_calib_done_i)
    );
endmodule
