// SPDX-License-Identifier: MIT
//
// modem_uart_tx: UART transmitter, 8N1, eight ticks per bit.

`default_nettype none
`include "count_up.vh"

module modem_uart_tx (
    input  wire       clk_i,
    input  wire       rst_i,
    input  wire       tick_i,  // eight ticks per bit
    // bytes in
    input  wire       valid_i,
    input  wire [7:0] data_i,
    // high for one cycle per tick while the line is idle, and at the end of a stop bit
    output wire       ready_o,
    // pin
    output wire       txd_o
);
    reg [2:0] ticks;
    `COUNT_UP(up, 3)
    // bits that are still to be sent; the 1 of the stop bit is above the data and marks the end
    reg [8:0] bits;
    reg       last; // `bits` is 0 (while busy)
    reg       line;
    reg       busy;

    // Bytes follow each other without a gap, because an additional tick per byte would cost 1.2 %
    // of the rate.
    wire ends = busy && ticks == 3'd7 && last;
    assign ready_o = tick_i && (!busy || ends);
    assign txd_o   = line;

    always @(posedge clk_i) begin
        if (tick_i)
            ticks <= up(ticks);
        if (ready_o) begin
            ticks <= 3'd0;
            busy  <= valid_i;
            if (valid_i) begin
                line <= 1'b0;
                last <= 1'b0;
                bits <= {1'b1, data_i};
            end
        end else if (tick_i && ticks == 3'd7) begin
            bits <= {1'b0, bits[8:1]};
            line <= bits[0];
            last <= bits[8:1] == 8'd0;
        end
        if (rst_i) begin
            line  <= 1'b1;
            busy  <= 1'b0;
            ticks <= 3'd0;
            bits  <= 9'd0;
        end
    end

`ifdef FORMAL
    // Proves that a byte that was taken appears on the line as start bit, eight bits and stop bit.
    // `sent` is any byte that was taken. Each of its ten bits lasts eight ticks.
    reg past = 1'b0;
    initial assume (rst_i);
    reg [7:0] sent;
    reg [6:0] age = 7'd80; // ticks since the byte was taken; 80 when the byte is finished
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
            assert (!busy || last == (bits == 9'd0));
            assert (txd_o == (age == 7'd80 ? 1'b1 : frame[age[6:3]]));
            // A tick within a bit changes only `ticks`, so the simulator may skip it.
            if (!$past(rst_i) && $past(busy && ticks != 3'd7))
                assert ({busy, bits, line, last} == $past({busy, bits, line, last}) &&
                        ticks == $past(ticks) + {2'd0, $past(tick_i)});
            // Without a tick nothing changes.
            if (!$past(rst_i) && !$past(tick_i))
                assert ({busy, bits, line, last, ticks} ==
                        $past({busy, bits, line, last, ticks}));
        end
        cover (past && age == 7'd80 && $past(age) == 7'd79 && sent == 8'hA5);
        // reaches a byte that follows without a gap
        cover (past && age == 7'd0 && $past(age) == 7'd79);
    end
`endif
`ifdef COVER_POINTS
    next_byte_at_once: cover property (@(posedge clk_i) tick_i && ends && valid_i);
`endif
endmodule
