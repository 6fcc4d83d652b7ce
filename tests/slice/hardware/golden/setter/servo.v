// SPDX-License-Identifier: MIT
//
// servo: answers every call of ::Demo::Servo with zeros; registers by the generated servo_wrapper.

`default_nettype none

module servo (
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
    output wire irq_o,
    // pins
    output wire [3:0] pwm_o,
    input  wire fault_i
);
    wire core_rst;
    wire set_pulse_start;
    wire [15:0] set_pulse_pulse;

    servo_wrapper u_wrapper (
        .clk_i(clk_i), .rst_i(rst_i),
        .bus_valid_i(bus_valid_i), .bus_write_i(bus_write_i), .bus_addr_i(bus_addr_i),
        .bus_wdata_i(bus_wdata_i), .bus_ready_o(bus_ready_o), .bus_rdata_o(bus_rdata_o),
        .bus_error_o(bus_error_o), .irq_o(irq_o),
        .core_rst_o(core_rst),
        .set_pulse_start_o(set_pulse_start),
        .set_pulse_pulse_o(set_pulse_pulse)
    );

    assign pwm_o = 4'd0;
    wire unused = &{1'b0, core_rst, set_pulse_start, set_pulse_pulse, fault_i, 1'b0};
endmodule
