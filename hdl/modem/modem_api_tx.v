// SPDX-License-Identifier: MIT
//
// modem_api_tx: puts a packet into an API frame: transmit request 0x01 to a 16-bit address.
//
//   7E 00 length 01 id target(2) options, the packet, checksum

`default_nettype none

module modem_api_tx (
    input  wire        clk_i,
    input  wire        rst_i,
    input  wire [15:0] target_i,
    // packet in; valid only while the modem takes bytes
    input  wire        valid_i,
    input  wire [7:0]  data_i,
    input  wire        last_i,
    input  wire [6:0]  bytes_i, // of the whole packet
    output wire        ready_o,
    // bytes out
    input  wire        cts_i,
    output wire        valid_o,
    output reg  [7:0]  data_o,
    input  wire        ready_i
);
    localparam [3:0] TYPE = 4'd3, DATA = 4'd8, CHECKSUM = 4'd9;
    localparam [7:0] FRAME_ID = 8'd1; // not 0: a status is wanted

    reg [3:0] place; // byte of the frame: 0..7 head, DATA, CHECKSUM
    reg [7:0] sum;

    wire taken = valid_o && ready_i;

    assign valid_o = place == CHECKSUM ? cts_i : valid_i;
    assign ready_o = ready_i && place == DATA;

    always @* begin
        case (place)
            4'd0:     data_o = 8'h7E;
            4'd1:     data_o = 8'h00;
            4'd2:     data_o = {1'b0, bytes_i} + 8'd5;
            TYPE:     data_o = 8'h01;
            4'd4:     data_o = FRAME_ID;
            4'd5:     data_o = target_i[15:8];
            4'd6:     data_o = target_i[7:0];
            4'd7:     data_o = 8'h00; // options
            CHECKSUM: data_o = ~sum;
            default:  data_o = data_i;
        endcase
    end

    always @(posedge clk_i) begin
        if (taken) begin
            sum <= place < TYPE ? 8'd0 : sum + data_o;
            if (place == CHECKSUM)
                place <= 4'd0;
            else if (place != DATA || last_i)
                place <= place + 4'd1;
        end
        if (rst_i)
            place <= 4'd0;
    end

`ifdef FORMAL
    // Every frame carries its length and its checksum.
    reg past = 1'b0;
    initial assume (rst_i);
    reg [7:0] total = 8'd0; // of all from the type on, checksum included
    always @(posedge clk_i) begin
        past <= 1'b1;
        if (taken)
            total <= place < TYPE ? 8'd0 : total + data_o;
        if (past && !$past(rst_i)) begin
            assert (place <= CHECKSUM);
            // Each place follows its predecessor; that of the packet's bytes, after the last.
            assert (place == $past(!taken || (place == DATA && !last_i) ? place : place == CHECKSUM ? 4'd0 : place + 4'd1));
            // The packet's bytes are taken in their place, and in no other.
            assert (!ready_o || place == DATA);
            // The frame's sum is 0xFF.
            if ($past(taken) && $past(place) == CHECKSUM)
                assert (total == 8'hFF && place == 4'd0);
        end
        cover (past && !rst_i && taken && place == CHECKSUM);
    end
`endif
endmodule
