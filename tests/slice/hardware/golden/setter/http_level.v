// SPDX-License-Identifier: MIT
//
// http_level: answers every call of ::Demo::HTTPLevel with zeros; registers by the generated http_level_wrapper.

`default_nettype none

module http_level (
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
    wire set_level_start;
    wire [7:0] set_level_level;
    wire level_start;
    wire [7:0] level_result = 8'd0;

    http_level_wrapper u_wrapper (
        .clk_i(clk_i), .rst_i(rst_i),
        .bus_valid_i(bus_valid_i), .bus_write_i(bus_write_i), .bus_addr_i(bus_addr_i),
        .bus_wdata_i(bus_wdata_i), .bus_ready_o(bus_ready_o), .bus_rdata_o(bus_rdata_o),
        .bus_error_o(bus_error_o), .irq_o(irq_o),
        .core_rst_o(core_rst),
        .set_level_start_o(set_level_start),
        .set_level_level_o(set_level_level),
        .level_start_o(level_start),
        .level_result_i(level_result)
    );

    wire unused = &{1'b0, core_rst, set_level_start, set_level_level, level_start, 1'b0};
endmodule
