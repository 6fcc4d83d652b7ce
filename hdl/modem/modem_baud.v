// SPDX-License-Identifier: MIT
//
// modem_baud: baud rate generator: eight ticks per bit, from a phase accumulator; rates below 38400
// are 38400 / 2**n.
//
// Error of the mean rate: below 0.1 % for every code and every clock from 2 to 100 MHz.
//
//   bd_i   0..5    1200 << bd_i
//          6       57,600
//          7       111,111, which the modem calls 115200
//          8..15   250,000

`default_nettype none
`include "count_up.vh"

module modem_baud #(
    parameter CLK_HZ = 100000000 // frequency of clk_i in Hz, at least 2 MHz
) (
    input  wire       clk_i,
    input  wire       rst_i,
    input  wire [3:0] bd_i,
    output reg        tick_o
);
    // width of the phase, bits; for 38400 baud at 100 MHz the step is 805 / 2**18, with an error
    // below 0.04 %
    localparam WIDTH = 18;
    // Steps of the phase per clock: 8 * rate * 2**18 / CLK_HZ, rounded.
    localparam [31:0] KHZ   = CLK_HZ / 1000,
                      BASE  = (32'd80530637 + KHZ / 2) / KHZ,
                      BD6   = (32'd120795955 + KHZ / 2) / KHZ,
                      BD7   = (32'd233016361 + KHZ / 2) / KHZ,
                      EXACT = (32'd524288000 + KHZ / 2) / KHZ,
                      BD8   = EXACT >> WIDTH != 32'd0 ? (32'd1 << WIDTH) - 32'd1 : EXACT;

    reg  [WIDTH:0]   phase; // phase; the highest bit is the carry
    reg  [4:0]       count; // counts ticks of 38400 baud
    `COUNT_UP(up, 5)

    // A chain of conditions selects the step, because Yosys turns a case into a ROM with registers
    // before it. The step is subtracted: only for a subtraction, Yosys always connects `phase` to
    // the carry chain's input that needs no LUT.
    localparam [WIDTH:0] FULL = 0;
    wire [WIDTH:0] minus = bd_i[3] ? FULL - BD8[WIDTH:0] : bd_i == 4'd7 ? FULL - BD7[WIDTH:0]
                         : bd_i == 4'd6 ? FULL - BD6[WIDTH:0] : FULL - BASE[WIDTH:0];
    // These bits of `count` must be 0 for a tick.
    wire [4:0] hide = {bd_i < 4'd1, bd_i < 4'd2, bd_i < 4'd3, bd_i < 4'd4, bd_i < 4'd5};

    always @(posedge clk_i) begin
        phase <= {1'b0, phase[WIDTH-1:0]} - minus;
        if (phase[WIDTH])
            count <= up(count);
        tick_o <= phase[WIDTH] && (count & hide) == 5'd0;
        if (rst_i) begin
            phase <= 0;
            count <= 5'd0;
            tick_o <= 1'b0;
        end
    end

`ifdef FORMAL
    // Proves that n clocks have the same effect as one step of n clocks, which the simulator
    // computes at once (testbench/sim/quiet_span.cpp). Such a span may begin in any clock without a
    // carry and without a tick.
    (* anyseq *) reg begins;
    reg        past = 1'b0, spans = 1'b0;
    reg [17:0] phase_then;
    reg [4:0]  count_then;
    reg [3:0]  rate;
    reg [8:0]  n;       // clocks since the span began
    reg [27:0] product; // n times the step of the phase
    wire [18:0] step   = FULL - minus;
    wire [27:0] sum    = {10'd0, phase_then} + product;
    wire [27:0] before = sum - {10'd0, step[17:0]}; // the sum in the previous clock
    wire [27:0] older  = before - {10'd0, step[17:0]};
    initial assume (rst_i);
    always @(posedge clk_i) begin
        past <= 1'b1;
        if (rst_i || bd_i != rate || n == 9'd511) begin
            spans <= 1'b0;
        end
        if (begins && !rst_i && !phase[WIDTH] && !tick_o) begin
            spans      <= 1'b1;
            phase_then <= phase[WIDTH-1:0];
            count_then <= count;
            rate       <= bd_i;
            n          <= 9'd1;
            product    <= {10'd0, step[17:0]};
        end else begin
            n       <= n + 9'd1;
            product <= product + {10'd0, step[17:0]};
        end
        if (past && spans && bd_i == rate) begin
            assert (n != 9'd0 && step < 19'd262144);
            assert (phase[WIDTH-1:0] == sum[17:0]);
            assert (phase[WIDTH] == (sum[27:18] != before[27:18]));
            assert (count == count_then + before[22:18]);
            // A tick occurs two clocks after its carry, and at no other time.
            if (n > 9'd1)
                assert (tick_o ==
                        (before[27:18] != older[27:18] &&
                         ((count_then + older[22:18]) & hide) == 5'd0));
            else
                assert (!tick_o);
        end
        cover (past && spans && bd_i == rate && tick_o);
    end
    // The number of carries per second is correct within 0.1 %. A bit has eight ticks, so this
    // number is eight times the baud rate (for BASE: eight times 38400).
    localparam [63:0] SECOND = CLK_HZ;
    function near(input [31:0] phase_step, input [63:0] wanted); // Returns whether a step gives the
                                                                 // wanted number of carries per
                                                                 // second, times 2**WIDTH.
        near = {32'd0, phase_step} * SECOND * 64'd1000 >= wanted * 64'd999 &&
            {32'd0, phase_step} * SECOND * 64'd1000 <= wanted * 64'd1001;
    endfunction
    localparam [63:0] BAUD = 64'd8 << WIDTH;
    always @* begin
        assert (near(BASE, BAUD * 38400) && near(BD6, BAUD * 57600));
        assert (near(BD7, BAUD * 1000000 / 9) && near(BD8, BAUD * 250000));
        assert (step == (bd_i >= 4'd8 ? BD8 : bd_i == 4'd7 ? BD7 : bd_i == 4'd6 ? BD6 : BASE));
        assert (hide == 5'h1F >> bd_i);
    end
`endif
endmodule
