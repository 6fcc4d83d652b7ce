// SPDX-License-Identifier: MIT
//
// calculator: a core for tests, behind a generated wrapper. It adds, swaps, and divides in 40
// clocks.
//
// It refuses to divide by 0. A division by 666 never ends, to test a core that hangs.

`default_nettype none

module calculator (
    `include "slot_ports.vh"
    // interrupt
    output wire        irq_o
);
    localparam [5:0] CLOCKS = 6'd40;

    wire        core_rst, set_mode_start, negate_in, add_start, divide_start, get_mode_start,
        swap_start;
    wire [1:0]  mode_in;
    wire [7:0]  shift_in;
    wire [31:0] add_a, add_b, divide_a, divide_b;
    wire [15:0] x, y;
    reg  [1:0]  mode;
    reg         negate;
    reg  [7:0]  shift;
    reg  [31:0] sum, quotient, remainder;
    reg  [5:0]  left; // number of clocks until the division ends

    wire        divide_done    = left == 6'd1;
    wire        divide_refused = divide_b == 32'd0;

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

    always @(posedge clk_i) begin
        if (set_mode_start) begin
            mode   <= mode_in;
            negate <= negate_in;
            shift  <= shift_in;
        end
        if (add_start)
            sum <= negate ? -(add_a + add_b) : add_a + add_b;
        if (divide_start)
            left <= CLOCKS;
        else if (left != 6'd0 && !(left == 6'd2 && divide_b == 32'd666))
            left <= left - 6'd1;
        if (left == 6'd3 && !divide_refused) begin
            quotient  <= $signed(divide_a) / $signed(divide_b);
            remainder <= $signed(divide_a) % $signed(divide_b);
        end
        if (core_rst) begin
            mode      <= 2'd0;
            negate    <= 1'b0;
            shift     <= 8'd0;
            left      <= 6'd0;
            sum       <= 32'd0;
            quotient  <= 32'd0;
            remainder <= 32'd0;
        end
    end

    wire unused = &{1'b0, get_mode_start, swap_start, 1'b0};
endmodule
