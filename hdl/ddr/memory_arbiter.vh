// SPDX-License-Identifier: MIT
//
// memory_arbiter: the npi_arbiter of every memory controller; included in the bodies of memory_mcb
// and memory_litedram, whose parameters and npi_* ports it takes. A back-end connects to the
// signals below.

    wire        cmd_valid, cmd_read, cmd_ready, wr_valid, wr_ready, rd_valid, rd_ready;
    wire [ADDR_WIDTH-1:0] cmd_addr;
    wire [4:0]  cmd_last; // words - 1
    wire [63:0] wr_data, rd_data;
    wire [7:0]  wr_be;

    npi_arbiter #(
        .PORTS(PORTS), .URGENT(URGENT), .URGENT_RUN(URGENT_RUN), .READ_FIFO(READ_FIFO),
        .BLOCK_RAM(BLOCK_RAM), .ADDR_WIDTH(ADDR_WIDTH)
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
