// SPDX-License-Identifier: MIT
//
// modem_uart_rx: receives bytes, 8N1, with eight ticks per bit. Each bit is sampled in the last
// eighth of a bit time before its middle.

`default_nettype none
`include "count_up.vh"

module modem_uart_rx (
    input  wire       clk_i,
    input  wire       rst_i,
    input  wire       tick_i, // eight ticks per bit time
    // pin, asynchronous
    input  wire       rxd_i,
    // received bytes: one cycle each
    output reg        valid_o,
    output wire [7:0] data_o,          // valid for at least one bit time
    output reg        framing_error_o, // the stop bit was low: the byte is dropped
    output wire       idle_o           // no byte is on the line
);
    wire      rxd_sync;
    cdc_bit #(.INITIAL(1'b1)) u_rxd (.clk_i(clk_i), .bit_async_i(rxd_i), .bit_sync_o(rxd_sync));
    reg [2:0] ticks;
    `COUNT_UP(up, 3)
    // bits received so far. They enter at the top and shift down; a 1 below them reaches the
    // bottom with the eighth bit
    reg [8:0] bits;
    reg       idle;    // no start bit has been detected since the last byte
    reg       started; // the line was still low in the middle of the start bit
    reg       armed;   // the line has been high since the last byte

    wire line   = rxd_sync;
    wire sample = tick_i && ticks == 3'd7;

    assign data_o = bits[8:1];
    assign idle_o = idle && line;

    always @(posedge clk_i) begin
        valid_o         <= 1'b0;
        framing_error_o <= 1'b0;
        if (tick_i)
            ticks <= up(ticks);
        if (idle) begin
            armed  <= armed || line;
            started <= 1'b0;
            idle   <= !armed || line;
            ticks  <= 3'd4;
        end else if (sample) begin
            started <= 1'b1;
            if (!started) begin
                bits <= 9'h100;
                idle <= line; // a glitch does not count as a start bit
            end else if (!bits[0]) begin
                bits <= {line, bits[8:1]};
            end else begin
                idle            <= 1'b1;
                armed           <= line;
                valid_o         <= line;
                framing_error_o <= !line;
            end
        end
        if (rst_i) begin
            idle            <= 1'b1;
            started         <= 1'b0;
            armed           <= 1'b0;
            valid_o         <= 1'b0;
            framing_error_o <= 1'b0;
        end
    end

`ifdef FORMAL
    // Proves that a byte from a sender with the same rate is received once, during its stop bit,
    // and that a tick without a sample changes nothing else. If `sender` is 1, a model of the
    // sender advances by one tick per clock. If it is 0, ticks and line are unconstrained, and only
    // changes of registers are checked.
    (* anyconst *) reg sender;
    reg past = 1'b0;
    wire busy = !idle;
    initial assume (rst_i);
    (* anyconst *) reg [7:0] sent;
    (* hierconn, init = 1'b1 *) wire \u_rxd.bit_meta ;
    // ticks since the edge of the start bit reached the first flip-flop; 127 before a start bit
    reg [6:0] age = 7'd127;
    wire [9:0] frame = {1'b1, sent, 1'b0};
    wire [6:0] before = age - 7'd1;
    wire [3:0] got = (age - 7'd6) >> 3; // number of data bits sampled
    always @(posedge clk_i) begin
        past <= 1'b1;
        assume (tick_i || !sender);
        assume (!past || !rst_i);
        assume (!sender || \u_rxd.bit_meta  == (age < 7'd80 ? frame[age[6:3]] : 1'b1));
        if (age == 7'd127 && past && !rst_i && armed)
            age <= 7'd0;
        else if (age < 7'd90)
            age <= age + 7'd1;
        else
            age <= 7'd127;
        if (past && sender) begin
            assert (!framing_error_o);
            assert (valid_o == (age == 7'd78));
            if (valid_o)
                assert (data_o == sent);
            // States the values of the registers in each clock of a frame, so that the prover need
            // not find them.
            assert (age <= 7'd90 || age == 7'd127);
            assert (line == (age >= 7'd1 && age <= 7'd80 ? frame[before[6:3]] : 1'b1));
            assert (busy == (age >= 7'd2 && age <= 7'd77));
            if (busy)
                assert (ticks == age[2:0] + 3'd2 && started == (age >= 7'd6));
            if (busy && started)
                assert (bits == (({1'b0, sent} << (4'd9 - got)) | (9'h100 >> got)));
            assert (armed || age == 7'd127 || age > 7'd77);
        end
        // After a framing error (a break), the next byte begins only after the line has been high.
        if (past && !$past(rst_i)) begin
            assert (!framing_error_o || !armed);
            assert (!armed || $past(armed || line));
            assert (idle || !$past(idle) || $past(armed && !line));
        end
        // A tick without a sample changes only `ticks`, so the simulator may skip it. Without a
        // tick, and while the line is idle, nothing changes.
        if (past && !$past(rst_i) && $past(busy && !(tick_i && ticks == 3'd7)))
            assert (busy && {bits, started, armed} == $past({bits, started, armed}) && !valid_o &&
                    !framing_error_o &&
                    ticks == $past(ticks) + {2'd0, $past(tick_i)});
        if (past && $past(past && !rst_i && idle && line && armed && !started && ticks == 3'd4))
            assert (idle && armed && !started && ticks == 3'd4 && bits == $past(bits) && !valid_o &&
                    !framing_error_o);
        cover (past && valid_o && sent == 8'h3C);
    end
`endif
`ifdef COVER_POINTS
    framing_error: cover property (@(posedge clk_i) framing_error_o);
    glitch: cover property (@(posedge clk_i) sample && !idle && !started && line);
    break_on_the_line: cover property (@(posedge clk_i) idle && !armed && !line);
`endif
endmodule
