// SPDX-License-Identifier: MIT
//
// axis_read_proof: each word of a row is asked for once, in order; each is given once, with its keep and last.
// Included at the foot of axis_read.v, only for the prover.

    reg       past = 1'b0;
    reg [3:0] f_given; // words of the port's burst that the stream has got
    // Any one place of the queue: its content is unchanged when it is used.
    (* anyconst *) reg [1:0] f_slot;
    reg [ENTRY-1:0] f_tag;
    wire [1:0] f_age   = f_slot - tag_out; // places before it
    wire       f_there = {1'b0, f_age} < asked;
    wire [2:0] f_first = f_tag[9:7], f_last = f_tag[6:4];
    wire       f_moved = axis_tvalid_o && axis_tready_i;
    wire [3:0] f_size  = {1'b0, last_of} - {1'b0, first_of} + 4'd1;
    wire [3:0] f_bytes = place == last_of && rest_of != 3'd0 ? {1'b0, rest_of} : 4'd8;
    wire [3:0] f_span  = {1'b0, last} - {1'b0, first} + 4'd1;
    wire [ADDR_BITS-1:3] f_done = {{(ADDR_BITS-4){1'b0}}, 1'b0} + words - left; // words of the row asked for
    initial assume (rst_i);
    always @* begin
        assume (rd_empty_i || asked != 3'd0); // the port gives what it was asked for
        assume (!desc_valid_i || (desc_bytes_i != {BYTE_BITS{1'b0}} && desc_rows_i != 16'd0));
    end
    always @(posedge clk_i) begin
        past <= !rst_i;
        if (ask && tag_in == f_slot)
            f_tag <= {tag, first, last, row_ends ? rest : 3'd0, row_ends && one_row};
        f_given <= given ? 4'd0 : f_given + {3'd0, f_moved};
        if (rst_i)
            f_given <= 4'd0;
    end
    integer k;
    always @* if (!rst_i && past) begin
        assert (asked <= 3'd4 && asked[1:0] == tag_in - tag_out);
        assert (!ask || asked != 3'd4);
        assert (asked != 3'd0 || (place == 3'd0 && f_given == 4'd0));
        assert (!f_there || (tags[f_slot] == f_tag && f_first <= f_last));
        // Asked for: the row's next words, up to the burst's or the row's end.
        if (busy) begin
            assert (left != {WORD_BITS{1'b0}} && left <= words && at == row + f_done && rows != 16'd0);
            assert (first <= last && (row_ends ? left == f_span : left > f_span && last == 3'd7));
        end
        // Given: each word from the burst's first to its last, once.
        assume (first_of <= last_of); // as in any place above
        if (!stopping && asked != 3'd0) begin
            assert (f_given == (place <= first_of ? 4'd0 : place <= last_of ? {1'b0, place} - {1'b0, first_of} : f_size));
            assert (!given || f_given + {3'd0, f_moved} == f_size);
        end
        if (axis_tvalid_o) begin
            assert (asked != 3'd0 && place >= first_of && place <= last_of && axis_tdata_o == rd_data_i && axis_tid_o == tag_of);
            assert (axis_tlast_o == (final_of && place == last_of));
            for (k = 0; k < 8; k = k + 1)
                assert (axis_tkeep_o[k] == (k < f_bytes));
        end
        assert (!rd_pop_o || !rd_empty_i);
        cover (f_moved && axis_tlast_o && !axis_tkeep_o[7] && asked == 3'd4 && busy && ROWS != 0);
        cover (f_moved && axis_tlast_o && asked == 3'd3 && axis_tid_o != tag);
        cover (stopping && rd_pop_o && given);
        cover (ask && row_ends && !one_row && first != 3'd0);
    end
    always @(posedge clk_i) if (past && !rst_i && !$past(rst_i)) begin
        if ($past(axis_tvalid_o && !axis_tready_i && !stop_i) && !rd_empty_i) // the word stays
            assert (axis_tvalid_o && $stable(axis_tkeep_o) && $stable(axis_tlast_o) && $stable(axis_tid_o));
        if ($past(start))
            assert (busy && at == $past(desc_base_i) && rows == $past(desc_rows_i) && stride == $past(desc_stride_i)
                    && {words, 3'd0} == $past({2'd0, desc_bytes_i} + 3'd7) >> 3 << 3 && {rest, tag} == $past({desc_bytes_i[2:0], desc_tag_i}));
        else
            assert ($stable({stride, words, rest, tag}));
        if ($past(ask && row_ends))
            assert (busy == !$past(one_row) && at == $past(row) + $past(stride) && rows == $past(rows) - 16'd1);
    end
