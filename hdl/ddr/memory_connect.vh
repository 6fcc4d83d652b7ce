// SPDX-License-Identifier: MIT
//
// memory_connect: connects the ports of memory_ports.vh to an instance with the same ports. Include
// it at the beginning of the connection list.

        .npi_addr_o(npi_addr_o), .npi_addr_req_o(npi_addr_req_o), .npi_addr_ack_i(npi_addr_ack_i),
        .npi_rnw_o(npi_rnw_o), .npi_size_o(npi_size_o), .npi_rmw_o(npi_rmw_o),
        .npi_wr_data_o(npi_wr_data_o), .npi_wr_be_o(npi_wr_be_o), .npi_wr_push_o(npi_wr_push_o),
        .npi_wr_empty_i(npi_wr_empty_i), .npi_wr_almost_full_i(npi_wr_almost_full_i),
        .npi_wr_flush_o(npi_wr_flush_o), .npi_rd_data_i(npi_rd_data_i),
        .npi_rd_word_i(npi_rd_word_i), .npi_rd_pop_o(npi_rd_pop_o),
        .npi_rd_empty_i(npi_rd_empty_i), .npi_rd_flush_o(npi_rd_flush_o),
        .npi_init_done_i(npi_init_done_i),
