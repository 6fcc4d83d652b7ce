// SPDX-License-Identifier: MIT
//
// modem_uart_rx: bytes in, 8N1, each bit sampled in its middle.

`default_nettype none

module modem_uart_rx (
    input  wire        clk_i,
    input  wire        rst_i,
    input  wire [25:0] step_i,
    // pin, asynchronous
    input  wire        rxd_i,
    // bytes out: one cycle each
    output reg         valid_o,
    output reg  [7:0]  data_o,
    output reg         framing_error_o, // the stop bit was low: the byte is dropped
    output wire        idle_o           // no byte is on the line
);
    reg [1:0]  sync;
    reg [26:0] phase;
    reg [3:0]  left; // bits left, start and stop included; 0: idle
    reg        armed; // the line has been high since the last byte

    wire line = sync[1];
    assign idle_o = left == 4'd0 && line;

    always @(posedge clk_i) begin
        sync            <= {sync[0], rxd_i};
        phase           <= {1'b0, phase[25:0]} + {1'b0, step_i};
        valid_o         <= 1'b0;
        framing_error_o <= 1'b0;
        if (left == 4'd0) begin
            armed <= armed || line;
            if (armed && !line) begin
                left  <= 4'd10;
                phase <= 27'h2000000; // half a bit to the middle of the start bit
            end
        end else if (phase[26]) begin
            left   <= left - 4'd1;
            data_o <= {line, data_o[7:1]};
            if (left == 4'd10 && line) begin
                left <= 4'd0; // a glitch, no start bit
            end else if (left == 4'd1) begin
                data_o          <= data_o;
                valid_o         <= line;
                framing_error_o <= !line;
                armed           <= line;
            end
        end
        if (rst_i) begin
            sync  <= 2'b11;
            left  <= 4'd0;
            armed <= 1'b0;
            phase <= 27'd0;
            valid_o         <= 1'b0;
            framing_error_o <= 1'b0;
        end
    end

`ifdef FORMAL
    reg past = 1'b0;
    initial assume (rst_i);
    always @(posedge clk_i) begin
        past <= 1'b1;
        if (past) begin
            assert (left <= 4'd10);
            assert (!(valid_o && framing_error_o));
            if (!$past(rst_i) && (valid_o || framing_error_o))
                assert ($past(left) == 4'd1 && left == 4'd0);
        end
        cover (past && valid_o);
    end
`endif
endmodule
