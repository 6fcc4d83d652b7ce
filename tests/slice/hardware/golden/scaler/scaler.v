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

    // The buffers in DDR3 as two streams of words, which rest here (docs/memory.md, npi_stream).
    wire        npi_read_start = 1'd0, npi_read_take = 1'd0;
    wire [31:0] npi_read_base = 32'd0, npi_write_base = 32'd0;
    wire [23:0] npi_read_words = 24'd0;
    wire        npi_write_start = 1'd0, npi_write_valid = 1'd0, npi_write_flush = 1'd0;
    wire [63:0] npi_write_data = 64'd0;
    wire [63:0] npi_read_data;
    wire [7:0]  npi_write_be = 8'hFF;
    wire        npi_read_valid, npi_read_idle, npi_write_ready, npi_write_idle;

    npi_stream u_stream (
        .clk_i(clk_i), .rst_i(rst_i), // not by core_rst: what was asked for must be taken
        .read_start_i(npi_read_start), .read_base_i(npi_read_base[31:6]),
        .read_words_i(npi_read_words), .read_stop_i(core_rst), .read_valid_o(npi_read_valid),
        .read_data_o(npi_read_data), .read_take_i(npi_read_take), .read_idle_o(npi_read_idle),
        .write_start_i(npi_write_start), .write_base_i(npi_write_base[31:6]),
        .write_valid_i(npi_write_valid), .write_data_i(npi_write_data), .write_be_i(npi_write_be),
        .write_ready_o(npi_write_ready), .write_flush_i(npi_write_flush || core_rst),
        .write_idle_o(npi_write_idle),
        .npi_addr_o(npi_addr_o), .npi_addr_req_o(npi_addr_req_o), .npi_addr_ack_i(npi_addr_ack_i),
        .npi_rnw_o(npi_rnw_o), .npi_size_o(npi_size_o), .npi_wr_data_o(npi_wr_data_o),
        .npi_wr_be_o(npi_wr_be_o), .npi_wr_push_o(npi_wr_push_o),
        .npi_wr_almost_full_i(npi_wr_almost_full_i), .npi_rd_data_i(npi_rd_data_i),
        .npi_rd_pop_o(npi_rd_pop_o), .npi_rd_empty_i(npi_rd_empty_i),
        .npi_init_done_i(npi_init_done_i)
    );
    assign {npi_rmw_o, npi_wr_flush_o, npi_rd_flush_o} = 3'd0;
    wire npi_unused = &{1'b0, npi_wr_empty_i, npi_rd_word_i, npi_read_base[5:0], npi_read_data,
                        npi_read_valid, npi_read_idle, npi_write_base[5:0], npi_write_ready,
                        npi_write_idle, 1'b0};
    wire unused = &{1'b0, core_rst, set_limit_start, set_limit_limit, peak_taken, finished_taken, shift_start, shift_list_base, shift_list_count, shift_offset, shift_shifted_base, 1'b0};
endmodule
