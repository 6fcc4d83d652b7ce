// SPDX-License-Identifier: MIT
//
// led: a core for tests that switches its lamp on while its button is pressed.

`default_nettype none

module led (
    `include "slot_ports.vh"
    // interrupt
    output wire        irq_o,
    // pins
    input  wire        button_i,
    output wire        led_o
);
    bus_registers #(.ID_VALUE(32'h4C450100)) u_registers (
        `include "slot_connect.vh"
        .value_o(value), .value_i(416'd0), .strobe_o(strobe), .wdata_o(wdata),
        .event_i(button_i), .irq_o(irq_o)
    );
    wire [415:0] value;
    wire [12:0]  strobe;
    wire [31:0]  wdata;
    assign led_o = button_i;
    wire unused = &{1'b0, value, strobe, wdata, 1'b0};
endmodule
