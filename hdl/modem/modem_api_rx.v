// SPDX-License-Identifier: MIT
//
// modem_api_rx: takes packets out of API frames 0x81, received from a 16-bit address, and reads
// frames 0x89, the status of a sent packet. It skips other frames; silence ends any frame.
//
//   7E length(2) 81 source(2) signal options, the packet, checksum      7E 00 03 89 id status checksum

`default_nettype none

module modem_api_rx (
    input  wire       clk_i,
    input  wire       rst_i,
    // bytes in
    input  wire       valid_i,
    input  wire [7:0] data_i,
    input  wire       error_i,  // a byte was lost
    input  wire       silent_i, // the line has been idle for three characters
    // packet out
    output wire       valid_o,  // data_i is the packet's
    output reg        end_o,    // one cycle: it is complete
    output reg        bad_o,    // one cycle: drop its bytes so far
    // one cycle: a packet was given up by the modem
    output reg        unsent_o
);
    localparam [2:0] DELIMITER = 3'd0, HIGH = 3'd1, LOW = 3'd2, TYPE = 3'd3, HEAD = 3'd4, DATA = 3'd5,
                     CHECKSUM = 3'd6;
    localparam [7:0] RECEIVED = 8'h81, STATUS = 8'h89;
    localparam [7:0] LONGEST = 8'd105;

    reg [2:0] state;
    reg [7:0] left;     // bytes before the checksum
    reg [2:0] head;     // bytes of the head to pass over
    reg       received; // the frame is a packet
    reg       status;   // the frame is the status of a packet
    reg       failed;   // the status says that it was not sent
    reg [7:0] sum;

    assign valid_o = valid_i && state == DATA && received;

    always @(posedge clk_i) begin
        end_o    <= 1'b0;
        bad_o    <= 1'b0;
        unsent_o <= 1'b0;
        if (valid_i) begin
            left <= left - 8'd1;
            sum  <= sum + data_i;
            case (state)
                DELIMITER: if (data_i == 8'h7E)
                    state <= HIGH;
                HIGH: state <= data_i == 8'd0 ? LOW : DELIMITER;
                LOW: begin
                    left  <= data_i;
                    sum   <= 8'd0;
                    state <= data_i > 8'd2 && data_i <= LONGEST ? TYPE : DELIMITER;
                end
                TYPE: begin
                    received <= data_i == RECEIVED;
                    status   <= data_i == STATUS;
                    head     <= data_i == STATUS ? 3'd1 : 3'd4;
                    state    <= HEAD;
                end
                HEAD: begin
                    head <= head - 3'd1;
                    if (left == 8'd1)
                        state <= CHECKSUM;
                    else if (head == 3'd1)
                        state <= DATA;
                end
                DATA: begin
                    failed <= data_i != 8'd0;
                    if (left == 8'd1)
                        state <= CHECKSUM;
                end
                default: begin
                    state    <= DELIMITER;
                    end_o    <= received && sum + data_i == 8'hFF;
                    bad_o    <= received && sum + data_i != 8'hFF;
                    unsent_o <= status && failed && sum + data_i == 8'hFF;
                end
            endcase
        end
        if ((error_i || silent_i) && state != DELIMITER) begin
            state <= DELIMITER;
            bad_o <= received;
            end_o <= 1'b0;
        end
        if (state == DELIMITER) begin
            received <= 1'b0;
            status   <= 1'b0;
        end
        if (rst_i) begin
            state    <= DELIMITER;
            end_o    <= 1'b0;
            bad_o    <= 1'b0;
            unsent_o <= 1'b0;
        end
    end

`ifdef FORMAL
    // Each packet ends once, complete or bad.
    reg past = 1'b0;
    initial assume (rst_i);
    reg open = 1'b0; // a packet has begun and not ended
    always @(posedge clk_i) begin
        past <= 1'b1;
        open <= !rst_i && !end_o && !bad_o && (open || valid_o);
        if (past && !$past(rst_i)) begin
            assert (!(end_o && bad_o));
            // Bytes are given inside a frame only, and a frame that gave some ends good or bad.
            if (open && !end_o && !bad_o)
                assert (received && (state == DATA || state == CHECKSUM));
            assert (!(unsent_o && end_o));
            assert (state != TYPE || (left > 8'd2 && left <= LONGEST)); // no frame of another length is opened
        end
        cover (past && !rst_i && end_o && open);
        cover (past && !rst_i && unsent_o);
    end
`endif
`ifdef COVER_POINTS
    wrong_checksum: cover property (@(posedge clk_i) bad_o && state == DELIMITER);
    packet_given_up: cover property (@(posedge clk_i) unsent_o);
    other_frame: cover property (@(posedge clk_i) valid_i && state == HEAD && !received && !status);
    too_long: cover property (@(posedge clk_i) valid_i && state == LOW && data_i > LONGEST);
    cut_off: cover property (@(posedge clk_i) (error_i || silent_i) && state != DELIMITER);
    delimiter_within_packet: cover property (@(posedge clk_i) valid_o && data_i == 8'h7E);
`endif
endmodule
