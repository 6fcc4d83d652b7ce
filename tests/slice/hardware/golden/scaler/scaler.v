// SPDX-License-Identifier: MIT
//
// scaler: answers every call of ::Demo::Scaler with zeros; registers by the generated scaler_wrapper.

`default_nettype none

module scaler (
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
    wire set_limit_start;
    wire [15:0] set_limit_limit;
    wire peak_event = 1'd0;
    wire [15:0] peak_largest_index = 16'd0;
    wire [15:0] peak_largest_value = 16'd0;
    wire peak_taken;
    wire finished_event = 1'd0;
    wire finished_taken;
    wire shift_start;
    wire [31:0] shift_list_base;
    wire [6:0] shift_list_count;
    wire [15:0] shift_offset;
    wire shift_exception = 1'd0;
    wire [31:0] shift_shifted_base;
    wire [6:0] shift_shifted_count = 7'd0;
    wire [31:0] shift_result = 32'd0;
    wire [15:0] shift_overflow_index = 16'd0;
    wire [7:0] shift_overflow_code = 8'd0;
    reg  shift_done;
    wire shift_refused = 1'd0;

    scaler_wrapper u_wrapper (
        .clk_i(clk_i), .rst_i(rst_i),
        .bus_valid_i(bus_valid_i), .bus_write_i(bus_write_i), .bus_addr_i(bus_addr_i),
        .bus_wdata_i(bus_wdata_i), .bus_ready_o(bus_ready_o), .bus_rdata_o(bus_rdata_o),
        .bus_error_o(bus_error_o), .irq_o(irq_o),
        .core_rst_o(core_rst),
        .set_limit_start_o(set_limit_start),
        .set_limit_limit_o(set_limit_limit),
        .peak_event_i(peak_event),
        .peak_largest_index_i(peak_largest_index),
        .peak_largest_value_i(peak_largest_value),
        .peak_taken_o(peak_taken),
        .finished_event_i(finished_event),
        .finished_taken_o(finished_taken),
        .shift_start_o(shift_start),
        .shift_list_base_o(shift_list_base),
        .shift_list_count_o(shift_list_count),
        .shift_offset_o(shift_offset),
        .shift_exception_i(shift_exception),
        .shift_shifted_base_o(shift_shifted_base),
        .shift_shifted_count_i(shift_shifted_count),
        .shift_result_i(shift_result),
        .shift_overflow_index_i(shift_overflow_index),
        .shift_overflow_code_i(shift_overflow_code),
        .shift_done_i(shift_done),
        .shift_refused_i(shift_refused)
    );

    always @(posedge clk_i)
        shift_done <= shift_start && !core_rst;

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
    wire unused = &{1'b0, core_rst, set_limit_start, set_limit_limit, peak_taken, finished_taken, shift_start, shift_list_base, shift_list_count, shift_offset, shift_shifted_base, npi_addr_ack_i, npi_wr_empty_i, npi_wr_almost_full_i, npi_rd_data_i, npi_rd_word_i, npi_rd_empty_i, npi_init_done_i, 1'b0};
endmodule
