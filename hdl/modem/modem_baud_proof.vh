// SPDX-License-Identifier: MIT
//
// modem_baud_proof: n clocks equal one step of n, which the simulator adds at once
// (testbench/sim/quiet_span.cpp).
// Included at the foot of modem_baud.v, only for the prover.

    // A span may begin in any clock in which no carry and no tick is on its way.
    (* anyseq *) reg begins;
    reg        past = 1'b0, spans = 1'b0;
    reg [17:0] phase_then;
    reg [4:0]  count_then;
    reg [3:0]  rate;
    reg [8:0]  n;       // clocks since the span began
    reg [27:0] product; // n times the step: it is added n times
    wire [18:0] step   = FULL - minus;
    wire [27:0] sum    = {10'd0, phase_then} + product;
    wire [27:0] before = sum - {10'd0, step[17:0]}; // a clock ago
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
            // A tick is there two clocks after its carry has come about, and at no other time.
            if (n > 9'd1)
                assert (tick_o == (before[27:18] != older[27:18] && ((count_then + older[22:18]) & hide) == 5'd0));
            else
                assert (!tick_o);
        end
        cover (past && spans && bd_i == rate && tick_o);
    end
