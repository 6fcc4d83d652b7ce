// SPDX-License-Identifier: MIT
//
// modem_tx: sends the packets of the transmit ring, each as one RF packet.
//
// After a packet of fewer than 100 bytes (95 if the modem encrypts), the line is silent for four
// characters. This is longer than RO, which is set to 3 characters, so the modem transmits the
// packet. The modem transmits a packet of 100 (95) bytes without such a pause.

`default_nettype none
`include "count_up.vh"

module modem_tx (
    input  wire       clk_i,
    input  wire       rst_i,        // reset; it also drops the current packet
    input  wire       enable_i,     // the modem has been configured
    input  wire       encrypt_i,    // the modem encrypts packets
    input  wire       api_i,        // API mode: no pause after a frame
    // oldest packet of the ring
    input  wire       packet_valid_i,
    input  wire [6:0] packet_bytes_i,
    // high for one cycle: the packet has been sent, so its buffer is free
    output reg        sent_o,
    // memory
    output wire       rd_valid_o,
    output wire [6:0] rd_index_o,   // index of the byte in the packet
    input  wire       rd_done_i,
    input  wire [7:0] rd_data_i,
    // bytes out
    output wire       tx_valid_o,
    output reg  [7:0] tx_data_o,    // byte to send; 0 while enable_i is low
    // high for one cycle per tick (eight per bit) while the line is idle
    input  wire       tx_ready_i,
    output wire       tx_last_o,    // this is the last byte of the packet
    input  wire       cts_i         // 1: the modem accepts bytes
);
    localparam [1:0] FETCH = 2'd0, SEND = 2'd1, REST = 2'd2;
    wire [6:0] longest = encrypt_i ? 7'd95 : 7'd100;

    (* fsm_encoding = "none" *) // one-hot states would take more flip-flops and LUTs
    reg [1:0] state;
    reg [8:0] count; // number of bytes read; in state REST, number of ticks of silence
    `COUNT_UP(up, 9)
    // in state REST: 1 if the modem transmits this packet without a pause; a register, to shorten
    // the path
    reg       whole;

    wire last   = rd_index_o == packet_bytes_i;                // all bytes of the packet have been
                                                               // read
    // 320 ticks have passed, or no pause is needed
    wire rested = (count[8] && count[6]) || whole || api_i;

    wire leaves = tx_valid_o && tx_ready_i;
    wire ends   = state == REST && (tx_ready_i || api_i) && rested;

    // The set-up restarts the transmitter. A packet that was interrupted is sent again from its
    // first byte.
    wire begin_anew = rst_i || !enable_i;

    assign rd_valid_o = state == FETCH && packet_valid_i && enable_i && !sent_o;
    assign rd_index_o = count[6:0];
    assign tx_last_o  = last;
    assign tx_valid_o = state == SEND && cts_i;

    always @(posedge clk_i) begin
        sent_o <= 1'b0;
        case (state)
            FETCH: if (rd_done_i) begin
                tx_data_o <= rd_data_i;
                state     <= SEND;
            end
            SEND: begin
                whole <= packet_bytes_i == longest;
                if (leaves)
                    state <= last ? REST : FETCH;
            end
            default: if (ends) begin
                sent_o <= 1'b1;
                state  <= FETCH;
            end
        endcase
        if (rd_done_i || (state == REST && tx_ready_i)) // rd_done_i is high only in state FETCH
            count <= up(count);
        if (begin_anew || sent_o || (leaves && last))
            count <= 9'd0;
        if (begin_anew) begin
            state     <= FETCH;
            sent_o    <= 1'b0;
            tx_data_o <= 8'd0;
        end
    end

`ifdef FORMAL
    // Proves that the bytes of a packet are sent once and in order, and that the buffer is freed
    // after the last byte.
    reg past = 1'b0;
    initial assume (rst_i);
    reg [6:0] out  = 7'd0; // number of bytes of this packet that have been sent
    reg [7:0] read = 8'd0; // latest byte read
    reg [8:0] rest;        // ticks since the last byte was sent
    reg       full;        // the modem transmits this packet without a pause, because of its length
    always @(posedge clk_i) begin
        past <= 1'b1;
        if (past)
            assume ($stable(api_i));
        // Assumptions about modem.v: the oldest packet of the ring has 1..105 bytes and stays in
        // the ring until it is sent.
        if (past && $past(packet_valid_i) && !$past(sent_o) && !$past(rst_i))
            assume (packet_valid_i && $stable(packet_bytes_i));
        assume (packet_bytes_i >= 7'd1 && packet_bytes_i <= 7'd105);
        assume (!rd_done_i || rd_valid_o); // modem_npi
        out <= out + leaves;
        rest <= leaves ? 9'd0 : rest + {8'd0, tx_ready_i && state == REST};
        if (leaves)
            full <= packet_bytes_i == (encrypt_i ? 7'd95 : 7'd100);
        if (rd_done_i)
            read <= rd_data_i;
        if (sent_o || begin_anew)
            out <= 7'd0;
        if (past && !rst_i && !$past(begin_anew)) begin
            // Bytes are read from the oldest packet only, in order, once, and never after its end.
            assert (!rd_valid_o || (packet_valid_i && rd_index_o == out && out < packet_bytes_i));
            assert (!tx_valid_o ||
                    (rd_index_o == out + 7'd1 && tx_last_o == (rd_index_o == packet_bytes_i)));
            // No byte is offered while the modem accepts none.
            if (tx_valid_o)
                assert (tx_data_o == read && cts_i);
            // The buffer is freed once, after all its bytes have been sent.
            if (sent_o)
                assert (packet_valid_i && out == packet_bytes_i && !$past(sent_o));
            // The line is idle for 320 ticks after a packet, unless its length alone makes the
            // modem transmit it.
            if (state == REST && tx_ready_i)
                assert (ends == (api_i || full || rest >= 9'd320));
            assert (state != REST || (count == rest && whole == full));
        end
        // The number of bytes is known in each state; the induction needs these invariants.
        if (past)
            case (state)
                FETCH:   assert (sent_o ? packet_valid_i && out == packet_bytes_i :
                                 rd_index_o == out &&
                                     (out == 7'd0 || (packet_valid_i && out < packet_bytes_i)));
                SEND:    assert (!sent_o && packet_valid_i && rd_index_o == out + 7'd1 &&
                                 out < packet_bytes_i);
                REST:    assert (!sent_o && packet_valid_i && out == packet_bytes_i);
                default: assert (0);
            endcase
        cover (past && !rst_i && out == 7'd3 && state == REST);
        cover (past && !rst_i && tx_valid_o && !tx_last_o && rd_index_o == 7'd3);
    end
`endif
`ifdef COVER_POINTS
    modem_takes_none: cover property (@(posedge clk_i) state == SEND && !cts_i);
    needs_no_rest: cover property (@(posedge clk_i) !api_i && ends && whole);
    rests: cover property (@(posedge clk_i) !api_i && ends && !whole);
    set_up_interrupts: cover property (@(posedge clk_i) begin_anew && rd_index_o != 7'd0);
`endif
endmodule
