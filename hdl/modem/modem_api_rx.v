// SPDX-License-Identifier: MIT
//
// modem_api_rx: extracts the contents of API frames. Contents have 1..111 bytes and start with the
// type byte. Frames of other lengths are skipped. A frame also ends if the line is silent.
//
//   7E length(2), the contents, checksum

`default_nettype none

module modem_api_rx (
    input  wire       clk_i,
    input  wire       rst_i,
    // bytes in
    input  wire       valid_i,
    input  wire [7:0] data_i,
    input  wire       error_i,  // a byte was lost
    input  wire       silent_i, // the line has been idle for three characters
    // contents out
    output wire       valid_o,  // data_i is a byte of the contents of a frame
    output reg        end_o,    // one cycle: the contents are complete and valid
    output reg        bad_o     // high for one cycle: the bytes received so far must be discarded
);
    localparam [2:0] DELIMITER = 3'd0, HIGH = 3'd1, LOW = 3'd2, DATA = 3'd3, CHECKSUM = 3'd4;

    (* fsm_encoding = "none" *) // one-hot states would take more flip-flops and LUTs
    reg [2:0] state;
    reg [6:0] left; // number of bytes before the checksum
    reg [7:0] sum;

    // the byte is a valid low byte of the length
    wire fits  = data_i != 8'd0 && !data_i[7] && data_i[6:4] != 3'd7;
    wire right = sum + data_i == 8'hFF;

    assign valid_o = valid_i && state == DATA;

    always @(posedge clk_i) begin
        end_o <= valid_i && state == CHECKSUM && right;
        bad_o <= valid_i && state == CHECKSUM && !right;
        if (valid_i) begin
            // loads data_i[6:0] in state LOW, otherwise counts down: one LUT site per bit
            left <= (state == LOW ? 7'd0 : left) + (state == LOW ? data_i[6:0] : 7'h7F);
            sum  <= state == LOW ? 8'd0 : sum + data_i;
            case (state)
                DELIMITER: if (data_i == 8'h7E)
                    state <= HIGH;
                HIGH:    state <= data_i == 8'd0 ? LOW : DELIMITER;
                LOW:     state <= fits ? DATA : DELIMITER;
                DATA: if (left == 7'd1)
                    state <= CHECKSUM;
                default: state <= DELIMITER;
            endcase
        end
        if (error_i || silent_i) begin
            state <= DELIMITER;
            bad_o <= state == DATA || state == CHECKSUM;
            end_o <= 1'b0;
        end
        if (rst_i) begin
            state <= DELIMITER;
            end_o <= 1'b0;
            bad_o <= 1'b0;
        end
    end

`ifdef FORMAL
    // Proves that the contents of a frame end once, either with end_o or with bad_o, and have as
    // many bytes as the length field of the frame states. They are valid only if the checksum is
    // correct.
    reg past = 1'b0;
    initial assume (rst_i);
    reg       open = 1'b0;  // the contents of a frame have begun and have not ended
    reg [6:0] given = 7'd0; // bytes of the contents that were delivered
    reg [6:0] length = 7'd0;
    reg [7:0] total = 8'd0; // sum of all bytes after the length, including the checksum
    always @(posedge clk_i) begin
        past <= 1'b1;
        open <= !rst_i && !end_o && !bad_o && (open || valid_o);
        if (valid_i && state == LOW) begin
            length <= data_i[6:0];
            given  <= 7'd0;
            total  <= 8'd0;
        end else begin
            given <= given + valid_o;
            if (valid_i)
                total <= total + data_i;
        end
        if (past && !$past(rst_i)) begin
            assert (!(end_o && bad_o));
            // A frame begins with the delimiter, and the high byte of its length is 0.
            if (state != $past(state) && state != DELIMITER)
                assert ($past(valid_i && !error_i && !silent_i) &&
                        (state != HIGH || $past(data_i) == 8'h7E) &&
                        (state != LOW || $past(data_i) == 8'h00));
            // Bytes are delivered only inside a frame. If a frame has delivered bytes, it ends with
            // end_o or bad_o.
            if (open && !end_o && !bad_o)
                assert (state == DATA || state == CHECKSUM);
            assert (!(end_o || bad_o) || state == DELIMITER);
            if (state == DATA || state == CHECKSUM)
                assert (length != 7'd0 && length < 7'd112 && given + left == length &&
                        (state == DATA) == (left != 7'd0) && sum == total);
            if (end_o)
                assert (given == length && length != 7'd0);
            // A complete frame ends with end_o if its checksum is correct, and with bad_o if not.
            if ($past(valid_i && state == CHECKSUM && !error_i && !silent_i))
                assert (end_o == (total == 8'hFF) && bad_o == !end_o);
        end
        cover (past && !rst_i && end_o && given == 7'd2);
        cover (past && !rst_i && bad_o && open);
    end
`endif
`ifdef COVER_POINTS
    wrong_checksum: cover property (@(posedge clk_i) valid_i && state == CHECKSUM && !right);
    too_long: cover property (@(posedge clk_i) valid_i && state == LOW && !fits);
    cut_off: cover property (@(posedge clk_i) (error_i || silent_i) && state != DELIMITER);
    delimiter_within_packet: cover property (@(posedge clk_i) valid_o && data_i == 8'h7E);
`endif
endmodule
