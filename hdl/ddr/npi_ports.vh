// SPDX-License-Identifier: MIT
//
// npi_ports: PORTS memory ports (docs/memory.md) as seen from the memory, packed: port p has bit p
// of a 1-bit signal, bits 64p+63..64p of a 64-bit signal, and so on. Include it at the beginning of
// a port list.

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
