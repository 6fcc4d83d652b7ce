// SPDX-License-Identifier: MIT
//
// adder: a core for tests without registers.

`default_nettype none

module adder (
    `include "slot_ports.vh"
    // interrupt
    output wire        irq_o,
    output wire        idle_o
);
    bus_registers #(.ID_VALUE(32'h41440100)) u_registers (
        `include "slot_connect.vh"
        .value_o(value), .value_i(416'd0), .strobe_o(strobe), .wdata_o(wdata),
        .event_i(1'b0), .irq_o(irq_o)
    );
    assign idle_o = 1'b1;
    wire [415:0] value;
    wire [12:0]  strobe;
    wire [31:0]  wdata;
    wire unused = &{1'b0, value, strobe, wdata, 1'b0};
endmodule
