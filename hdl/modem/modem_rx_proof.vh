// SPDX-License-Identifier: MIT
//
// modem_rx_proof: a packet is published once, after all its bytes are in memory.
// Included at the foot of modem_rx.v, only for the prover.

    localparam [6:0] LONGEST = 7'd100;
    reg past = 1'b0;
    initial assume (rst_i);
    (* anyseq *) reg acknowledge;
    reg       owed  = 1'b0; // a write was taken and is not acknowledged
    reg [6:0] wrote = 7'd0; // bytes of this packet in memory or on the way
    reg [8:0] ticks = 9'd0; // 80 a character, since the latest byte
    reg       lost  = 1'b0; // a byte of this packet was replaced before it was taken
    reg [7:0] latest = 8'd0; // the latest byte
    wire      write = wr_valid_o && wr_ready_i;
    always @(posedge clk_i) begin
        past <= 1'b1;
        // modem_npi has one write at a time, whatever becomes of the packet.
        assume (!wr_ready_i || (wr_valid_o && !owed));
        assume (wr_busy_i == owed);
        owed <= write || (owed && !acknowledge);
        // In modem.v only a packet fills the ring, and that is known a clock later.
        if (past)
            assume (!full_i || $past(full_i) || $past(push_o));
        wrote <= wrote + write;
        if (rx_valid_i && !deaf)
            latest <= rx_data_i;
        if (rx_valid_i && !deaf && pending && !taken && !ending)
            lost <= 1'b1;
        ticks <= !rx_idle_i || rx_valid_i || rst_i ? 9'd0 : ticks + {8'd0, tick_i && ticks != 9'd256};
        if (done || rst_i) begin
            wrote <= 7'd0;
            lost  <= 1'b0;
        end
        if (past && !rst_i && !$past(rst_i)) begin
            // An unreleased packet is never overwritten: nothing is written while the ring is full, and
            // nothing beyond the longest packet; bytes go in turn, each to its place.
            assert (!wr_valid_o || (!full_i && wr_index_o < LONGEST));
            assert (wr_be_o == 8'd1 << wr_index_o[2:0]);
            assert (!wr_valid_o || (wr_data_o == latest && wr_index_o == wrote && !lost));
            // A packet that is published was written whole, was acknowledged, and has a free buffer.
            if (push_o)
                assert (!owed && !wr_valid_o && !full_i && !lost &&
                        wrote == wr_index_o && wrote != 7'd0 && wrote <= LONGEST);
            // A dropped packet counts, once, and is never published.
            assert (!(push_o && done && dropping));
            assert (!$past(done && dropping) || overrun_o);
            assert (!overrun_o || $past(late || dropping));
            assert (!(overrun_o && $past(push_o && !late)));
            assert (!lost || (ending && dropping));
            assert (silence == ticks); // 256 are 3.2 characters
        end
        cover (past && !rst_i && push_o && wrote == 7'd3);
        cover (past && !rst_i && overrun_o && $past(full_i));
        cover (past && !rst_i && lost && owed);
    end
