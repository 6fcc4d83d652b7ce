// SPDX-License-Identifier: MIT
//
// npi_arbiter_proof: proves npi_arbiter and its parts together; included at the end of npi_arbiter,
// only for the prover (formal.npi_arbiter*).
//
// `me` is any port that keeps the rules of docs/memory.md; the other ports may do anything, and
// must not harm `me`. `mark` is any accepted request (every fourth request, starting with any of
// them), `w_mark` is any word that `me` pushes, and `r_mark` is any word that `me` pops. The prover
// chooses all three, so the assertions about them hold for all requests and words:
// - commands are the accepted requests, in order, each once, aligned; the command of a write
//   follows all its words;
// - words of a write leave the FIFO of their port in order, and reach the back-end at the position
//   that the command has in the stream;
// - words of a read reach the port that requested them, in order, each with its position in its
//   transfer;
// - no FIFO of `me` overflows or is read when empty, and the flags of these FIFOs are correct; a
//   word of a write is in the FIFO when the back-end needs it;
// - a request stays visible to npi_select until it is granted, so that the bound on waiting that is
//   proven for npi_select holds.
//
// The second half relates the counts of this file to the registers of the arbiter, so that a fault
// is detected where it begins. These relations make all assertions together inductive: the proof
// covers runs of any length.

    // The state of the arbiter's parts, for two ports.
    localparam KIND = PORT_BITS + 4, ADDR_BITS = ADDR_WIDTH - 3, X = 2 * FIFO_LOG2;
    (* hierconn *) wire [PORTS-1:0]                 \u_select.f_later , \u_select.f_served ;
    wire [PORTS-1:0] grant = choice & {PORTS{granted}};
    (* hierconn *) wire [(KIND<<QUEUE_LOG2)-1:0]    \u_queue.f_kinds ;
    (* hierconn *) wire [(ADDR_BITS<<QUEUE_LOG2)-1:0] \u_queue.f_addrs ;
    (* hierconn *) wire [4*QUEUE_LOG2-1:0]          \u_queue.f_places ;
    (* hierconn *) wire [4:0]                       \u_queue.f_moved ;
    // highest bit: a request is at the pointer `move`; the other bits: kind of this request
    (* hierconn *) wire [KIND:0]                    \u_queue.f_moving ;
    (* hierconn *) wire [(72<<FIFO_LOG2)-1:0]       \g_port[0].u_write.u_fifo.f_words ,
        \g_port[1].u_write.u_fifo.f_words ;
    (* hierconn *) wire [X-1:0]                     \g_port[0].u_write.u_fifo.f_indexes ,
        \g_port[1].u_write.u_fifo.f_indexes ;
    (* hierconn *) wire [(68<<FIFO_LOG2)-1:0]       \g_port[0].g_fifo.u_read.f_words ,
        \g_port[1].g_fifo.u_read.f_words ;
    (* hierconn *) wire [X-1:0]                     \g_port[0].g_fifo.u_read.f_indexes ,
        \g_port[1].g_fifo.u_read.f_indexes ;
    // write, read
    wire [2*X-1:0] wr_indexes =
        {\g_port[1].u_write.u_fifo.f_indexes , \g_port[0].u_write.u_fifo.f_indexes };
    wire [2*X-1:0] rd_indexes =
        {\g_port[1].g_fifo.u_read.f_indexes , \g_port[0].g_fifo.u_read.f_indexes };
    wire [2*(72<<FIFO_LOG2)-1:0] wr_words =
        {\g_port[1].u_write.u_fifo.f_words , \g_port[0].u_write.u_fifo.f_words };
    wire [2*(68<<FIFO_LOG2)-1:0] rd_words =
        {\g_port[1].g_fifo.u_read.f_words , \g_port[0].g_fifo.u_read.f_words };
    wire [PORTS-1:0] wr_pops   = move_at[PORTS-1:0] & {PORTS{wr_valid_o && wr_ready_i}};
    wire [PORTS-1:0] rd_pushes = back_at & {PORTS{rd_valid_i}} & back_free;

    localparam W = FIFO_LOG2 + QUEUE_LOG2 + 1; // width of word counts
    localparam Q = QUEUE_LOG2, F = FIFO_LOG2;
    localparam [W-1:0] DEPTH = 1 << F, NONE = 0;

    function [W-1:0] words_of;
        input [2:0] log2;
        words_of = {{(W - 1){1'b0}}, 1'b1} << log2;
    endfunction

    (* anyconst *) reg [PORT_BITS-1:0] me;
    (* anyconst *) reg [Q-1:0] mark;
    (* anyconst *) reg [W-1:0] w_mark, r_mark;
    // 1: `me` pops every word at once, and may therefore have any number of outstanding words
    (* anyconst *) reg         eager;
    reg [PORTS-1:0] was_granted;
    reg             asked = 1'b0; // `me` has a request that has not been chosen yet
    initial assume (rst_i);
    always @* assume ({1'b0, me} < PORTS);

    // ---- Pins and FIFOs of `me`; only the first and the last bit of the data
    localparam DEPTH_INT = 1 << F;
    reg          req, ack, rnw, my_grant, push, pop, has_fifo, w_full, w_empty, r_empty, w_flush,
        r_flush, w_pop, r_push;
    reg [2:0]    my_size;
    reg [3:0]    push_word, head_word;
    reg [5:0]    pop_word;
    reg [X-1:0]  w_indexes, r_indexes;
    reg [4*DEPTH_INT-1:0] w_words;
    reg [6*DEPTH_INT-1:0] r_words;
    integer n, x;
    always @* begin
        {req, ack, rnw, my_grant, push, pop, has_fifo, w_full, w_empty, r_empty, w_flush, r_flush,
         w_pop, r_push} = 0;
        my_size = 0;
        {push_word, head_word, pop_word} = 0;
        {w_indexes, r_indexes} = 0;
        w_words = 0;
        r_words = 0;
        for (n = 0; n < PORTS; n = n + 1)
            if (me == n[PORT_BITS-1:0]) begin
                {req, ack, rnw, my_grant} =
                    {npi_addr_req_i[n], npi_addr_ack_o[n], npi_rnw_i[n], grant[n]};
                {push, pop, has_fifo}    = {npi_wr_push_i[n], npi_rd_pop_i[n], READ_FIFO[n]};
                {w_full, w_empty, r_empty} =
                    {npi_wr_almost_full_o[n], npi_wr_empty_o[n], npi_rd_empty_o[n]};
                {w_flush, r_flush, w_pop, r_push} =
                    {npi_wr_flush_i[n], npi_rd_flush_i[n], wr_pops[n], rd_pushes[n]};
                my_size   = npi_size_i[4*n +: 3];
                push_word =
                    {npi_wr_be_i[8*n + 7], npi_wr_data_i[64*n + 63], npi_wr_be_i[8*n],
                     npi_wr_data_i[64*n]};
                head_word = {wr_bes[8*n + 7], wr_datas[64*n + 63], wr_bes[8*n], wr_datas[64*n]};
                pop_word  =
                    {npi_rd_word_o[4*n +: 4], npi_rd_data_o[64*n + 63], npi_rd_data_o[64*n]};
                w_indexes = wr_indexes[X*n +: X];
                r_indexes = rd_indexes[X*n +: X];
                for (x = 0; x < DEPTH_INT; x = x + 1) begin
                    w_words[4*x +: 4] =
                        {wr_words[72*(DEPTH_INT*n + x) + 71], wr_words[72*(DEPTH_INT*n + x) + 63],
                         wr_words[72*(DEPTH_INT*n + x) + 64], wr_words[72*(DEPTH_INT*n + x)]};
                    r_words[6*x +: 6] =
                        {rd_words[68*(DEPTH_INT*n + x) + 63 +: 5], rd_words[68*(DEPTH_INT*n + x)]};
                end
            end
    end
    wire [W-1:0] words = words_of(my_size);
    wire         asks_write = req && !ack && !rnw, asks_read = req && !ack && rnw;
    wire [3:0]   out_word  = {wr_be_o[7], wr_data_o[63], wr_be_o[0], wr_data_o[0]};

    // ---- Counts, modulo 2**W
    // number of words of `me` that were pushed into its FIFO, claimed by accepted writes, or
    // passed to the back-end
    reg [W-1:0] w_pushed, w_claimed, w_moved;
    reg [W-1:0] r_claimed, r_pushed, r_popped;
    // number of words in accepted writes of all ports, and number of these words that were
    // passed to the back-end
    reg [W-1:0] all_w, all_moved;
    // number of words in accepted reads of all ports, in issued reads, and number of words that
    // have arrived from the back-end
    reg [W-1:0] all_r, all_asked, all_came;
    reg [Q-1:0] accepted, issued;             // numbers of requests
    wire        moves  = wr_valid_o && wr_ready_i;
    wire        comes  = rd_valid_i && rd_ready_o;
    wire        issues = cmd_valid_o && cmd_ready_i;
    wire [W-1:0] cmd_words = {2'd0, cmd_last_o} + 1'b1;

    // g_* is the request that is accepted in this clock.
    reg [PORT_BITS-1:0] g_from;
    reg                 g_read;
    reg [2:0]           g_size;
    reg [ADDR_BITS-1:0] g_addr; // address of the first word of this request
    integer g;
    always @* begin
        {g_from, g_read, g_size} = 0;
        g_addr = 0;
        for (g = 0; g < PORTS; g = g + 1)
            if (grant[g]) begin
                g_from = g[PORT_BITS-1:0];
                g_read = npi_rnw_i[g];
                g_size = npi_size_i[4*g +: 3];
                g_addr =
                    {npi_addr_i[32*g + 5 +: ADDR_BITS-2], npi_addr_i[32*g + 4] && g_size != 3'd2,
                          npi_addr_i[32*g + 3] && g_size == 3'd0};
            end
    end
    wire         g_any   = |grant;
    wire [W-1:0] g_words = words_of(g_size);

    // t_* is the marked request while it is in the arbiter. t_stream and t_own are the values of
    // the two counts at which its words begin.
    reg                 t_live = 1'b0;
    reg [PORT_BITS-1:0] t_port;
    reg                 t_read;
    reg [2:0]           t_size;
    reg [ADDR_BITS-1:0] t_addr;
    reg [W-1:0]         t_stream, t_own;
    wire [W-1:0] t_words = words_of(t_size);
    // index of the next word in the marked request; valid if the next word belongs to this request
    wire [W-1:0] t_index = (t_read ? all_came : all_moved) - t_stream;
    wire         t_next  = t_live && t_index < t_words;
    wire [W-1:0] t_own_index = t_own + t_index; // among `me`'s
    wire         t_mine  = t_port == me;
    wire [PORTS-1:0] t_one = {{(PORTS - 1){1'b0}}, 1'b1} << t_port;

    // s_* are the values at which the words of each queued request begin, in the counts of all
    // writes, of all reads, of the writes of `me` and of the reads of `me`.
    localparam SLOTS = 1 << Q;
    reg [W*SLOTS-1:0] s_w, s_r, s_wo, s_ro;

    // w_value and r_value are the marked words while they are in FIFOs of `me`.
    reg  [3:0] w_value;
    reg  [5:0] r_value;
    reg        r_have = 1'b0;
    // number of words in each FIFO
    wire [W-1:0] w_level = w_pushed - w_moved, r_level = r_pushed - r_popped;
    wire       w_have = w_mark - w_moved < w_level;

    always @(posedge clk_i) begin
        asked     <= !rst_i && req && !ack && !my_grant;
        was_granted <= rst_i ? {PORTS{1'b0}} : grant;
        accepted  <= accepted + {{(Q - 1){1'b0}}, g_any};
        issued    <= issued + {{(Q - 1){1'b0}}, issues};
        all_w     <= all_w + (g_any && !g_read ? g_words : 0);
        all_r     <= all_r + (g_any && g_read ? g_words : 0);
        all_asked <= all_asked + (issues && cmd_read_o ? cmd_words : 0);
        all_moved <= all_moved + {{(W - 1){1'b0}}, moves};
        all_came  <= all_came + {{(W - 1){1'b0}}, comes};
        w_pushed  <= w_pushed + {{(W - 1){1'b0}}, push};
        w_claimed <= w_claimed + (my_grant && !rnw ? words : 0);
        w_moved   <= w_moved + {{(W - 1){1'b0}}, w_pop};
        r_claimed <= r_claimed + (my_grant && rnw ? words : 0);
        r_pushed  <= r_pushed + {{(W - 1){1'b0}}, r_push};
        r_popped  <= r_popped + {{(W - 1){1'b0}}, has_fifo ? pop : r_push};
        if (g_any && accepted == mark) begin
            t_live   <= 1'b1;
            t_port   <= g_from;
            t_read   <= g_read;
            t_size   <= g_size;
            t_addr   <= g_addr;
            t_stream <= g_read ? all_r : all_w;
            t_own    <= g_read ? r_claimed : w_claimed;
        end else if (t_live && (t_read ? comes && t_next && t_index == t_words - 1'b1
                                       : issues && issued == mark))
            t_live <= 1'b0;
        if (g_any) begin
            s_w[W*accepted +: W]  <= all_w;
            s_r[W*accepted +: W]  <= all_r;
            s_wo[W*accepted +: W] <= w_claimed;
            s_ro[W*accepted +: W] <= r_claimed;
        end
        if (push && w_pushed == w_mark)
            w_value <= push_word;
        if (comes && t_next && t_read && t_mine && t_own_index == r_mark && has_fifo) begin
            r_value <= {t_index[1:0] | 4'd0, rd_data_i[63], rd_data_i[0]};
            r_have  <= 1'b1;
        end else if (pop && r_popped == r_mark)
            r_have <= 1'b0;
        if (rst_i || w_flush) begin
            {w_pushed, w_claimed, w_moved} <= 0;
            s_wo <= 0;
        end
        if (rst_i || r_flush) begin
            {r_claimed, r_pushed, r_popped, r_have} <= 0;
            s_ro <= 0;
        end
        if (rst_i) begin
            {accepted, issued, all_w, all_r, all_asked, all_moved, all_came} <= 0;
            t_live <= 1'b0;
        end
    end

    // ---- Rules of docs/memory.md
    integer q;
    always @* begin
        for (q = 0; q < PORTS; q = q + 1)
            // no transfer is larger than the FIFOs of this proof; npi_queue is proven with all
            // sizes
            assume (npi_size_i[4*q +: 3] <= F);
        assume (!asked || req); // a request is held until it is acknowledged
        assume (!push || !w_full);
        assume (!asks_write || w_pushed - w_claimed + {{(W - 1){1'b0}}, push} >= words);
        assume (!asks_read || !has_fifo || eager || r_claimed - r_popped + words <= DEPTH);
        assume (!has_fifo || !pop || !r_empty);
        assume (!eager || pop == !r_empty);
        assume (!w_flush || (!asks_write && w_claimed == w_moved));
        assume (!r_flush || (!asks_read && r_claimed == r_pushed));
        // the back-end delivers only words that were requested
        assume (!rd_valid_i || all_asked != all_came);
    end

    // ---- Guarantees
    integer o;
    always @* if (!rst_i) begin
        assert (npi_addr_ack_o == was_granted);
        // the request is not withdrawn, so npi_select sees it all the time, and the bound of
        // npi_select holds
        assert (!asked || !ack);
        assert ((grant & ~npi_addr_req_i) == 0 && (grant & npi_addr_ack_o) == 0 &&
                (grant & (grant - 1'b1)) == 0);
        assert (!cmd_valid_o || issued != accepted);
        if (cmd_valid_o && issued == mark) begin
            assert (t_live && cmd_read_o == t_read && cmd_word == t_addr);
            assert (cmd_words == t_words);
            assert (t_read || all_moved - t_stream >= t_words);
        end
        if (moves && t_next && !t_read) begin
            assert (wr_pops == t_one);
            if (t_mine && t_own_index == w_mark)
                assert (w_have && out_word == w_value);
        end
        // the MCB gets data and byte enables of the port whose FIFO delivers a word, unchanged
        for (o = 0; o < PORTS; o = o + 1)
            assert (!wr_pops[o] ||
                    {wr_be_o, wr_data_o} == {wr_bes[8*o +: 8], wr_datas[64*o +: 64]});
        assert (moves == |wr_pops && (!moves || all_moved != all_w));
        if (rd_valid_i && t_next && t_read) begin
            assert (rd_pushes == (comes ? t_one : 0));
            // a port without a read FIFO takes the word in this clock
            if (t_mine && !has_fifo && !r_empty)
                assert (rd_ready_o == pop &&
                        pop_word == {t_index[1:0] | 4'd0, rd_data_i[63], rd_data_i[0]});
        end
        assert (comes == |rd_pushes);
        if (has_fifo && r_have && !r_empty && r_popped == r_mark)
            assert (pop_word == r_value);
        // the flags agree with the number of words
        assert (w_level <= DEPTH);
        assert (w_full == (w_level == DEPTH));
        assert (!w_pop || !w_empty);
        assert (w_claimed - w_moved <= w_level); // the words that were claimed are in the FIFO
        assert (BLOCK_RAM != 0 || w_empty == (w_level == 0));
        assert (w_empty || w_level != 0);
        if (has_fifo) begin
            assert (!r_push || r_level != DEPTH);
            assert (BLOCK_RAM != 0 || r_empty == (r_level == 0));
            assert (r_empty || r_level != 0);
        end
        cover (moves && t_next && !t_read && t_mine && t_own_index == w_mark && t_index == 2 &&
               w_value == 4'b0110);
        cover (pop && has_fifo && r_have && r_popped == r_mark && r_value[5:2] == 4'd3);
        cover (w_full && moves && issues && comes);
        cover (eager && r_claimed - r_popped > DEPTH);
        cover (cmd_valid_o && issued == mark && t_mine && t_read && moves && !t_next);
    end

    // ---- Relations of the counts to the registers of the arbiter
    wire [Q-1:0] head, move, issue, back;
    assign {head, move, issue, back} = \u_queue.f_places ;
    wire [Q-1:0] n_head = head - back, n_move = move - back, n_issue = issue - back,
        n_mark = mark - back;
    wire [KIND-1:0] move_kind = \u_queue.f_kinds [KIND*move +: KIND],
        back_kind = \u_queue.f_kinds [KIND*back +: KIND],
                    t_kind = \u_queue.f_kinds [KIND*mark +: KIND];
    wire [W-1:0] moved = \u_queue.f_moved , came = back_index;
    wire [W-1:0] moved_me = move_kind[KIND-1:4] == me ? moved : 0;
    wire [W-1:0] came_me  = back_kind[KIND-1:4] == me ? came : 0;
    wire [3:0] w_word = w_words[4*w_mark[F-1:0] +: 4];
    wire [5:0] r_word = r_words[6*r_mark[F-1:0] +: 6];
    // b_* are the values s_*, except for the place that the next request gets: there they are the
    // counts.
    reg [W*SLOTS-1:0] b_w, b_r, b_wo, b_ro;
    always @* begin
        b_w  = s_w;
        b_r  = s_r;
        b_wo = s_wo;
        b_ro = s_ro;
        b_w[W*head +: W]  = all_w;
        b_r[W*head +: W]  = all_r;
        b_wo[W*head +: W] = w_claimed;
        b_ro[W*head +: W] = r_claimed;
    end
    genvar f;
    generate
        for (f = 0; f < SLOTS; f = f + 1) begin : g_slot
            localparam NEXT = (f + 1) % SLOTS;
            localparam [Q-1:0] ME = f;
            wire [KIND-1:0] kind = \u_queue.f_kinds [KIND*f +: KIND];
            wire [Q-1:0]    d    = ME - back;
            wire [W-1:0]    w    = words_of(kind[2:0]);
            wire            mine = kind[KIND-1:4] == me;
            always @* if (!rst_i && d < n_head) begin
                assert (kind[2:0] <= F && {1'b0, kind[KIND-1:4]} < PORTS);
                assert (b_w[W*NEXT +: W] == b_w[W*f +: W] + (kind[3] ? NONE : w));
                assert (b_r[W*NEXT +: W] == b_r[W*f +: W] + (kind[3] ? w : NONE));
                assert (d < n_move ||
                        b_wo[W*NEXT +: W] == b_wo[W*f +: W] + (kind[3] || !mine ? NONE : w));
                assert (b_ro[W*NEXT +: W] == b_ro[W*f +: W] + (kind[3] && mine ? w : NONE));
            end
        end
    endgenerate
    always @* if (!rst_i) begin
        assert ((\u_select.f_later & \u_select.f_served ) == 0);
        assert ((npi_addr_ack_o & ~\u_select.f_served ) == 0);
        assert (full == ({1'b0, n_head} == SLOTS - 1));
        assert (\u_queue.f_moving [KIND] == (move != head) &&
                (move == head || \u_queue.f_moving [KIND-1:0] == move_kind));
        assert (move_at ==
                (move != head &&
                 !move_kind[3] ? {{((1<<PORT_BITS)-1){1'b0}}, 1'b1} << move_kind[KIND-1:4] : 0));
        assert (accepted == head && issued == issue);
        assert (n_issue <= n_move && n_move <= n_head);
        assert (!g_any || {1'b0, n_head} != SLOTS - 1); // the queue has room for the request
        assert (moved == 0 || (move != head && !move_kind[3] && moved < words_of(move_kind[2:0])));
        assert (came == 0 || (back != issue && back_kind[3] && came < words_of(back_kind[2:0])));
        assert (all_moved == b_w[W*move +: W] + moved && w_moved == b_wo[W*move +: W] + moved_me);
        assert (all_asked == b_r[W*issue +: W]);
        assert (all_came == b_r[W*back +: W] + came && r_pushed == b_ro[W*back +: W] + came_me);
        assert (rd_ready_o || back == issue || !back_kind[3] ||
                (back_kind[KIND-1:4] == me ? !has_fifo && !pop : 1'b1));
        assert (t_live == (n_mark < n_head && (t_kind[3] || n_mark >= n_issue)));
        if (t_live) begin
            assert (t_kind == {t_port, t_read, t_size} &&
                    \u_queue.f_addrs [ADDR_BITS*mark +: ADDR_BITS] == t_addr);
            assert (t_stream == (t_read ? s_r[W*mark +: W] : s_w[W*mark +: W]));
            assert (!t_mine || (!t_read && n_mark < n_move) ||
                    t_own == (t_read ? s_ro[W*mark +: W] : s_wo[W*mark +: W]));
        end
        assert (w_indexes == {w_pushed[F-1:0], w_moved[F-1:0]});
        assert (BLOCK_RAM == 0 || !w_empty || w_level <= 1);
        if (w_have) begin
            assert (w_word == w_value);
            if (w_moved == w_mark && !w_empty)
                assert (head_word == w_value);
        end
        if (has_fifo) begin
            assert (r_indexes == {r_pushed[F-1:0], r_popped[F-1:0]});
            assert (BLOCK_RAM == 0 || !r_empty || r_level <= 1);
            assert (r_level <= DEPTH);
            assert (eager || r_claimed - r_popped <= DEPTH);
            if (eager) begin
                assert (r_level <= (BLOCK_RAM != 0 ? 2 : 1));
                assert (BLOCK_RAM == 0 || r_level != 2 || !r_empty);
            end
            if (r_have) begin
                assert (r_mark - r_popped < r_level);
                assert (r_word == r_value);
            end
        end else
            assert (!r_have && r_level == 0);
    end
