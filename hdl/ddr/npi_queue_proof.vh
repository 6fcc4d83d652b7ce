// SPDX-License-Identifier: MIT
//
// npi_queue_proof: the four places never pass each other, and a request keeps its kind.
// Included at the foot of npi_queue.v, only for the prover.

    // The queue's registers, for npi_arbiter_proof.
    wire [(KIND<<LOG2)-1:0]      f_kinds;
    wire [(ADDR_BITS<<LOG2)-1:0] f_addrs;
    wire [4*LOG2-1:0]            f_places = {head, move, issue, back};
    wire [4:0]                   f_moved  = move_index;
    wire [KIND:0]                f_moving = {moving, move_kind};
    genvar f;
    generate
        for (f = 0; f < (1 << LOG2); f = f + 1) begin : g_places
            assign f_kinds[KIND*f +: KIND] = kinds[f];
            assign f_addrs[ADDR_BITS*f +: ADDR_BITS] = addrs[f];
        end
    endgenerate
    wire move_valid = |move_at_o;
    reg past = 1'b0;
    initial assume (rst_i);

    // A request in any one place of the ring comes out as it went in, once, in its turn.
    (* anyconst *) reg [LOG2-1:0] place;
    reg [ADDR_BITS-1:0] addr;
    reg [KIND-1:0] kind;
    reg            inside = 1'b0, issued = 1'b0;
    reg [5:0]      moved = 0, came = 0; // words of it
    wire           is_read   = kind[3];
    wire [5:0]     all_words = {1'b0, last_of(kind[2:0])} + 6'd1;
    // distances from `back`, the oldest
    wire [LOG2-1:0] n_head = head - back, n_move = move - back, n_issue = issue - back,
                    n_place = place - back;

    always @(posedge clk_i) begin
        past <= 1'b1;
        assume (!(push_i && full_o));
        assume (!(move_done_i && !move_valid));
        assume (!(back_done_i && !back_valid_o));
        if (push_i && head == place) begin
            addr   <= push_addr_i;
            kind   <= {push_port_i, push_read_i, push_size_i};
            inside <= 1'b1;
            issued <= 1'b0;
            moved  <= 6'd0;
            came   <= 6'd0;
        end
        if (move_done_i && move == place)
            moved <= moved + 6'd1;
        if (cmd_valid_o && cmd_ready_i && issue == place)
            issued <= 1'b1;
        if (back_done_i && back == place)
            came <= came + 6'd1;
        if (back_ends && back == place)
            inside <= 1'b0;
        if (rst_i)
            inside <= 1'b0;
        if (past && !rst_i) begin
            // The four places keep their order.
            assert (n_issue <= n_move);
            assert (n_move <= n_head);
            assert (inside == (n_place < n_head));
            assert (moving == (move != head));
            assert (full == (head_next == back));
            assert (!moving || move != place || move_kind == kind);
            assert (move_at_o == (moving && !move_read ? {{((1<<PORT_BITS)-1){1'b0}}, 1'b1} << move_port_o : 0));
            assert (move_index <= last_of(move_size) || !moving || move_read);
            assert (back_index <= last_of(back_size) || !coming || !back_read);
            if (!moving || move_read)
                assert (move_index == 5'd0);
            if (!coming || !back_read)
                assert (back_index == 5'd0);
            if (inside) begin
                assert (addrs[place] == addr && kinds[place] == kind);
                assert (issued == (n_place < n_issue));
                // No word of a write before its turn, and all of them before its command.
                if (n_place > n_move)
                    assert (moved == 6'd0);
                if (move == place && moving)
                    assert (moved == (is_read ? 6'd0 : {1'b0, move_index}));
                if (n_place < n_move)
                    assert (moved == (is_read ? 6'd0 : all_words));
                // No word of a read before its command; its words are counted.
                if (back != place)
                    assert (came == 6'd0);
                if (back == place)
                    assert (came == {1'b0, back_index});
            end
            if (cmd_valid_o && issue == place) begin
                assert (inside && !issued);
                assert (cmd_read_o == is_read && cmd_addr_o == addr);
                assert ({1'b0, cmd_last_o} + 6'd1 == all_words);
                assert (is_read || moved == all_words);
            end
            if (back_valid_o && back == place)
                assert (issued && is_read && back_port_o == kind[KIND-1:4]);
            // An offered command or move stays until it is taken.
            if (!$past(rst_i)) begin
                if ($past(cmd_valid_o) && !$past(cmd_ready_i))
                    assert (cmd_valid_o && $stable(cmd_read_o) && $stable(cmd_addr_o) &&
                            $stable(cmd_last_o));
                if ($past(move_valid) && !$past(move_done_i))
                    assert ($stable(move_at_o) && $stable(move_port_o));
                if ($past(back_valid_o) && !$past(back_done_i))
                    assert (back_valid_o && $stable(back_port_o) && $stable(back_index_o));
            end
            cover (full_o);
            cover (inside && issued && is_read && came == 6'd4);
            cover (cmd_valid_o && !cmd_read_o && cmd_last_o == 5'd3);
            // all of them in one cycle, as far as three places allow
            cover (move_done_i && cmd_valid_o && cmd_ready_i && back_done_i);
            cover (push_i && move_done_i && back_done_i);
        end
    end
