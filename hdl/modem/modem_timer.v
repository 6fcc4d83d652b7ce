// SPDX-License-Identifier: MIT
//
// modem_timer: counts time in units of 17/16 ms. The additional 1/16 covers the tolerance of the
// clock in the modem.

`default_nettype none

module modem_timer #(
    parameter CLK_HZ = 100000000 // frequency of clk_i in Hz, a multiple of 16000
) (
    input  wire        clk_i,
    input  wire        rst_i,
    input  wire        clear_i,
    output reg         tick_o, // high for one cycle per unit
    output reg  [11:0] time_o  // units since clear_i was high
);
    localparam [31:0] CLOCKS = CLK_HZ / 16000 * 17;
    // first value of the counter; the counter reaches 2**17 - 1 two clocks before the tick
    localparam [16:0] FIRST  = 17'd1 - CLOCKS[16:0];

    reg [16:0] clocks;

    wire unused = &{1'b0, CLOCKS[31:17], 1'b0};

    always @(posedge clk_i) begin
        {tick_o, clocks} <= {1'b0, clocks} + 18'd1;
        if (tick_o)
            time_o <= time_o + 12'd1;
        if (rst_i || clear_i || tick_o)
            clocks <= FIRST;
        if (clear_i)
            tick_o <= 1'b0;
        if (rst_i || clear_i)
            time_o <= 12'd0;
    end

`ifdef FORMAL
    // Proves that time_o counts the ticks since clear_i. Before the tick, n clocks have the same
    // effect as one step of n clocks, which the simulator computes at once.
    (* anyseq *) reg begins; // a span
    reg        past = 1'b0, spans = 1'b0;
    reg [16:0] then, n;
    reg [11:0] time_then;
    wire [17:0] sum = {1'b0, then} + {1'b0, n};
    wire [16:0] passed = clocks - FIRST;
    localparam [16:0] LAST = CLOCKS[16:0] - 17'd2;
    initial assume (rst_i);
    always @(posedge clk_i) begin
        past <= 1'b1;
        n    <= n + 17'd1;
        if (rst_i || clear_i || sum > {1'b0, LAST})
            spans <= 1'b0;
        if (begins && !rst_i && !clear_i && !tick_o) begin
            spans     <= 1'b1;
            then      <= passed;
            time_then <= time_o;
            n         <= 17'd1;
        end
        if (past) begin
            // A unit begins with clear_i and with each tick; the ticks are counted.
            assert (passed == 17'd0 || !$past(rst_i || clear_i || tick_o));
            assert (time_o ==
                    ($past(rst_i || clear_i) ? 12'd0 : $past(time_o) + {11'd0, $past(tick_o)}));
            assert (!tick_o || !$past(clear_i));
            // States the values of the registers, so that the prover need not find them.
            assert (passed <= LAST + 17'd1 && (tick_o || passed != LAST + 17'd1));
            if (spans) begin
                assert (n != 17'd0 && sum <= {1'b0, LAST} + 18'd1);
                assert ({1'b0, passed} == sum && time_o == time_then);
                // the tick occurs exactly in this clock
                assert (tick_o == (sum == {1'b0, LAST} + 18'd1));
            end
        end
        cover (past && spans && tick_o && n > 17'd1);
    end
`endif
endmodule
