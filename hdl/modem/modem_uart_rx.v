// SPDX-License-Identifier: MIT
//
// modem_uart_rx: receives bytes, 8N1, eight ticks a bit; samples each bit within an eighth before its middle.

`default_nettype none

module modem_uart_rx (
    input  wire       clk_i,
    input  wire       rst_i,
    input  wire       tick_i, // eight a bit time
    // pin, asynchronous
    input  wire       rxd_i,
    // bytes out: one cycle each
    output reg        valid_o,
    output wire [7:0] data_o,          // for a bit time at least
    output reg        framing_error_o, // the stop bit was low: the byte is dropped
    output wire       idle_o           // no byte is on the line
);
    wire      rxd_sync;
    cdc_bit #(.INITIAL(1'b1)) u_rxd (.clk_i(clk_i), .bit_async_i(rxd_i), .bit_sync_o(rxd_sync));
    reg [2:0] ticks;
    reg [8:0] bits;    // enter at the top, above a 1 that reaches the bottom with the eighth
    reg       idle;    // no start bit was seen
    reg       started; // the start bit was low in its middle, too
    reg       armed;   // the line has been high since the last byte

    wire line   = rxd_sync;
    wire sample = tick_i && ticks == 3'd7;

    assign data_o = bits[8:1];
    assign idle_o = idle && line;

    always @(posedge clk_i) begin
        valid_o         <= 1'b0;
        framing_error_o <= 1'b0;
        if (tick_i)
            ticks <= ticks + 3'd1;
        if (idle) begin
            armed  <= armed || line;
            started <= 1'b0;
            idle   <= !armed || line;
            ticks  <= 3'd4;
        end else if (sample) begin
            started <= 1'b1;
            if (!started) begin
                bits <= 9'h100;
                idle <= line; // a glitch, no start bit
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
`include "modem_uart_rx_proof.vh"
`endif
`ifdef COVER_POINTS
    framing_error: cover property (@(posedge clk_i) framing_error_o);
    glitch: cover property (@(posedge clk_i) sample && !idle && !started && line);
    break_on_the_line: cover property (@(posedge clk_i) idle && !armed && !line);
`endif
endmodule
