// SPDX-License-Identifier: MIT
//
// calculator: the generated wrapper with the core behind it, for a slot.

`default_nettype none

module calculator (
    `include "slot_ports.vh"
    // interrupt
    output wire        irq_o
);
    wire        core_rst, set_mode_start, negate_in, negate, add_start, divide_start, divide_done, divide_refused;
    wire        get_mode_start, swap_start;
    wire [1:0]  mode_in, mode;
    wire [7:0]  shift_in, shift;
    wire [31:0] add_a, add_b, sum, divide_a, divide_b, quotient, remainder;
    wire [15:0] x, y;

    calculator_wrapper u_wrapper (
        `include "slot_connect.vh"
        .irq_o(irq_o), .core_rst_o(core_rst),
        .set_mode_start_o(set_mode_start), .set_mode_mode_o(mode_in), .set_mode_negate_o(negate_in),
        .set_mode_shift_o(shift_in),
        .get_mode_start_o(get_mode_start), .get_mode_negate_i(negate), .get_mode_shift_i(shift),
        .get_mode_result_i(mode),
        .add_start_o(add_start), .add_a_o(add_a), .add_b_o(add_b), .add_result_i(sum),
        .divide_start_o(divide_start), .divide_a_o(divide_a), .divide_b_o(divide_b),
        .divide_remainder_i(remainder), .divide_result_i(quotient), .divide_done_i(divide_done),
        .divide_refused_i(divide_refused),
        .swap_start_o(swap_start), .swap_p_x_o(x), .swap_p_y_o(y), .swap_result_x_i(y),
        .swap_result_y_i(x));

    calculator_core u_core (
        .clk_i(clk_i), .rst_i(core_rst),
        .set_mode_start_i(set_mode_start), .set_mode_mode_i(mode_in), .set_mode_negate_i(negate_in),
        .set_mode_shift_i(shift_in), .mode_o(mode), .negate_o(negate), .shift_o(shift),
        .add_start_i(add_start), .add_a_i(add_a), .add_b_i(add_b), .add_result_o(sum),
        .divide_start_i(divide_start), .divide_a_i(divide_a), .divide_b_i(divide_b),
        .divide_result_o(quotient), .divide_remainder_o(remainder), .divide_done_o(divide_done),
        .divide_refused_o(divide_refused));

    wire unused = &{1'b0, get_mode_start, swap_start, 1'b0};
endmodule
