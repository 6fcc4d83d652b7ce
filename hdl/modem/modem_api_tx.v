// SPDX-License-Identifier: MIT
//
// modem_api_tx: wraps a packet into an API frame, or passes it through unchanged.
//
//   7E 00 length, the packet, checksum

`default_nettype none
`include "count_up.vh"

module modem_api_tx (
    input  wire       clk_i,
    input  wire       rst_i,
    // 1: API frames; 0: packets pass unchanged. May change only during reset
    input  wire       api_i,
    // packet to send; valid only while the modem accepts bytes
    input  wire       valid_i,
    input  wire [7:0] data_i,
    input  wire       last_i,
    input  wire [6:0] bytes_i, // length of the packet in bytes
    output wire       ready_o,
    // bytes out
    input  wire       cts_i,
    output wire       valid_o,
    output reg  [7:0] data_o,  // 0 while valid_o is low
    input  wire       ready_i
);
    localparam [2:0] DATA = 3'd3, CHECKSUM = 3'd4;

    // position in the frame: 0..2 for the first three bytes, then DATA, then CHECKSUM
    reg [2:0] place;
    `COUNT_UP(up, 3)
    reg [7:0] sum;

    wire taken = valid_o && ready_i;

    assign valid_o = place == CHECKSUM ? cts_i : valid_i;
    assign ready_o = ready_i && place == DATA;

    // The byte at position 1 is 0, so it also serves as the output without a byte.
    wire [2:0] shown = valid_o ? place : 3'd1;
    always @* begin
        case (shown)
            3'd0:     data_o = 8'h7E;
            3'd1:     data_o = 8'h00;
            3'd2:     data_o = {1'b0, bytes_i};
            CHECKSUM: data_o = ~sum;
            default:  data_o = data_i;
        endcase
    end

    always @(posedge clk_i) begin
        if (taken) begin
            sum <= place == DATA ? sum + data_i : 8'd0;
            if (place == CHECKSUM)
                place <= 3'd0;
            else if (place != DATA || (last_i && api_i))
                place <= up(place);
        end
        if (rst_i)
            place <= api_i ? 3'd0 : DATA;
    end

`ifdef FORMAL
    // Proves that every frame has a correct length and a correct checksum, and that no byte is sent
    // while the modem accepts none. While api_i is 0, no frame is built: only the bytes of the
    // packet are sent, unchanged.
    reg past = 1'b0;
    initial assume (rst_i);
    reg [7:0] total = 8'd0; // sum of all bytes after the length, including the checksum
    always @(posedge clk_i) begin
        past <= 1'b1;
        if (past)
            assume (rst_i || $stable(api_i));
        assume (!valid_i || cts_i); // modem_tx
        if (taken)
            total <= place < DATA ? 8'd0 : total + data_o;
        if (past && !$past(rst_i)) begin
            assert (place <= CHECKSUM);
            // `place` counts up by 1 for each byte of the frame, and remains DATA until the last
            // byte of the packet. CHECKSUM comes last.
            if ($past(api_i) && api_i)
                assert (place == $past(!taken || (place == DATA && !last_i) ? place :
                                       place == CHECKSUM ? 3'd0 : place + 3'd1));
            else if (!rst_i)
                assert (place == DATA && (!taken || (valid_i && data_o == data_i)));
            // Every byte waits until the modem accepts bytes. The checksum waits for nothing else.
            assert (!valid_o || cts_i);
            assert (place != CHECKSUM || valid_o == cts_i);
            // The first bytes are the delimiter and the length of the packet.
            assert (!valid_o || place != 3'd0 || data_o == 8'h7E);
            assert (!valid_o || place != 3'd1 || data_o == 8'h00);
            assert (!valid_o || place != 3'd2 || data_o == {1'b0, bytes_i});
            assert (valid_o || data_o == 8'h00);
            // The bytes of the packet are taken only in state DATA.
            assert (!ready_o || place == DATA);
            // The sum of the bytes after the length is 0xFF.
            if ($past(taken) && $past(place) == CHECKSUM)
                assert (total == 8'hFF && place == 3'd0);
        end
        cover (past && !rst_i && taken && place == CHECKSUM);
        cover (past && !rst_i && taken && !api_i);
    end
`endif
endmodule
