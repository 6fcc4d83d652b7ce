// SPDX-License-Identifier: MIT
//
// axi4_memory_proof: each read gets its beats, from its words of memory, with its id and response;
// each beat of a write goes to its word, and the write's one answer comes after it. Holds for any
// bursts and runs of any length; a refused write writes nothing. Included at the foot of
// axi4_memory.v, only for the prover. The port's model is axis_memory's. Its parts are inside; the
// statements of their proofs are assumed and asserted again.

    localparam WORD = ADDR_BITS - 3, TAG = ID_BITS + 1, ENTRY = TAG + 10;
    reg past = 1'b0;
    initial assume (rst_i);
    always @(posedge clk_i)
        past <= !rst_i;
    (* hierconn *) wire                 \u_memory.request , \u_memory.request_read ;
    (* hierconn *) wire [ADDR_BITS-1:6] \u_memory.addr ;
    wire reading = \u_memory.request && \u_memory.request_read , writing = \u_memory.request && !\u_memory.request_read ;

    function [WORD-1:0] word_of(input [WORD-1:0] base, input [9:0] beat);
        word_of = base + beat;
    endfunction

    // ---- Reads. Any one is watched: `r_ahead` others end before it, `r_got` of its beats were
    // given, `r_asked` words requested.
    (* hierconn *) wire [2:0]         \u_memory.u_read.asked , \u_memory.u_read.place , \u_memory.u_read.first ,
                                      \u_memory.u_read.last , \u_memory.u_read.rest ;
    (* hierconn *) wire [1:0]         \u_memory.u_read.tag_in , \u_memory.u_read.tag_out ;
    (* hierconn *) wire               \u_memory.u_read.busy , \u_memory.u_read.ask , \u_memory.u_read.row_ends ,
                                      \u_memory.u_read.stopping ;
    (* hierconn *) wire [9:0]         \u_memory.u_read.left ;
    (* hierconn *) wire [ADDR_BITS-1:3] \u_memory.u_read.at ;
    (* hierconn *) wire [TAG-1:0]     \u_memory.u_read.tag ;
    (* hierconn *) wire [4*ENTRY-1:0] \u_memory.u_read.f_tags ;
    (* anyseq *) wire r_pick;
    reg           r_watched;
    reg           r_asks; // its words are asked for
    reg [2:0]     r_open, r_ahead;
    reg [TAG-1:0] r_tag;
    reg [7:0]     r_len;
    reg [WORD-1:0] r_base;
    reg [9:0]     r_got, r_asked;
    // For each place of axis_read's queue: is it the watched read's, its first beat, its requested
    // and its acknowledged burst.
    reg [3:0]     mine;
    reg [39:0]    offsets;
    reg [4*(WORD-3)-1:0] asked_at, acked_at;
    reg [1:0]     ack_in;
    wire r_takes = arvalid_i && arready_o, r_gives = rvalid_o && rready_i, r_ends = r_gives && rlast_o;
    wire [WORD-1:0] r_word = {acked_at[(WORD-3)*\u_memory.u_read.tag_out +: WORD-3], \u_memory.u_read.place };
    always @(posedge clk_i) begin
        r_open <= r_open + {2'd0, r_takes} - {2'd0, r_ends};
        if (r_watched && r_ends)
            r_ahead <= r_ahead - 3'd1;
        if (r_watched && r_gives && r_ahead == 3'd0)
            r_got <= r_got + 10'd1;
        if (r_watched && r_ends && r_ahead == 3'd0)
            r_watched <= 1'b0;
        if (\u_memory.u_read.ask ) begin
            mine[\u_memory.u_read.tag_in ] <= r_watched && r_asks;
            offsets[10*\u_memory.u_read.tag_in +: 10] <= r_asked;
            asked_at[(WORD-3)*\u_memory.u_read.tag_in +: WORD-3] <= \u_memory.u_read.at [ADDR_BITS-1:6];
            r_asked <= r_asked + {7'd0, \u_memory.u_read.last } - {7'd0, \u_memory.u_read.first } + 10'd1;
            if (\u_memory.u_read.row_ends )
                r_asks <= 1'b0;
        end
        if (npi_addr_ack_i && npi_rnw_o) begin
            acked_at[(WORD-3)*ack_in +: WORD-3] <= npi_addr_o[ADDR_BITS-1:6];
            ack_in <= ack_in + 2'd1;
        end
        if (r_takes && r_pick && !r_watched) begin
            r_watched <= 1'b1;
            r_asks    <= 1'b1;
            r_ahead   <= r_open - {2'd0, r_ends};
            r_tag     <= {arlen_i != 8'd0 && !(arburst_i == 2'd1 && arsize_i == 3'd3), arid_i};
            r_len     <= arlen_i;
            r_base    <= araddr_i[ADDR_BITS-1:3];
            r_got     <= 10'd0;
            r_asked   <= 10'd0;
            mine      <= 4'd0;
        end
        if (rst_i) begin
            r_open    <= 3'd0;
            r_watched <= 1'b0;
            r_asks    <= 1'b0;
            ack_in    <= 2'd0;
        end
    end
    always @* if (!rst_i && past) begin
        assert (npi_rd_pop_o || !r_gives);
        assert (!rvalid_o || (r_open != 3'd0 && rdata_o == npi_rd_data_i));
        if (rvalid_o && r_watched && r_ahead == 3'd0) begin
            assert (rid_o == r_tag[ID_BITS-1:0] && rresp_o == {r_tag[ID_BITS], 1'b0});
            assert (rlast_o == (r_got == {2'd0, r_len}));
            assert (r_word == word_of(r_base, r_got));
        end
        cover (r_ends && r_watched && r_len == 8'd3 && rresp_o == 2'd0 && \u_memory.u_read.asked == 3'd2);
        cover (r_ends && r_watched && r_len == 8'd1 && rresp_o == 2'd2);
    end
    // The queue carries the induction: it is walked from its oldest place on.
    integer q;
    reg [2:0] finals, before;
    reg       seen, ended, previous_final; // a place of the watched one came; its last
    reg [9:0] next_offset;
    reg [1:0] at;
    reg [TAG-1:0] e_tag;
    reg [2:0] e_first, e_last, e_rest;
    reg       e_final;
    always @* begin
        finals = 3'd0;
        before = 3'd0;
        seen = 1'b0;
        ended = 1'b0;
        previous_final = 1'b0;
        next_offset = r_got;
        for (q = 0; q < 4; q = q + 1) begin
            at = \u_memory.u_read.tag_out + q;
            {e_tag, e_first, e_last, e_rest, e_final} = \u_memory.u_read.f_tags [ENTRY*at +: ENTRY];
            if (!rst_i && past && q < \u_memory.u_read.asked ) begin
                assert (e_first <= e_last && e_rest == 3'd0 && (e_final || e_last == 3'd7));
                if (q + 1 == \u_memory.u_read.asked && reading)
                    assert (\u_memory.addr == asked_at[(WORD-3)*at +: WORD-3]);
                else
                    assert (acked_at[(WORD-3)*at +: WORD-3] == asked_at[(WORD-3)*at +: WORD-3]);
                if (r_watched && mine[at]) begin
                    assert (e_tag == r_tag && {asked_at[(WORD-3)*at +: WORD-3], e_first} == word_of(r_base, offsets[10*at +: 10]));
                    assert (e_final == (offsets[10*at +: 10] + e_last - e_first == {2'd0, r_len}));
                    assert (seen ? !ended : q == 0 || previous_final);
                    assert (offsets[10*at +: 10] + e_last - e_first <= {2'd0, r_len} && (q != 0 || \u_memory.u_read.place <= e_last));
                    if (q == 0 && \u_memory.u_read.place > e_first)
                        assert (r_got == offsets[10*at +: 10] + \u_memory.u_read.place - e_first);
                    else
                        assert (offsets[10*at +: 10] == next_offset);
                    next_offset = offsets[10*at +: 10] + e_last - e_first + 10'd1;
                    seen = 1'b1;
                    ended = e_final;
                end else begin
                    assert (!r_watched || (seen ? ended : r_got == 10'd0));
                    assert (!r_watched || !r_asks || q + 1 != \u_memory.u_read.asked || e_final);
                    if (!seen && e_final && (q != 0 || \u_memory.u_read.place <= e_last))
                        before = before + 3'd1;
                end
                if (e_final && (q != 0 || \u_memory.u_read.place <= e_last))
                    finals = finals + 3'd1;
                previous_final = e_final;
                assert (q + 1 != \u_memory.u_read.asked || \u_memory.u_read.busy || e_final);
            end
        end
        if (!rst_i && past) begin
            assert (!\u_memory.u_read.busy || \u_memory.u_read.rest == 3'd0);
            assert (!\u_memory.u_read.stopping );
            assert (ack_in == \u_memory.u_read.tag_in - {1'b0, reading});
            assert (r_open == finals + {2'd0, \u_memory.u_read.busy });
            if (r_watched) begin
                assert (r_ahead == before);
                assert (r_asks || ended);
                assert (!r_asks || (\u_memory.u_read.busy && !ended && (r_ahead == 3'd0 || r_got == 10'd0)));
                assert (!r_asks || (r_asked == next_offset && r_asked <= {2'd0, r_len}));
                assert (!r_asks || (\u_memory.u_read.tag == r_tag && \u_memory.u_read.at == word_of(r_base, r_asked)
                                    && \u_memory.u_read.left + r_asked == {2'd0, r_len} + 10'd1));
            end
        end
    end

    // ---- Writes. `w_...` hold the address and the beats of the write under way. Any one beat is
    // watched until the burst of its word is acknowledged; `w_until` others are acknowledged before
    // it.
    (* hierconn *) wire               \u_memory.u_write.busy , \u_memory.u_write.over , \u_memory.u_write.ending ;
    (* hierconn *) wire [2:0]         \u_memory.u_write.place , \u_memory.u_write.queued , \u_memory.u_write.unacked ,
                                      \u_memory.u_write.behind , \u_memory.u_write.rest ;
    (* hierconn *) wire [1:0]         \u_memory.u_write.out ;
    (* hierconn *) wire [9:0]         \u_memory.u_write.left ;
    (* hierconn *) wire [ADDR_BITS-1:3] \u_memory.u_write.at ;
    (* hierconn *) wire [ADDR_BITS-1:6] \u_memory.u_write.burst ;
    (* hierconn *) wire [TAG-1:0]     \u_memory.u_write.tag ;
    (* hierconn *) wire [4*(ADDR_BITS-6)-1:0] \u_memory.u_write.f_bursts ;
    (* anyseq *) wire w_pick;
    reg [TAG-1:0] w_tag, e_w_tag; // of the write under way; of the one before
    reg [7:0]     w_len;
    reg [WORD-1:0] w_base, w_word;
    reg [9:0]     w_beat;
    reg [1:0]     w_open;
    reg [2:0]     w_place, w_full, w_until; // words of the port's burst; bursts that are whole and not acknowledged
    reg           w_watched, w_ended;
    wire w_takes = awvalid_i && awready_o, w_gives = wvalid_i && wready_o, w_acked = npi_addr_ack_i && !npi_rnw_o;
    wire w_answered = bvalid_o && bready_i;
    always @* assume (!wvalid_i || !\u_memory.u_write.busy || wlast_i == (w_beat == {2'd0, w_len}));
    always @(posedge clk_i) begin
        w_open <= w_open + {1'b0, w_takes} - {1'b0, w_answered};
        w_place <= w_place + {2'd0, npi_wr_push_o};
        w_full  <= w_full + {2'd0, npi_wr_push_o && w_place == 3'd7} - {2'd0, w_acked};
        if (w_watched && w_acked) begin
            w_until   <= w_until - 3'd1;
            w_watched <= w_until != 3'd0;
        end
        if (w_gives) begin
            w_beat <= w_beat + 10'd1;
            if (wlast_i) begin
                e_w_tag <= w_tag;
                w_ended <= 1'b1;
            end
            if (w_pick && !w_watched) begin
                w_watched <= 1'b1;
                w_ended   <= wlast_i;
                w_until   <= w_full - {2'd0, w_acked};
                w_word    <= word_of(w_base, w_beat);
            end
        end
        if (w_takes) begin
            w_tag  <= {awlen_i != 8'd0 && !(awburst_i == 2'd1 && awsize_i == 3'd3), awid_i};
            w_len  <= awlen_i;
            w_base <= awaddr_i[ADDR_BITS-1:3];
            w_beat <= 10'd0;
        end
        if (rst_i) begin
            w_open    <= 2'd0;
            w_place   <= 3'd0;
            w_full    <= 3'd0;
            w_watched <= 1'b0;
        end
    end
    wire [2:0] w_age = w_until - {2'd0, writing}; // the watched beat's burst in axis_write's queue
    wire [1:0] w_slot = \u_memory.u_write.out + w_age[1:0];
    always @* if (!rst_i && past) begin
        assert (!npi_wr_push_o || w_gives || npi_wr_be_o == 8'd0);
        if (w_gives)
            assert (npi_wr_push_o && npi_wr_data_o == wdata_i && npi_wr_be_o == (w_tag[ID_BITS] ? 8'd0 : wstrb_i)
                    && w_place == w_base[2:0] + w_beat[2:0]);
        if (w_watched && w_acked && w_until == 3'd0)
            assert (npi_addr_o[ADDR_BITS-1:6] == w_word[WORD-1:3]);
        assert (w_open == {1'b0, \u_memory.u_write.busy } + {1'b0, \u_memory.u_write.ending });
        if (bvalid_o)
            assert (w_open != 2'd0 && !(w_watched && w_ended) && bid_o == e_w_tag[ID_BITS-1:0]
                    && bresp_o == {e_w_tag[ID_BITS], 1'b0});
        // These carry the induction.
        assert (w_place == \u_memory.u_write.place && w_full == \u_memory.u_write.unacked );
        assert (!\u_memory.u_write.over );
        if (\u_memory.u_write.busy )
            assert (\u_memory.u_write.tag == w_tag && refusing == w_tag[ID_BITS] && \u_memory.u_write.rest == 3'd0
                    && \u_memory.u_write.left + w_beat == {2'd0, w_len} + 10'd1 && w_beat <= {2'd0, w_len}
                    && \u_memory.u_write.at == word_of(w_base, w_beat));
        if (w_watched) begin
            assert (w_until <= w_full && (w_ended ? \u_memory.u_write.ending && w_until < \u_memory.u_write.behind
                                                  : \u_memory.u_write.busy ));
            if (w_until == w_full)
                assert (w_place != 3'd0 && \u_memory.u_write.burst == w_word[WORD-1:3]);
            else if (writing && w_until == 3'd0)
                assert (\u_memory.addr == w_word[WORD-1:3]);
            else
                assert (w_age < \u_memory.u_write.queued
                        && \u_memory.u_write.f_bursts [(ADDR_BITS-6)*w_slot +: ADDR_BITS-6] == w_word[WORD-1:3]);
        end
        cover (w_answered && bresp_o == 2'd0 && w_until == 3'd7 && w_open == 2'd2);
        cover (w_answered && bresp_o == 2'd2);
    end
    always @(posedge clk_i) if (past && !rst_i && \u_memory.u_write.ending )
        assert (\u_memory.done_tag_o == e_w_tag && !\u_memory.done_over_o );
    (* hierconn *) wire [TAG-1:0]     \u_memory.done_tag_o ;
    (* hierconn *) wire               \u_memory.done_over_o ;
