// SPDX-License-Identifier: MIT
//
// axis_write_proof: each word of a packet is written once, to its place, with its bytes; nothing else is.
// Included at the foot of axis_write.v, only for the prover.

    reg       past = 1'b0;
    reg [3:0] f_filled, f_acked, f_goal; // bursts filled, acknowledged, and awaited by a packet's end
    // Any one place of the queue: its content is unchanged when it is used.
    (* anyconst *) reg [1:0] f_slot;
    reg [ADDR_BITS-1:6] f_addr;
    wire [1:0] f_age   = f_slot - out;
    wire       f_there = {1'b0, f_age} < queued;
    wire [3:0] f_fits  = row_ends && rest != 3'd0 ? {1'b0, rest} : 4'd8;
    wire [3:0] f_owed  = f_goal - f_acked;
    wire       f_begun = place != 3'd0;
    wire [ADDR_BITS-1:3] f_done  = {{(ADDR_BITS-4){1'b0}}, 1'b0} + words - left; // words of the row taken
    wire [ADDR_BITS-1:3] f_place = {f_begun ? burst : at[ADDR_BITS-1:6], place};
    initial assume (rst_i);
    always @* begin
        assume (!acked_i || unacked > queued); // of requested ones
        assume (!desc_valid_i || (desc_bytes_i != {BYTE_BITS{1'b0}} && desc_rows_i != 16'd0));
    end
    always @(posedge clk_i) begin
        past <= !rst_i;
        if (full && in == f_slot)
            f_addr <= burst;
        f_filled <= f_filled + {3'd0, full};
        f_acked  <= f_acked + {3'd0, acked_i};
        if (ends)
            f_goal <= f_filled + {3'd0, full} + {3'd0, place + {2'd0, wr_push_o} != 3'd0};
        if (rst_i) begin
            f_filled <= 4'd0;
            f_acked  <= 4'd0;
        end
    end
    integer b;
    always @* if (!rst_i && past) begin
        assert (queued <= unacked && unacked <= 3'd4 && queued[1:0] == in - out);
        assert (!f_there || bursts[f_slot] == f_addr);
        assert (f_filled - f_acked == {1'b0, unacked});
        assert (!wr_push_o || !wr_full_i);
        assert (!full || unacked != 3'd4);
        // A burst that is begun belongs to the word that comes next, or is being filled up.
        assert (!pad || f_begun);
        assert (!f_begun || pad || (busy && !over && burst == at[ADDR_BITS-1:6] && place <= at[5:3]));
        assert (!busy || over || leading == (at[5:3] != (pad ? 3'd0 : place)));
        if (busy && !over)
            assert (left != {WORD_BITS{1'b0}} && left <= words && at == row + f_done && rows != 16'd0);
        // A word that is taken is pushed in this clock, to its place; other pushes write nothing.
        assert (!data || (wr_push_o && wr_data_o == axis_tdata_i && f_place == at && busy && !pad));
        for (b = 0; b < 8; b = b + 1)
            assert (wr_be_o[b] == (data && axis_tkeep_i[b] && b < f_fits));
        assert (!take || data || over);
        // done is raised when all bursts up to the packet's last are acknowledged.
        if (ending && behind != 3'd0) begin
            assert ({1'b0, behind} == f_owed && behind <= 3'd5);
            assert (f_goal == f_filled + 4'd1 ? pad : f_filled - f_goal <= {1'b0, unacked});
        end
        assert (!(ends && ending));
        cover (done_valid_o && done_over_o && unacked != 3'd0);
        cover (done_valid_o && !done_over_o && f_filled == 4'd3);
        cover (lead && !row_ends);
        cover (ends && f_begun && at[ADDR_BITS-1:6] != row[ADDR_BITS-1:6]);
        cover (stop_i && f_begun);
        cover (unacked == 3'd4);
    end
    always @(posedge clk_i) if (past && !rst_i && !$past(rst_i)) begin
        if ($past(start))
            assert (busy && at == $past(desc_base_i) && rows == $past(desc_rows_i) && stride == $past(desc_stride_i)
                    && {words, 3'd0} == $past({2'd0, desc_bytes_i} + 3'd7) >> 3 << 3 && {rest, tag} == $past({desc_bytes_i[2:0], desc_tag_i}));
        else if (busy)
            assert ($stable({stride, words, rest, tag}));
        if ($past(data && row_ends && !axis_tlast_i && !stop_i))
            assert (over == $past(one_row) && at == $past(row) + $past(stride) && rows == $past(rows) - 16'd1);
        if ($past(done_valid_o && !done_ready_i && !stop_i))
            assert (done_valid_o && $stable(done_bytes_o) && $stable(done_over_o) && $stable(done_tag_o));
        if ($past(ends))
            assert (ending && busy == $past(start));
        if (done_valid_o && !$past(done_valid_o))
            assert (f_owed == 4'd0);
    end
