// SPDX-License-Identifier: MIT
//
// servo: generates pulses of given lengths on four pins until the fault pin is high.

`default_nettype none

module servo #(
    parameter CLK_HZ = 100000000 // Hz
) (
    `include "slot_ports.vh"
    output wire        irq_o,
    // pins
    output wire [3:0]  pwm_o,
    input  wire        fault_i
);
    localparam PERIOD = 20000; // period in microseconds, for 50 Hz

    wire        core_rst, set_pulse, clear, fault_start;
    wire [7:0]  channel;
    wire [15:0] pulse;

    servo_wrapper u_wrapper (
        `include "slot_connect.vh"
        .irq_o(irq_o), .core_rst_o(core_rst),
        .set_pulse_start_o(set_pulse), .set_pulse_channel_o(channel),
        .set_pulse_microseconds_o(pulse), .fault_start_o(fault_start), .fault_result_i(fault),
        .clear_start_o(clear)
    );

    // A microsecond takes CLK_HZ / 1000000 clocks. The remainder of this division is carried over,
    // so the pulses are exact for any CLK_HZ.
    reg [31:0] fraction;
    wire       next = fraction + 32'd1000000 >= CLK_HZ;
    reg [14:0] now; // time since the start of the period, microseconds
    reg [1:0]  fault_meta;
    reg        fault;
    reg [15:0] length [0:3];
    reg [3:0]  pulses;
    integer    i;
    assign pwm_o = pulses;

    always @(posedge clk_i) begin
        fraction   <= fraction + 32'd1000000 - (next ? CLK_HZ : 32'd0);
        fault_meta <= {fault_meta[0], fault_i};
        if (next)
            now <= {17'd0, now} == PERIOD - 1 ? 15'd0 : now + 15'd1;
        for (i = 0; i < 4; i = i + 1)
            pulses[i] <= {1'b0, now} < length[i] && !fault;
        if (set_pulse && channel < 8'd4)
            length[channel[1:0]] <= pulse;
        fault <= fault_meta[1] || (fault && !clear);
        if (rst_i || core_rst) begin
            fraction <= 32'd0;
            now      <= 15'd0;
            fault    <= 1'b0;
            pulses   <= 4'd0;
            for (i = 0; i < 4; i = i + 1)
                length[i] <= 16'd0;
        end
    end

    wire unused = &{1'b0, fault_start, 1'b0};
endmodule
