// SPDX-License-Identifier: MIT
//
// line_tester: lets the microcontroller read and drive every pin of the FPGA, to find bad wires on
// a new board. It is a separate design (synth/ise/lines.v) and needs neither the board clock nor
// DDR3.
//
// The microcontroller uses three GPIO lines as a serial interface to a shift register: clock, data
// in and answer. There are three such channels on separate lines, so that at least one channel
// works even if a wire is broken or two wires are shorted.
//
//   start       data line falls while the clock line is high: the levels of all pins are captured
//   bits        sampled at rising edges of the clock line, lowest bit first; the data line may
//               change only while the clock line is low. The answer's bit is valid before that
//               edge.
//   stop        data line rises while the clock line is high: the pins are driven with the values
//               sent, if the frame has the right length and began with the key
//
//   bits sent       16 KEY, LINES values, LINES output enables, a 0
//   bits answered   16 not driven (while the key is sent), 16 ID, 16 clock count, 8 NWE count,
//                   levels of LINES pins, levels of the modem's 5 pins EARLY clocks after the last
//                   stop
//
// The clock count is in units of 64 board clocks. The levels EARLY clocks after the
// last stop distinguish a driver, which moves a released pin immediately, from a pull resistor,
// which needs a microsecond for this.
//
//   pin  0..15 D0..D15   16..40 A0..A24   41 NE1   42 NE2   43 NOE   44 NWE   45 NBL0   46 NBL1
//        47 NADV   48 NWAIT   49 IRQ   50 MODEM_RXD   51 MODEM_TXD   52 MODEM_CTS   53 MODEM_RTS
//        54 MODEM_RESET

`default_nettype none

module line_tester #(
    parameter LINES     = 55,
    // log2 of the number of clocks in one unit of the clock count; simulations use a smaller value
    parameter UNIT_LOG2 = 6
) (
    input  wire             osc_i, // the FPGA's internal oscillator, about 50 MHz
    input  wire             clk_i, // clock of the board, which is only measured
    input  wire [LINES-1:0] pins_i,
    output wire [LINES-1:0] pins_o,
    output wire [LINES-1:0] pins_oe_o
);
    localparam [15:0] KEY = 16'h1CE5, ID = 16'h4C54;
    localparam D0 = 0, NE1 = 41, NE2 = 42, NOE = 43, NWE = 44, NBL0 = 45, NBL1 = 46, NWAIT = 48,
               IRQ = 49;
    localparam MODEM = 50, MODEM_PINS = 5, EARLY = 6;
    localparam SENT = 17 + 2 * LINES, ANSWER = 40 + LINES + MODEM_PINS;

    // ---- clock of the board: the upper bit of the divider changes once per unit of the count
    reg  [UNIT_LOG2:0] divider = 0;
    always @(posedge clk_i) divider <= divider + 1;
    wire       slow;
    reg        slow_was = 1'b0;
    reg [15:0] clocks = 16'd0;
    cdc_bit u_slow (.clk_i(osc_i), .bit_async_i(divider[UNIT_LOG2]), .bit_sync_o(slow));
    always @(posedge osc_i) begin
        slow_was <= slow;
        if (slow != slow_was)
            clocks <= clocks + 16'd1;
    end

    // ---- counter of NWE's rising edges. It also counts edges that follow each other closely, so a
    // strobe that rings is counted more than once. The microcontroller changes NWE only between
    // frames.
    reg [7:0] edges = 8'd0;
    always @(posedge pins_i[NWE]) edges <= edges + 8'd1;
    // The count is stable when it is captured, because a frame starts at least two clocks after the
    // last edge of NWE.
    wire [7:0] nwe_count;
    cdc_copy #(.WIDTH(8)) u_edges (.clk_i(osc_i), .bus_async_i(edges), .bus_sync_o(nwe_count));

    // ---- channels: current level of each clock and data line, and its level one clock ago
    wire [2:0] clock, data;
    reg  [2:0] clock_was = 3'd0, data_was = 3'd0;
    cdc_bit #(.WIDTH(3)) u_clock (.clk_i(osc_i),
        .bit_async_i({pins_i[NBL0], pins_i[NOE], pins_i[NE1]}), .bit_sync_o(clock));
    cdc_bit #(.WIDTH(3)) u_data (.clk_i(osc_i),
        .bit_async_i({pins_i[NBL1], pins_i[NWE], pins_i[NE2]}), .bit_sync_o(data));
    always @(posedge osc_i) begin
        clock_was <= clock;
        data_was  <= data;
    end
    wire [2:0] steady = clock & clock_was;
    wire [2:0] starts = steady & data_was & ~data;
    wire [2:0] stops  = steady & ~data_was & data;
    wire [2:0] rises  = clock & ~clock_was;

    // ---- frame
    // channel on which the current frame arrives, one-hot; 0 between frames
    reg [2:0]        channel = 3'd0;
    reg [2*LINES:0]  sent = 0;       // bits of the last frame
    reg [ANSWER-1:0] answer = 0;
    reg [7:0]        count = 8'd0;   // bits taken
    reg              keyed = 1'b0;   // the current frame began with the key
    reg [LINES-1:0]  value = 0, enable = 0;
    wire             bit_in = |(channel & data);
    reg [3:0]            since = 4'd0; // number of clocks since the pins were driven, up to EARLY
    reg [MODEM_PINS-1:0] early = 0;

    always @(posedge osc_i) begin
        if (since != EARLY)
            since <= since + 4'd1;
        if (since == EARLY - 1)
            early <= pins_i[MODEM +: MODEM_PINS];
        if (|starts) begin
            channel <= starts & (~starts + 3'd1);
            answer  <= {early, pins_i, nwe_count, clocks, ID};
            count   <= 8'd0;
            keyed   <= 1'b0;
        end else if (|(channel & stops)) begin
            channel <= 3'd0;
            if (keyed && count == SENT) begin
                {enable, value} <= sent[2*LINES-1:0];
                since           <= 4'd0;
            end
        end else if (|(channel & rises)) begin
            sent  <= {bit_in, sent[2*LINES:1]};
            count <= count + 8'd1;
            if (count == 8'd15)
                keyed <= {bit_in, sent[2*LINES -: 15]} == KEY;
            if (keyed)
                answer <= {1'b0, answer[ANSWER-1:1]};
            if (&count)
                channel <= 3'd0;
        end
    end

    // ---- pins: the answer line of a channel is driven during a frame that began with the key
    wire [2:0] answers = channel & {3{keyed}};
    wire [LINES-1:0] line = {{LINES-1{1'b0}}, 1'b1};
    wire [LINES-1:0] busy = (answers[0] ? line << NWAIT : 0) | (answers[1] ? line << IRQ : 0) |
                            (answers[2] ? line << D0 : 0);
    assign pins_oe_o = enable | busy;
    assign pins_o    = (value & ~busy) | (busy & {LINES{answer[0]}});
endmodule
