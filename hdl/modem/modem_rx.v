// SPDX-License-Identifier: MIT
//
// modem_rx: writes bytes from the modem into the receive ring, one packet per buffer.
//
// The first byte of a packet announces its length: (byte & 127) + 5, if this is at most 100. A
// packet ends after this length, after 100 bytes, after a silence of 3.2 characters, or at a
// framing error. In API mode, a packet is the contents of a frame, and ends with the frame. A
// packet is published only after it is in memory. If no buffer is free, the whole packet is
// dropped. If the memory is late by more than the time of a byte, the current packet and the bytes
// that follow without a pause are lost; earlier packets stay in the ring.

`default_nettype none
`include "count_up.vh"

module modem_rx (
    input  wire       clk_i,
    input  wire       rst_i,      // reset; it also drops the current packet
    input  wire       tick_i,     // eight ticks per bit time
    input  wire       api_i,      // API mode: modem_api_rx ends packets with rx_end_i or rx_bad_i
    // bytes in
    input  wire       rx_valid_i,
    input  wire [7:0] rx_data_i,
    input  wire       rx_error_i, // framing error: the current packet ends here
    input  wire       rx_end_i,   // the packet is complete (API)
    input  wire       rx_bad_i,   // the packet must be dropped (API)
    output wire       silent_o,   // no byte has arrived for 3.2 characters
    input  wire       rx_idle_i,
    // memory
    output wire       wr_valid_o,
    output reg  [7:0] wr_data_o,
    output reg  [6:0] wr_index_o, // index of the byte in the packet
    // byte enables: one bit is set, at the position of the byte in a word of eight bytes
    output reg  [7:0] wr_be_o,
    input  wire       wr_ready_i,
    input  wire       wr_busy_i,
    // ring
    input  wire       full_i,
    output wire       push_o,     // the packet is complete and has wr_index_o bytes
    output reg        overrun_o   // one cycle: a packet or bytes were dropped
);
    reg [6:0] length;   // announced length minus 5; ignored if it is above 95
    reg       near;     // wr_index_o / 4 is length / 4 + 1
    reg [8:0] silence;  // ticks without a byte; 256 ticks are 3.2 characters
    `COUNT_UP(up, 9)
    reg       pending;  // wr_data_o waits
    reg       ending;   // the last byte of the packet is in wr_data_o, or has been written
    reg       dropping; // no buffer was free for this packet, or a byte of it was lost
    reg       deaf;     // bytes were lost; all further bytes are ignored until the line is silent

    wire       first   = wr_index_o == 7'd0;
    wire       begins  = pending && first && !ending;
    wire       drop    = dropping || (begins && full_i);
    wire       taken   = pending && !ending && (drop || wr_ready_i);
    wire [6:0] count   = wr_index_o + 7'd1;
    wire       silent  = silence[8];
    wire       late    = (rx_valid_i || rx_error_i || rx_end_i || rx_bad_i) && pending && !taken &&
        !deaf;
    wire       done    = ending && !wr_busy_i;
    // Outside API mode, the index is at most 100, so its bits 6, 5, 1 and 0 identify 99. In API
    // mode, the limit is index 112, which modem_api_rx never reaches.
    wire       longest = api_i ? &wr_index_o[6:4] :
                         (wr_index_o[6] && wr_index_o[5] && wr_index_o[1] && wr_index_o[0]) ||
                         (near && wr_index_o[1:0] == length[1:0]);
    wire       cut     = api_i ? rx_end_i || rx_bad_i : rx_error_i || silent;

    assign wr_valid_o = pending && !ending && !drop;
    assign silent_o   = silent;
    assign push_o     = done && !dropping && !first;

    always @(posedge clk_i) begin
        overrun_o <= (late && ending) || (done && dropping);
        if (!rx_idle_i || rx_valid_i)
            silence <= 9'd0;
        else if (tick_i && !silent)
            silence <= up(silence);

        if (rx_valid_i && !deaf) begin
            wr_data_o <= rx_data_i;
            pending   <= 1'b1;
        end
        if (taken) begin
            wr_index_o <= count;
            wr_be_o    <= {wr_be_o[6:0], wr_be_o[7]};
            dropping   <= drop;
            if (!rx_valid_i || deaf)
                pending <= 1'b0;
            if (first)
                length <= wr_data_o[6:0];
            if (&wr_index_o[1:0])
                near <= wr_index_o[6:2] == length[6:2];
            if (longest)
                ending <= 1'b1;
        end
        if (cut && (!pending || taken) && (!first || taken)) begin
            ending <= 1'b1;
            if (rx_bad_i)
                dropping <= 1'b1;
        end
        if (done || rst_i)
            near <= 1'b0;
        if (done) begin
            ending     <= 1'b0;
            dropping   <= 1'b0;
            wr_index_o <= 7'd0;
            wr_be_o    <= 8'd1;
        end
        if (silent)
            deaf <= 1'b0;
        if (late) begin
            // The previous byte is overwritten before the memory has taken it. If its packet is
            // incomplete, the packet is lost as well.
            deaf    <= 1'b1;
            pending <= 1'b0;
            if (!ending) begin
                ending   <= 1'b1;
                dropping <= 1'b1;
            end
        end
        if (rst_i) begin
            wr_index_o <= 7'd0;
            wr_be_o    <= 8'd1;
            silence    <= 9'd0;
            pending    <= 1'b0;
            ending     <= 1'b0;
            dropping   <= 1'b0;
            deaf       <= 1'b0;
            overrun_o  <= 1'b0;
        end
    end

`ifdef FORMAL
    // Proves that a packet is published once, and only after all its bytes are in memory.
    wire [6:0] most = api_i ? 7'd113 : 7'd100;
    reg past = 1'b0;
    initial assume (rst_i);
    (* anyseq *) reg acknowledge;
    reg       owed  = 1'b0; // a write was taken and is not yet acknowledged
    reg [6:0] wrote = 7'd0; // number of bytes of this packet that are in memory or on their way
    reg [8:0] ticks = 9'd0; // ticks since the latest byte; 80 per character
    reg       lost  = 1'b0; // a byte of this packet was overwritten before it was taken
    reg [7:0] latest = 8'd0; // latest byte from the UART
    reg [6:0] announced;     // length given by the first byte written
    wire      write = wr_valid_o && wr_ready_i;
    always @(posedge clk_i) begin
        past <= 1'b1;
        if (past)
            assume ($stable(api_i));
        // modem_npi has at most one write in progress, even if the packet is dropped.
        assume (!wr_ready_i || (wr_valid_o && !owed));
        assume (wr_busy_i == owed);
        owed <= write || (owed && !acknowledge);
        // In modem.v, the ring becomes full only when a packet is pushed, and full_i rises one
        // clock later.
        if (past)
            assume (!full_i || $past(full_i) || $past(push_o));
        wrote <= wrote + write;
        if (write && wrote == 7'd0)
            announced <= wr_data_o[6:0];
        if (rx_valid_i && !deaf)
            latest <= rx_data_i;
        if (rx_valid_i && !deaf && pending && !taken && !ending)
            lost <= 1'b1;
        ticks <= !rx_idle_i || rx_valid_i ||
            rst_i ? 9'd0 : ticks + {8'd0, tick_i && ticks != 9'd256};
        if (done || rst_i) begin
            wrote <= 7'd0;
            lost  <= 1'b0;
        end
        if (past && !rst_i && !$past(rst_i)) begin
            // A packet that has not been released is never overwritten: nothing is written while
            // the ring is full, or beyond the greatest length of a packet. Bytes are written in
            // order, each at its position.
            assert (!wr_valid_o || (!full_i && wr_index_o < most));
            assert (wr_be_o == 8'd1 << wr_index_o[2:0]);
            assert (!wr_valid_o || (wr_data_o == latest && wr_index_o == wrote && !lost));
            // All bytes of a published packet were written and acknowledged, and a buffer was
            // free for the packet.
            if (push_o)
                assert (!owed && !wr_valid_o && !full_i && !lost &&
                        wrote == wr_index_o && wrote != 7'd0 && wrote <= most);
            // A dropped packet is counted once, and is never published.
            assert (!(push_o && done && dropping));
            assert (!$past(done && dropping) || overrun_o);
            assert (!overrun_o || $past(late || dropping));
            assert (!(overrun_o && $past(push_o && !late)));
            assert (!lost || (ending && dropping));
            assert (silence == ticks); // Both counts reach 256 after 3.2 characters.
            // After a loss, bytes are ignored until the line is silent, so that the rest of a
            // packet is not taken for a new packet.
            assert (deaf || !$past(deaf) || $past(silence[8]));
            // The packet has the length given by its first byte.
            if (wrote != 7'd0 && !dropping)
                assert (length == announced);
            assert (near == ({1'b0, wr_index_o[6:2]} == {1'b0, length[6:2]} + 6'd1));
            if (taken && !first && !api_i && {1'b0, count} == {1'b0, length} + 8'd5)
                assert (longest);
        end
        cover (past && !rst_i && push_o && wrote == 7'd3);
        cover (past && !rst_i && overrun_o && $past(full_i));
        cover (past && !rst_i && lost && owed);
        cover (past && !rst_i && cut && taken);
    end
`endif
`ifdef COVER_POINTS
    no_buffer: cover property (@(posedge clk_i) begins && full_i);
    memory_late: cover property (@(posedge clk_i) late);
    memory_late_for_the_last_byte: cover property (@(posedge clk_i) late && ending);
    byte_while_deaf: cover property (@(posedge clk_i) rx_valid_i && deaf);
    longest_packet: cover property (@(posedge clk_i) push_o && wr_index_o == 7'd100);
    ends_as_announced: cover property (@(posedge clk_i) !api_i && taken && longest &&
                                       wr_index_o != 7'd99);
    ends_in_silence: cover property (@(posedge clk_i) !api_i && silent && !first && !ending);
`endif
endmodule
