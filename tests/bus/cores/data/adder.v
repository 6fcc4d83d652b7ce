// SPDX-License-Identifier: MIT
//
// adder: a slot with no register of its own.

`default_nettype none

module adder (
    input  wire        clk_i,
    input  wire        rst_i,
    // register bus
    input  wire        bus_valid_i,
    input  wire        bus_write_i,
    input  wire [3:0]  bus_addr_i,
    input  wire [31:0] bus_wdata_i,
    output wire        bus_ready_o,
    output wire [31:0] bus_rdata_o,
    output wire        bus_error_o,
    // interrupt
    output wire        irq_o,
    output wire        idle_o
);
    bus_registers #(.ID_VALUE(32'h41440100)) u_registers (
        .clk_i(clk_i), .rst_i(rst_i),
        .bus_valid_i(bus_valid_i), .bus_write_i(bus_write_i), .bus_addr_i(bus_addr_i),
        .bus_wdata_i(bus_wdata_i), .bus_ready_o(bus_ready_o), .bus_rdata_o(bus_rdata_o),
        .bus_error_o(bus_error_o), .value_o(value), .value_i(416'd0), .strobe_o(strobe), .wdata_o(wdata),
        .event_i(1'b0), .irq_o(irq_o)
    );
    assign idle_o = 1'b1;
    wire [415:0] value;
    wire [12:0]  strobe;
    wire [31:0]  wdata;
    wire unused = &{1'b0, value, strobe, wdata, 1'b0};
endmodule
