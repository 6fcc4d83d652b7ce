// SPDX-License-Identifier: MIT
//
// wide_echo: answers every call of ::Demo::WideEcho with zeros; registers by the generated wide_echo_wrapper.

`default_nettype none

module wide_echo (
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
    wire negate_start;
    wire [63:0] negate_v;
    wire [63:0] negate_result = 64'd0;
    wire same_start;
    wire [63:0] same_v;
    wire [63:0] same_result = 64'd0;
    wire same_float_start;
    wire [31:0] same_float_v;
    wire [31:0] same_float_result = 32'd0;
    wire pause_start;
    reg  pause_done;
    wire pause_refused = 1'd0;
    wire nothing_start;

    wide_echo_wrapper u_wrapper (
        .clk_i(clk_i), .rst_i(rst_i),
        .bus_valid_i(bus_valid_i), .bus_write_i(bus_write_i), .bus_addr_i(bus_addr_i),
        .bus_wdata_i(bus_wdata_i), .bus_ready_o(bus_ready_o), .bus_rdata_o(bus_rdata_o),
        .bus_error_o(bus_error_o), .irq_o(irq_o),
        .core_rst_o(core_rst),
        .negate_start_o(negate_start),
        .negate_v_o(negate_v),
        .negate_result_i(negate_result),
        .same_start_o(same_start),
        .same_v_o(same_v),
        .same_result_i(same_result),
        .same_float_start_o(same_float_start),
        .same_float_v_o(same_float_v),
        .same_float_result_i(same_float_result),
        .pause_start_o(pause_start),
        .pause_done_i(pause_done),
        .pause_refused_i(pause_refused),
        .nothing_start_o(nothing_start)
    );

    always @(posedge clk_i)
        pause_done <= pause_start && !core_rst;

    wire unused = &{1'b0, core_rst, negate_start, negate_v, same_start, same_v, same_float_start, same_float_v, pause_start, nothing_start, 1'b0};
endmodule
