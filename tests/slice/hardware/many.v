// SPDX-License-Identifier: MIT
//
// many: a core for tests with more words than a slot: it rotates five numbers by one place, inverts
// five, and adds two.

`default_nettype none

module many (
    `include "slot_ports.vh"
    output wire        irq_o
);
    wire        core_rst, start, unused_start;
    wire [63:0] a, b, c, d, e, v, w, x, y, z;
    wire [31:0] left, right;
    reg         done;
    always @(posedge clk_i)
        done <= start && !core_rst;

    many_wrapper u_wrapper (
        `include "slot_connect.vh"
        .irq_o(irq_o), .core_rst_o(core_rst), .turn_start_o(start),
        .turn_p_a_o(a), .turn_p_b_o(b), .turn_p_c_o(c), .turn_p_d_o(d), .turn_p_e_o(e),
        .turn_q_a_o(v), .turn_q_b_o(w), .turn_q_c_o(x), .turn_q_d_o(y), .turn_q_e_o(z),
        .turn_s_a_i(b), .turn_s_b_i(c), .turn_s_c_i(d), .turn_s_d_i(e), .turn_s_e_i(a),
        .turn_result_a_i(~v), .turn_result_b_i(~w), .turn_result_c_i(~x), .turn_result_d_i(~y),
        .turn_result_e_i(~z), .turn_done_i(done), .turn_refused_i(1'b0),
        .add_start_o(unused_start), .add_a_o(left), .add_b_o(right), .add_result_i(left + right)
    );
endmodule
