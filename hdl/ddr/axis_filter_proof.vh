// SPDX-License-Identifier: MIT
//
// axis_filter_proof: words are split into beats and beats joined into words, each once and in order; the rules that
// npi_stream wants are kept. Included at the foot of axis_filter.v, only for the prover. npi_stream, which has its own
// proof, is cut off: it does what that proof says, and no more is known of it.

    reg past = 1'b0;
    reg [3:0] f_sent;  // beats of the word that the core has
    reg [3:0] f_size;  // of the word's bytes, in beats
    reg [3:0] f_count; // beats of the output that are not in memory's hands
    // Any one beat of a word: the bytes that came as it.
    (* anyconst *) reg [3:0] f_lane;
    reg [WIDTH-1:0] f_data;
    reg [KEEP-1:0]  f_keep;
    reg [BYTE_BITS-1:0] f_bytes = 0, f_came = 0; // the operation's; those that came, up to the number that went in
    reg [WORD_BITS-1:0] f_left = 0;   // words that npi_stream still gives
    reg [WORD_BITS-1:0] f_written = 0; // words that it got in this operation
    wire [3:0] f_place = given ? 4'd0 : f_count; // place of the beat that comes
    wire       f_rst   = rst_i || core_rst_i;
    integer f;
    initial assume (rst_i);
    always @* begin
        f_size = 4'd0;
        for (f = 0; f < 8; f = f + KEEP)
            f_size = f_size + {3'd0, word_keep[f]};
        assume (!word_valid || f_left != 0);
        assume (!read_idle || f_left == 0);
        assume (!start_i || !(waiting || writing || closing || closed)); // one operation at a time
        assume ((bytes_i & (STEP - 1'b1)) == {BYTE_BITS{1'b0}});
        assume ({28'd0, f_lane} < BEATS);
    end
    always @(posedge clk_i) begin
        past    <= !f_rst;
        f_sent  <= f_rst || (word_valid && word_ready) ? 4'd0 : f_sent + {3'd0, sent};
        f_count <= f_rst ? 4'd0 : f_place + {3'd0, came};
        f_came  <= start_i ? {BYTE_BITS{1'b0}} : f_came + (came && f_came != f_bytes ? STEP : {BYTE_BITS{1'b0}});
        if (start_i)
            f_bytes <= bytes_i;
        if (came && f_place == f_lane)
            {f_data, f_keep} <= {s_axis_tdata_i, s_axis_tkeep_i};
        if (f_rst)
            f_left <= 0;
        else if (go)
            f_left <= {1'b0, bytes_i[BYTE_BITS-1:3]} + {{(WORD_BITS-1){1'b0}}, |bytes_i[2:0]};
        else
            f_left <= f_left - {{(WORD_BITS-1){1'b0}}, word_valid && word_ready};
        if (go)
            f_written <= 0;
        else if (write && write_ready)
            f_written <= f_written + 1'b1;
        if (past && !f_rst) begin
            assume (!waiting || $stable(bytes_i));
            if ($past(word_valid && !word_ready)) // npi_stream's word stays
                assume (word_valid && $stable(word));
            if ($past(m_axis_tvalid_o && !m_axis_tready_i))
                assert (m_axis_tvalid_o && $stable({m_axis_tdata_o, m_axis_tkeep_o, m_axis_tlast_o}));
            if ($past(full && !out_ready))
                assert (full && $stable({out, out_keep, ends}));
            if ($past(came))
                assert (full == ($past(last) || f_count == BEATS) && ends == $past(last));
            if ($past(start_i))
                assert (waiting == (f_bytes != 0) && !writing && (waiting ? !empty : done_o && refused_o));
            else
                assert (!empty && waiting == $past(waiting && !go) && writing == $past(go || (writing && !(given && ends))));
            // The answer ends when its burst is filled and in memory.
            assert (closing == $past(given && ends) && (!done_o || empty || $past(closing || closed)));
            if ($past(given && ends)) // bytes are words before the last one, and what is kept of that
                assert (over || bytes == $past(bytes) + $past(out_bytes));
        end
    end
    always @* if (past && !f_rst) begin
        // npi_stream's rules: a start when idle, no word with a start or a flush. It writes what has room.
        assert (!go || (read_idle && write_idle && !write && !flush));
        assert (!flush || !write);
        assert ({2'd0, waiting} + {2'd0, writing} + {2'd0, closing} + {2'd0, closed} <= 3'd1);
        assert (!(writing || closing || closed) || bytes <= ROOM);
        assert (!writing || bytes == {f_written, 3'd0});
        assert (!(writing && over) || !room);
        // Words as many as the bytes need; the last one keeps those that are left.
        assert (f_left == {1'b0, left[BYTE_BITS-1:3]} + |left[2:0]);
        assert (!word_valid || (word_last == (f_left == 1) && f_size == (word_last ? left >> $clog2(KEEP) : 8 / KEEP)));
        // Split: all beats of the word, and the word goes with the last of them.
        assert (beat == f_sent && m_axis_tvalid_o == word_valid);
        if (word_valid) begin
            assert (f_sent < f_size && word_ready == (m_axis_tready_i && f_sent + 4'd1 == f_size));
            assert (m_axis_tdata_o == word[WIDTH*f_sent +: WIDTH] && m_axis_tkeep_o == word_keep[KEEP*f_sent +: KEEP]);
            assert (m_axis_tlast_o == (word_last && f_sent + 4'd1 == f_size));
        end
        // Joined: each beat in its place, bytes behind the last one not kept.
        assert ({28'd0, f_count} <= BEATS && (full ? place == 4'd0 && f_count != 4'd0 : place == f_count && place <= LAST_BEAT));
        assert (f_lane >= f_count ? out_keep[KEEP*f_lane +: KEEP] == 0
                                  : out[WIDTH*f_lane +: WIDTH] == f_data && out_keep[KEEP*f_lane +: KEEP] == f_keep);
        assert (s_axis_tready_o == (!full || out_ready));
        cover (sent && f_size == BEATS - 1 && m_axis_tlast_o);
        cover (came && last && f_came != f_bytes);
        cover (over && done_o);
        cover (done_o && !refused_o && bytes == 3);
        cover (given && ends && f_count == BEATS - 1 && came);
    end
    // Without tlast the packet ends with the beat before which all others came.
    always @* if (past && !f_rst && LAST == 0 && f_came != f_bytes) begin
        assert (awaited == f_bytes - f_came);
        assert (last == (f_bytes - f_came == STEP));
    end
