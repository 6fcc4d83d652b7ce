// SPDX-License-Identifier: MIT
//
// axis_filter_proof: words are split into beats and beats joined into words, each once and in order. Included at the foot
// of axis_filter.v, only for the prover. axis_memory, which has its own proof, is cut off: its streams are free.

    reg past = 1'b0;
    reg [3:0] f_sent;  // beats of the word that the core has
    reg [3:0] f_size;  // of the word's bytes, in beats
    reg [3:0] f_count; // beats of the output that are not in memory's hands
    // Any one beat of a word: the bytes that came as it.
    (* anyconst *) reg [3:0] f_lane;
    reg [WIDTH-1:0] f_data;
    reg [KEEP-1:0]  f_keep;
    reg [BYTE_BITS-1:0] f_bytes = 0, f_came = 0; // the operation's; those that came, up to the number that went in
    wire       f_given = full && out_ready;
    wire [3:0] f_place = f_given ? 4'd0 : f_count; // place of the beat that comes
    wire       f_rst   = rst_i || core_rst_i;
    integer f;
    initial assume (rst_i);
    always @* begin
        f_size = 4'd0;
        for (f = 0; f < 8; f = f + KEEP)
            f_size = f_size + {3'd0, word_keep[f]};
        assume (word_keep[0] && (word_keep & (word_keep + 8'd1)) == 8'd0 && (word_last || &word_keep));
        assume (!start_i || !(reading || writing)); // one operation at a time
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
        if (past && !f_rst) begin
            if ($past(word_valid && !word_ready)) // axis_memory's word stays
                assume (word_valid && $stable({word, word_keep, word_last}));
            if ($past(m_axis_tvalid_o && !m_axis_tready_i))
                assert (m_axis_tvalid_o && $stable({m_axis_tdata_o, m_axis_tkeep_o, m_axis_tlast_o}));
            if ($past(full && !out_ready))
                assert (full && $stable({out, out_keep, ends}));
            if ($past(came))
                assert (full == ($past(last) || f_count == BEATS) && ends == $past(last));
            if ($past(start_i))
                assert (reading == (f_bytes != 0) && writing == reading && (reading ? !empty : done_o && refused_o));
            else
                assert (!empty && reading == $past(reading && !read_ready) && writing == $past(writing && !write_ready));
        end
    end
    always @* if (past && !f_rst) begin
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
        cover (f_given && ends && f_count == BEATS - 1 && came);
    end
    // Without tlast the packet ends with the beat before which all others came.
    always @* if (past && !f_rst && LAST == 0 && f_came != f_bytes) begin
        assert (awaited == f_bytes - f_came);
        assert (last == (f_bytes - f_came == STEP));
    end
