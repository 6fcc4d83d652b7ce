// SPDX-License-Identifier: MIT
//
// memory_ports: the memory port (docs/memory.md) of a requester. Include it at the beginning of a
// port list.

    output wire [31:0] npi_addr_o,
    output wire        npi_addr_req_o,
    input  wire        npi_addr_ack_i,
    output wire        npi_rnw_o,
    output wire [3:0]  npi_size_o,
    output wire        npi_rmw_o,
    output wire [63:0] npi_wr_data_o,
    output wire [7:0]  npi_wr_be_o,
    output wire        npi_wr_push_o,
    input  wire        npi_wr_empty_i,
    input  wire        npi_wr_almost_full_i,
    output wire        npi_wr_flush_o,
    input  wire [63:0] npi_rd_data_i,
    input  wire [3:0]  npi_rd_word_i,
    output wire        npi_rd_pop_o,
    input  wire        npi_rd_empty_i,
    output wire        npi_rd_flush_o,
    input  wire        npi_init_done_i,
