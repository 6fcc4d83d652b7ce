// SPDX-License-Identifier: MIT
//
// store: answers every call of ::Demo::Store with zeros; registers by the generated store_wrapper.

`default_nettype none

module store (
    // clock, reset
    input  wire clk_i,
    input  wire rst_i,
    // register bus
    input  wire bus_valid_i,
    input  wire bus_write_i,
    input  wire [3:0] bus_addr_i,
    input  wire [31:0] bus_wdata_i,
    output wire bus_ready_o,
    output wire [31:0] bus_rdata_o,
    output wire bus_error_o,
    // interrupt
    output wire irq_o,
    // memory port
    output wire [31:0] npi_addr_o,
    output wire npi_addr_req_o,
    input  wire npi_addr_ack_i,
    output wire npi_rnw_o,
    output wire [3:0] npi_size_o,
    output wire npi_rmw_o,
    output wire [63:0] npi_wr_data_o,
    output wire [7:0] npi_wr_be_o,
    output wire npi_wr_push_o,
    input  wire npi_wr_empty_i,
    input  wire npi_wr_almost_full_i,
    output wire npi_wr_flush_o,
    input  wire [63:0] npi_rd_data_i,
    input  wire [3:0] npi_rd_word_i,
    output wire npi_rd_pop_o,
    input  wire npi_rd_empty_i,
    output wire npi_rd_flush_o,
    input  wire npi_init_done_i
);
    wire core_rst;
    wire exchange_start;
    wire [31:0] exchange_v_base;
    wire [1:0] exchange_v_count;
    wire [31:0] exchange_peaks_base;
    wire [2:0] exchange_peaks_count;
    wire [31:0] exchange_bytes_base;
    wire [11:0] exchange_bytes_count = 12'd0;
    wire [31:0] exchange_w_base;
    wire [1:0] exchange_w_count = 2'd0;
    wire [7:0] exchange_result = 8'd0;

    store_wrapper u_wrapper (
        .clk_i(clk_i), .rst_i(rst_i),
        .bus_valid_i(bus_valid_i), .bus_write_i(bus_write_i), .bus_addr_i(bus_addr_i),
        .bus_wdata_i(bus_wdata_i), .bus_ready_o(bus_ready_o), .bus_rdata_o(bus_rdata_o),
        .bus_error_o(bus_error_o), .irq_o(irq_o),
        .core_rst_o(core_rst),
        .exchange_start_o(exchange_start),
        .exchange_v_base_o(exchange_v_base),
        .exchange_v_count_o(exchange_v_count),
        .exchange_peaks_base_o(exchange_peaks_base),
        .exchange_peaks_count_o(exchange_peaks_count),
        .exchange_bytes_base_o(exchange_bytes_base),
        .exchange_bytes_count_i(exchange_bytes_count),
        .exchange_w_base_o(exchange_w_base),
        .exchange_w_count_i(exchange_w_count),
        .exchange_result_i(exchange_result)
    );

    assign npi_addr_o = 32'd0;
    assign npi_addr_req_o = 1'd0;
    assign npi_rnw_o = 1'd0;
    assign npi_size_o = 4'd0;
    assign npi_rmw_o = 1'd0;
    assign npi_wr_data_o = 64'd0;
    assign npi_wr_be_o = 8'd0;
    assign npi_wr_push_o = 1'd0;
    assign npi_wr_flush_o = 1'd0;
    assign npi_rd_pop_o = 1'd0;
    assign npi_rd_flush_o = 1'd0;
    wire unused = &{1'b0, core_rst, exchange_start, exchange_v_base, exchange_v_count, exchange_peaks_base, exchange_peaks_count, exchange_bytes_base, exchange_w_base, npi_addr_ack_i, npi_wr_empty_i, npi_wr_almost_full_i, npi_rd_data_i, npi_rd_word_i, npi_rd_empty_i, npi_init_done_i, 1'b0};
endmodule
