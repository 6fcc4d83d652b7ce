// SPDX-License-Identifier: MIT
//
// calculator_core: a core behind a generated wrapper: adds, swaps, divides in 40 clocks.
//
// Dividing by 0 is refused; dividing by 666 never ends, so that a hung core can be tested.

`default_nettype none

module calculator_core (
    input  wire        clk_i,
    input  wire        rst_i,
    // setMode, getMode
    input  wire        set_mode_start_i,
    input  wire [1:0]  set_mode_mode_i,
    input  wire        set_mode_negate_i,
    input  wire [7:0]  set_mode_shift_i,
    output reg  [1:0]  mode_o,
    output reg         negate_o,
    output reg  [7:0]  shift_o,
    // add
    input  wire        add_start_i,
    input  wire [31:0] add_a_i,
    input  wire [31:0] add_b_i,
    output reg  [31:0] add_result_o,
    // divide
    input  wire        divide_start_i,
    input  wire [31:0] divide_a_i,
    input  wire [31:0] divide_b_i,
    output reg  [31:0] divide_result_o,
    output reg  [31:0] divide_remainder_o,
    output wire        divide_done_o,
    output wire        divide_refused_o
);
    localparam [5:0] CLOCKS = 6'd40;

    reg [5:0] left; // clocks of the division

    assign divide_done_o    = left == 6'd1;
    assign divide_refused_o = divide_b_i == 32'd0;

    always @(posedge clk_i) begin
        if (set_mode_start_i) begin
            mode_o   <= set_mode_mode_i;
            negate_o <= set_mode_negate_i;
            shift_o  <= set_mode_shift_i;
        end
        if (add_start_i)
            add_result_o <= negate_o ? -(add_a_i + add_b_i) : add_a_i + add_b_i;
        if (divide_start_i)
            left <= CLOCKS;
        else if (left != 6'd0 && !(left == 6'd2 && divide_b_i == 32'd666))
            left <= left - 6'd1;
        if (left == 6'd3 && !divide_refused_o) begin
            divide_result_o    <= $signed(divide_a_i) / $signed(divide_b_i);
            divide_remainder_o <= $signed(divide_a_i) % $signed(divide_b_i);
        end
        if (rst_i) begin
            mode_o             <= 2'd0;
            negate_o           <= 1'b0;
            shift_o            <= 8'd0;
            left               <= 6'd0;
            add_result_o       <= 32'd0;
            divide_result_o    <= 32'd0;
            divide_remainder_o <= 32'd0;
        end
    end
endmodule
