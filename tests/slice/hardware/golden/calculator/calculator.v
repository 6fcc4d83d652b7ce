// SPDX-License-Identifier: MIT
//
// calculator: answers every call of ::Demo::Calculator with zeros; registers by the generated calculator_wrapper.

`default_nettype none

module calculator (
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
    output wire irq_o
);
    wire core_rst;
    wire set_mode_start;
    wire [1:0] set_mode_mode;
    wire set_mode_negate;
    wire [7:0] set_mode_shift;
    wire get_mode_start;
    wire get_mode_negate = 1'd0;
    wire [7:0] get_mode_shift = 8'd0;
    wire [1:0] get_mode_result = 2'd0;
    wire add_start;
    wire [31:0] add_a;
    wire [31:0] add_b;
    wire [31:0] add_result = 32'd0;
    wire divide_start;
    wire [31:0] divide_a;
    wire [31:0] divide_b;
    wire [31:0] divide_remainder = 32'd0;
    wire [31:0] divide_result = 32'd0;
    reg  divide_done;
    wire divide_refused = 1'd0;
    wire swap_start;
    wire [15:0] swap_p_x;
    wire [15:0] swap_p_y;
    wire [15:0] swap_result_x = 16'd0;
    wire [15:0] swap_result_y = 16'd0;

    calculator_wrapper u_wrapper (
        .clk_i(clk_i), .rst_i(rst_i),
        .bus_valid_i(bus_valid_i), .bus_write_i(bus_write_i), .bus_addr_i(bus_addr_i),
        .bus_wdata_i(bus_wdata_i), .bus_ready_o(bus_ready_o), .bus_rdata_o(bus_rdata_o),
        .bus_error_o(bus_error_o), .irq_o(irq_o),
        .core_rst_o(core_rst),
        .set_mode_start_o(set_mode_start),
        .set_mode_mode_o(set_mode_mode),
        .set_mode_negate_o(set_mode_negate),
        .set_mode_shift_o(set_mode_shift),
        .get_mode_start_o(get_mode_start),
        .get_mode_negate_i(get_mode_negate),
        .get_mode_shift_i(get_mode_shift),
        .get_mode_result_i(get_mode_result),
        .add_start_o(add_start),
        .add_a_o(add_a),
        .add_b_o(add_b),
        .add_result_i(add_result),
        .divide_start_o(divide_start),
        .divide_a_o(divide_a),
        .divide_b_o(divide_b),
        .divide_remainder_i(divide_remainder),
        .divide_result_i(divide_result),
        .divide_done_i(divide_done),
        .divide_refused_i(divide_refused),
        .swap_start_o(swap_start),
        .swap_p_x_o(swap_p_x),
        .swap_p_y_o(swap_p_y),
        .swap_result_x_i(swap_result_x),
        .swap_result_y_i(swap_result_y)
    );

    always @(posedge clk_i)
        divide_done <= divide_start && !core_rst;

    wire unused = &{1'b0, core_rst, set_mode_start, set_mode_mode, set_mode_negate, set_mode_shift, get_mode_start, add_start, add_a, add_b, divide_start, divide_a, divide_b, swap_start, swap_p_x, swap_p_y, 1'b0};
endmodule
