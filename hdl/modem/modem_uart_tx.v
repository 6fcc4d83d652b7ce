// SPDX-License-Identifier: MIT
//
// modem_uart_tx: bytes out, 8N1, timed by a phase step (modem_baud).

`default_nettype none

module modem_uart_tx (
    input  wire        clk_i,
    input  wire        rst_i,
    input  wire [25:0] step_i,
    // bytes in
    input  wire        valid_i,
    input  wire [7:0]  data_i,
    output wire        ready_o, // the line is idle
    // pin
    output wire        txd_o
);
    reg [26:0] phase;
    reg [8:0]  bits;  // still to come after the one on the line
    reg [3:0]  left;  // bit times left, the one on the line included
    reg        line;

    assign ready_o = left == 4'd0;
    assign txd_o   = line;

    always @(posedge clk_i) begin
        phase <= {1'b0, phase[25:0]} + {1'b0, step_i};
        if (ready_o) begin
            if (valid_i) begin
                line  <= 1'b0;
                bits  <= {1'b1, data_i};
                left  <= 4'd10;
                phase <= 27'd0;
            end
        end else if (phase[26]) begin
            line <= bits[0];
            bits <= {1'b1, bits[8:1]};
            left <= left - 4'd1;
        end
        if (rst_i) begin
            line  <= 1'b1;
            left  <= 4'd0;
            phase <= 27'd0;
        end
    end

`ifdef FORMAL
    reg past = 1'b0;
    initial assume (rst_i);
    always @(posedge clk_i) begin
        past <= 1'b1;
        if (past) begin
            assert (left <= 4'd10);
            // Idle and stop are high; a byte begins with a low start bit.
            if (left <= 4'd1)
                assert (line);
            if (left == 4'd10)
                assert (!line);
            if (!$past(rst_i) && $past(ready_o) && $past(valid_i))
                assert (!txd_o && !ready_o);
            // From the stop bit on all that will be shifted out is high.
            if (left >= 4'd2)
                assert ((bits >> (left - 4'd2)) == (9'h1FF >> (left - 4'd2)));
            if (left == 4'd1)
                assert (&bits);
        end
        cover (past && !$past(rst_i) && $past(left) == 4'd1 && left == 4'd0);
    end
`endif
endmodule
