// SPDX-License-Identifier: MIT
//
// axis_bench: axis_memory at one of two ports of the MCB's controller; the other port is idle.

`default_nettype none

module axis_bench (
    input  wire        clk_i,
    input  wire        rst_i,
    input  wire        stop_i,
    output wire        idle_o,
    input  wire        read_valid_i,
    output wire        read_ready_o,
    input  wire [31:0] read_base_i,
    input  wire [23:0] read_bytes_i,
    input  wire [15:0] read_rows_i,
    input  wire [31:0] read_stride_i,
    input  wire        read_tag_i,
    output wire        m_axis_tvalid_o,
    input  wire        m_axis_tready_i,
    output wire [63:0] m_axis_tdata_o,
    output wire [7:0]  m_axis_tkeep_o,
    output wire        m_axis_tlast_o,
    output wire        m_axis_tid_o,
    input  wire        write_valid_i,
    output wire        write_ready_o,
    input  wire [31:0] write_base_i,
    input  wire [23:0] write_bytes_i,
    input  wire [15:0] write_rows_i,
    input  wire [31:0] write_stride_i,
    input  wire        write_tag_i,
    input  wire        s_axis_tvalid_i,
    output wire        s_axis_tready_o,
    input  wire [63:0] s_axis_tdata_i,
    input  wire [7:0]  s_axis_tkeep_i,
    input  wire        s_axis_tlast_i,
    output wire        done_valid_o,
    input  wire        done_ready_i,
    output wire [23:0] done_bytes_o,
    output wire        done_over_o,
    output wire        done_tag_o,
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
    wire [31:0] addr;
    wire        req, ack, rnw, rmw, wr_push, wr_empty, wr_full, wr_flush, rd_pop, rd_empty, rd_flush, init_done;
    wire        no_ack, no_empty, no_full, no_word, no_init; // of the idle port
    wire [3:0]  size, rd_word, no_place;
    wire [63:0] wr_data, rd_data, no_data;
    wire [7:0]  wr_be;

    axis_memory u_axis (
        .clk_i(clk_i), .rst_i(rst_i), .stop_i(stop_i), .idle_o(idle_o),
        .read_valid_i(read_valid_i), .read_ready_o(read_ready_o), .read_base_i(read_base_i), .read_bytes_i(read_bytes_i),
        .read_rows_i(read_rows_i), .read_stride_i(read_stride_i), .read_tag_i(read_tag_i),
        .m_axis_tvalid_o(m_axis_tvalid_o), .m_axis_tready_i(m_axis_tready_i), .m_axis_tdata_o(m_axis_tdata_o),
        .m_axis_tkeep_o(m_axis_tkeep_o), .m_axis_tlast_o(m_axis_tlast_o), .m_axis_tid_o(m_axis_tid_o),
        .write_valid_i(write_valid_i), .write_ready_o(write_ready_o), .write_base_i(write_base_i),
        .write_bytes_i(write_bytes_i), .write_rows_i(write_rows_i), .write_stride_i(write_stride_i), .write_tag_i(write_tag_i),
        .s_axis_tvalid_i(s_axis_tvalid_i), .s_axis_tready_o(s_axis_tready_o), .s_axis_tdata_i(s_axis_tdata_i),
        .s_axis_tkeep_i(s_axis_tkeep_i), .s_axis_tlast_i(s_axis_tlast_i),
        .done_valid_o(done_valid_o), .done_ready_i(done_ready_i), .done_bytes_o(done_bytes_o), .done_over_o(done_over_o),
        .done_tag_o(done_tag_o),
        .npi_addr_o(addr), .npi_addr_req_o(req), .npi_addr_ack_i(ack), .npi_rnw_o(rnw), .npi_size_o(size), .npi_rmw_o(rmw),
        .npi_wr_data_o(wr_data), .npi_wr_be_o(wr_be), .npi_wr_push_o(wr_push), .npi_wr_empty_i(wr_empty),
        .npi_wr_almost_full_i(wr_full), .npi_wr_flush_o(wr_flush), .npi_rd_data_i(rd_data), .npi_rd_word_i(rd_word),
        .npi_rd_pop_o(rd_pop), .npi_rd_empty_i(rd_empty), .npi_rd_flush_o(rd_flush), .npi_init_done_i(init_done)
    );
    memory_mcb #(.PORTS(2)) u_memory (
        .clk_i(clk_i), .rst_i(rst_i),
        .npi_addr_i({32'd0, addr}), .npi_addr_req_i({1'b0, req}), .npi_addr_ack_o({no_ack, ack}), .npi_rnw_i({1'b0, rnw}),
        .npi_size_i({4'd0, size}), .npi_rmw_i({1'b0, rmw}), .npi_wr_data_i({64'd0, wr_data}), .npi_wr_be_i({8'd0, wr_be}),
        .npi_wr_push_i({1'b0, wr_push}), .npi_wr_empty_o({no_word, wr_empty}), .npi_wr_almost_full_o({no_full, wr_full}),
        .npi_wr_flush_i({1'b0, wr_flush}), .npi_rd_data_o({no_data, rd_data}), .npi_rd_word_o({no_place, rd_word}),
        .npi_rd_pop_i({1'b0, rd_pop}), .npi_rd_empty_o({no_empty, rd_empty}), .npi_rd_flush_i({1'b0, rd_flush}),
        .npi_init_done_o({no_init, init_done}),
        .mcb_cmd_en_o(mcb_cmd_en_o), .mcb_cmd_instr_o(mcb_cmd_instr_o), .mcb_cmd_bl_o(mcb_cmd_bl_o),
        .mcb_cmd_byte_addr_o(mcb_cmd_byte_addr_o), .mcb_cmd_full_i(mcb_cmd_full_i),
        .mcb_wr_en_o(mcb_wr_en_o), .mcb_wr_mask_o(mcb_wr_mask_o), .mcb_wr_data_o(mcb_wr_data_o), .mcb_wr_full_i(mcb_wr_full_i),
        .mcb_rd_en_o(mcb_rd_en_o), .mcb_rd_data_i(mcb_rd_data_i), .mcb_rd_empty_i(mcb_rd_empty_i),
        .mcb_calib_done_i(mcb_calib_done_i)
    );

    wire unused = &{1'b0, no_ack, no_empty, no_full, no_word, no_init, no_place, no_data, 1'b0};
endmodule
