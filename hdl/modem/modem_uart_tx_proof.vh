// SPDX-License-Identifier: MIT
//
// modem_uart_tx_proof: a byte that was taken is on the line as start bit, eight bits and stop bit.
// Included at the foot of modem_uart_tx.v, only for the prover.

    // `sent` is any byte that was taken; each of its ten bits lasts eight ticks.
    reg past = 1'b0;
    initial assume (rst_i);
    reg [7:0] sent;
    reg [6:0] age = 7'd80; // ticks since the byte was taken; 80: it is over
    wire [9:0] frame = {1'b1, sent, 1'b0};
    always @(posedge clk_i) begin
        past <= 1'b1;
        if (rst_i) begin
            age <= 7'd80;
        end else if (valid_i && ready_o) begin
            sent <= data_i;
            age  <= 7'd0;
        end else if (tick_i && age != 7'd80) begin
            age <= age + 7'd1;
        end
        if (past) begin
            assert (ready_o == (tick_i && age >= 7'd79));
            assert (txd_o == (age == 7'd80 ? 1'b1 : frame[age[6:3]]));
            // A tick within a bit moves `ticks` alone: the simulator skips it.
            if (!$past(rst_i) && $past(busy && ticks != 3'd7))
                assert ({busy, bits, line} == $past({busy, bits, line}) && ticks == $past(ticks) + {2'd0, $past(tick_i)});
            // Without a tick nothing moves.
            if (!$past(rst_i) && !$past(tick_i))
                assert ({busy, bits, line, ticks} == $past({busy, bits, line, ticks}));
        end
        cover (past && age == 7'd80 && $past(age) == 7'd79 && sent == 8'hA5);
        cover (past && age == 7'd0 && $past(age) == 7'd79); // the next byte follows at once
    end
