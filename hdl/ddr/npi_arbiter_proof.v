// SPDX-License-Identifier: MIT
//
// npi_arbiter_proof: proves npi_arbiter as a whole, with its parts; only for the prover (formal.npi_arbiter_*).
//
// `me` is any port that keeps the rules of docs/memory.md; the others are free and must not harm
// it. `mark` is any accepted request (every fourth, from any on), `w_mark` any word that `me`
// pushes, `r_mark` any word that it pops. The assertions on them therefore hold for all:
// - commands are the accepted requests, in their order, each once, aligned; a write's after all its words;
// - words of a write leave their own port's FIFO, in order, with the command's place in the back-end's stream;
// - words of a read reach their own port, in order, each with its place in its transfer;
// - no FIFO of `me` overflows or is read empty; its flags are true; a word is there when it is needed;
// - a request stays visible to npi_select until it is granted, so that one's proven bound on waiting holds.
//
// The second half relates the harness's counts to the arbiter's registers, so a fault is seen where
// it begins. With it all assertions together are inductive: runs of any length are proven.

`default_nettype none

`ifdef FORMAL
module npi_arbiter_proof #(
    parameter             PORTS      = 2,
    parameter [PORTS-1:0] READ_FIFO  = 0,
    parameter             BLOCK      = 0,
    parameter             PORT_BITS  = 1,
    parameter             ADDR_BITS  = 6, // of a word
    parameter             FIFO_LOG2  = 2,
    parameter             QUEUE_LOG2 = 2
) (
    input wire                 clk_i,
    input wire                 rst_i,
    // ports
    input wire [32*PORTS-1:0]  addr_i,
    input wire [PORTS-1:0]     req_i,
    input wire [PORTS-1:0]     ack_i,
    input wire [PORTS-1:0]     grant_i, // a clock before ack
    input wire [PORTS-1:0]     rnw_i,
    input wire [4*PORTS-1:0]   size_i,
    input wire [64*PORTS-1:0]  wr_data_i,
    input wire [8*PORTS-1:0]   wr_be_i,
    input wire [PORTS-1:0]     wr_push_i,
    input wire [PORTS-1:0]     wr_empty_i,
    input wire [PORTS-1:0]     wr_full_i,
    input wire [PORTS-1:0]     wr_flush_i,
    input wire [64*PORTS-1:0]  rd_data_i,
    input wire [4*PORTS-1:0]   rd_word_i,
    input wire [PORTS-1:0]     rd_pop_i,
    input wire [PORTS-1:0]     rd_empty_i,
    input wire [PORTS-1:0]     rd_flush_i,
    // back-end
    input wire                 cmd_valid_i,
    input wire                 cmd_read_i,
    input wire [ADDR_BITS-1:0] cmd_addr_i,
    input wire [4:0]           cmd_last_i,
    input wire                 cmd_ready_i,
    input wire                 wr_valid_i,
    input wire [63:0]          out_data_i,
    input wire [7:0]           out_be_i,
    input wire                 wr_ready_i,
    input wire                 in_valid_i,
    input wire [63:0]          in_data_i,
    input wire                 in_ready_i,
    // inside: FIFOs in use, and what they and the queue hold
    input wire [PORTS-1:0]     wr_pop_i,
    input wire [64*PORTS-1:0]  wr_heads_i, // data_o of the write FIFOs
    input wire [8*PORTS-1:0]   wr_head_bes_i,
    input wire [PORTS-1:0]     rd_push_i,
    input wire [PORTS*2*(FIFO_LOG2+1)-1:0] wr_indexes_i, // write, read
    input wire [PORTS*2*(FIFO_LOG2+1)-1:0] rd_indexes_i,
    input wire [PORTS*(72<<FIFO_LOG2)-1:0] wr_words_i,
    input wire [PORTS*(68<<FIFO_LOG2)-1:0] rd_words_i,
    input wire [((PORT_BITS+4)<<QUEUE_LOG2)-1:0] kinds_i,
    input wire [(ADDR_BITS<<QUEUE_LOG2)-1:0] addrs_i,
    input wire [4*QUEUE_LOG2-1:0] places_i, // head, move, issue, back
    input wire [PORT_BITS+4:0] moving_i, // something moves; its kind
    input wire [(1<<PORT_BITS)-1:0] move_at_i, // one-hot
    input wire [PORTS-1:0]     later_i, // of npi_select
    input wire                 full_i, // of npi_queue
    input wire [4:0]           moved_i, // words of the write that moves
    input wire [4:0]           came_i   // words of the read that comes
);
    localparam W = FIFO_LOG2 + QUEUE_LOG2 + 1; // counts of words
    localparam Q = QUEUE_LOG2, F = FIFO_LOG2, KIND = PORT_BITS + 4;
    localparam [W-1:0] DEPTH = 1 << F, NONE = 0;

    function [W-1:0] words_of;
        input [2:0] size;
        words_of = {{(W - 1){1'b0}}, 1'b1} << size;
    endfunction

    (* anyconst *) reg [PORT_BITS-1:0] me;
    (* anyconst *) reg [Q-1:0] mark;
    (* anyconst *) reg [W-1:0] w_mark, r_mark;
    (* anyconst *) reg         eager; // `me` pops every word at once, and has any number outstanding
    reg [PORTS-1:0] granted;
    reg             asked = 1'b0; // `me` asks, and is not chosen
    initial assume (rst_i);
    always @* assume ({1'b0, me} < PORTS);

    // ---- `me`'s pins and FIFOs; of data the first and the last bit of all
    localparam X = 2 * (F + 1), DEPTH_INT = 1 << F;
    reg          req, ack, rnw, grant, push, pop, has_fifo, w_full, w_empty, r_empty, w_flush, r_flush, w_pop, r_push;
    reg [2:0]    size;
    reg [3:0]    push_word, head_word;
    reg [5:0]    pop_word;
    reg [X-1:0]  w_indexes, r_indexes;
    reg [4*DEPTH_INT-1:0] w_words;
    reg [6*DEPTH_INT-1:0] r_words;
    integer p, x;
    always @* begin
        {req, ack, rnw, grant, push, pop, has_fifo, w_full, w_empty, r_empty, w_flush, r_flush, w_pop, r_push} = 0;
        size = 0;
        {push_word, head_word, pop_word} = 0;
        {w_indexes, r_indexes} = 0;
        w_words = 0;
        r_words = 0;
        for (p = 0; p < PORTS; p = p + 1)
            if (me == p[PORT_BITS-1:0]) begin
                {req, ack, rnw, grant}   = {req_i[p], ack_i[p], rnw_i[p], grant_i[p]};
                {push, pop, has_fifo}    = {wr_push_i[p], rd_pop_i[p], READ_FIFO[p]};
                {w_full, w_empty, r_empty} = {wr_full_i[p], wr_empty_i[p], rd_empty_i[p]};
                {w_flush, r_flush, w_pop, r_push} = {wr_flush_i[p], rd_flush_i[p], wr_pop_i[p], rd_push_i[p]};
                size      = size_i[4*p +: 3];
                push_word = {wr_be_i[8*p + 7], wr_data_i[64*p + 63], wr_be_i[8*p], wr_data_i[64*p]};
                head_word = {wr_head_bes_i[8*p + 7], wr_heads_i[64*p + 63], wr_head_bes_i[8*p], wr_heads_i[64*p]};
                pop_word  = {rd_word_i[4*p +: 4], rd_data_i[64*p + 63], rd_data_i[64*p]};
                w_indexes = wr_indexes_i[X*p +: X];
                r_indexes = rd_indexes_i[X*p +: X];
                for (x = 0; x < DEPTH_INT; x = x + 1) begin
                    w_words[4*x +: 4] = {wr_words_i[72*(DEPTH_INT*p + x) + 71], wr_words_i[72*(DEPTH_INT*p + x) + 63],
                                         wr_words_i[72*(DEPTH_INT*p + x) + 64], wr_words_i[72*(DEPTH_INT*p + x)]};
                    r_words[6*x +: 6] = {rd_words_i[68*(DEPTH_INT*p + x) + 63 +: 5], rd_words_i[68*(DEPTH_INT*p + x)]};
                end
            end
    end
    wire [W-1:0] words = words_of(size);
    wire         asks_write = req && !ack && !rnw, asks_read = req && !ack && rnw;
    wire [3:0]   out_word  = {out_be_i[7], out_data_i[63], out_be_i[0], out_data_i[0]};

    // ---- Counts, modulo 2**W
    reg [W-1:0] w_pushed, w_claimed, w_moved; // of `me`: in its FIFO; of accepted writes; gone
    reg [W-1:0] r_claimed, r_pushed, r_popped;
    reg [W-1:0] all_w, all_moved;             // of all ports: words of accepted writes; gone
    reg [W-1:0] all_r, all_asked, all_came;   // words of accepted reads; of their commands; come
    reg [Q-1:0] accepted, issued;             // requests
    wire        moves  = wr_valid_i && wr_ready_i;
    wire        comes  = in_valid_i && in_ready_i;
    wire        issues = cmd_valid_i && cmd_ready_i;
    wire [W-1:0] cmd_words = {2'd0, cmd_last_i} + 1'b1;

    // g_* is the request that is accepted now.
    reg [PORT_BITS-1:0] g_port;
    reg                 g_read;
    reg [2:0]           g_size;
    reg [ADDR_BITS-1:0] g_addr; // its first word
    integer g;
    always @* begin
        {g_port, g_read, g_size} = 0;
        g_addr = 0;
        for (g = 0; g < PORTS; g = g + 1)
            if (grant_i[g]) begin
                g_port = g[PORT_BITS-1:0];
                g_read = rnw_i[g];
                g_size = size_i[4*g +: 3];
                g_addr = {addr_i[32*g + 5 +: ADDR_BITS-2], addr_i[32*g + 4] && g_size != 3'd2,
                          addr_i[32*g + 3] && g_size == 3'd0};
            end
    end
    wire         g_any   = |grant_i;
    wire [W-1:0] g_words = words_of(g_size);

    // t_* is the marked request while it is in the arbiter, and where its words begin in each count.
    reg                 t_live = 1'b0;
    reg [PORT_BITS-1:0] t_port;
    reg                 t_read;
    reg [2:0]           t_size;
    reg [ADDR_BITS-1:0] t_addr;
    reg [W-1:0]         t_stream, t_own;
    wire [W-1:0] t_words = words_of(t_size);
    wire [W-1:0] t_index = (t_read ? all_came : all_moved) - t_stream; // of the next word, if it is one of its
    wire         t_next  = t_live && t_index < t_words;
    wire [W-1:0] t_own_index = t_own + t_index; // among `me`'s
    wire         t_mine  = t_port == me;
    wire [PORTS-1:0] t_one = {{(PORTS - 1){1'b0}}, 1'b1} << t_port;

    // s_* are the places at which each queued request's words begin in the counts of all writes, all reads, `me`'s writes, reads.
    localparam SLOTS = 1 << Q;
    reg [W*SLOTS-1:0] s_w, s_r, s_wo, s_ro;

    // w_value and r_value are the marked words while they are in `me`'s FIFOs.
    reg  [3:0] w_value;
    reg  [5:0] r_value;
    reg        r_have = 1'b0;
    wire [W-1:0] w_level = w_pushed - w_moved, r_level = r_pushed - r_popped; // words in the FIFOs
    wire       w_have = w_mark - w_moved < w_level;

    always @(posedge clk_i) begin
        asked     <= !rst_i && req && !ack && !grant;
        granted   <= rst_i ? {PORTS{1'b0}} : grant_i;
        accepted  <= accepted + {{(Q - 1){1'b0}}, g_any};
        issued    <= issued + {{(Q - 1){1'b0}}, issues};
        all_w     <= all_w + (g_any && !g_read ? g_words : 0);
        all_r     <= all_r + (g_any && g_read ? g_words : 0);
        all_asked <= all_asked + (issues && cmd_read_i ? cmd_words : 0);
        all_moved <= all_moved + {{(W - 1){1'b0}}, moves};
        all_came  <= all_came + {{(W - 1){1'b0}}, comes};
        w_pushed  <= w_pushed + {{(W - 1){1'b0}}, push};
        w_claimed <= w_claimed + (grant && !rnw ? words : 0);
        w_moved   <= w_moved + {{(W - 1){1'b0}}, w_pop};
        r_claimed <= r_claimed + (grant && rnw ? words : 0);
        r_pushed  <= r_pushed + {{(W - 1){1'b0}}, r_push};
        r_popped  <= r_popped + {{(W - 1){1'b0}}, has_fifo ? pop : r_push};
        if (g_any && accepted == mark) begin
            t_live   <= 1'b1;
            t_port   <= g_port;
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
            r_value <= {t_index[1:0] | 4'd0, in_data_i[63], in_data_i[0]};
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

    // ---- Rules of the contract
    integer q;
    always @* begin
        for (q = 0; q < PORTS; q = q + 1)
            assume (size_i[4*q +: 3] <= F); // the FIFOs' depth; npi_queue is proven with all sizes
        assume (!asked || req); // a request stays
        assume (!push || !w_full);
        assume (!asks_write || w_pushed - w_claimed + {{(W - 1){1'b0}}, push} >= words);
        assume (!asks_read || !has_fifo || eager || r_claimed - r_popped + words <= DEPTH);
        assume (!has_fifo || !pop || !r_empty);
        assume (!eager || pop == !r_empty);
        assume (!w_flush || (!asks_write && w_claimed == w_moved));
        assume (!r_flush || (!asks_read && r_claimed == r_pushed));
        assume (!in_valid_i || all_asked != all_came); // the back-end gives requested words only
    end

    // ---- Guarantees
    integer o;
    always @* if (!rst_i) begin
        assert (ack_i == granted);
        assert (!asked || !ack); // so npi_select sees it all the time, and its bound holds
        assert ((grant_i & ~req_i) == 0 && (grant_i & ack_i) == 0 && (grant_i & (grant_i - 1'b1)) == 0);
        assert (!cmd_valid_i || issued != accepted);
        if (cmd_valid_i && issued == mark) begin
            assert (t_live && cmd_read_i == t_read && cmd_addr_i == t_addr);
            assert (cmd_words == t_words);
            assert (t_read || all_moved - t_stream >= t_words);
        end
        if (moves && t_next && !t_read) begin
            assert (wr_pop_i == t_one);
            if (t_mine && t_own_index == w_mark)
                assert (w_have && out_word == w_value);
        end
        for (o = 0; o < PORTS; o = o + 1) // all leaving bits
            assert (!wr_pop_i[o] || {out_be_i, out_data_i} == {wr_head_bes_i[8*o +: 8], wr_heads_i[64*o +: 64]});
        assert (moves == |wr_pop_i && (!moves || all_moved != all_w));
        if (in_valid_i && t_next && t_read) begin
            assert (rd_push_i == (comes ? t_one : 0));
            if (t_mine && !has_fifo && !r_empty) // a port without a FIFO takes it in this clock
                assert (in_ready_i == pop && pop_word == {t_index[1:0] | 4'd0, in_data_i[63], in_data_i[0]});
        end
        assert (comes == |rd_push_i);
        if (has_fifo && r_have && !r_empty && r_popped == r_mark)
            assert (pop_word == r_value);
        // the flags and their meaning
        assert (w_level <= DEPTH);
        assert (w_full == (w_level == DEPTH));
        assert (!w_pop || !w_empty);
        assert (w_claimed - w_moved <= w_level); // requested words are there
        assert (BLOCK != 0 || w_empty == (w_level == 0));
        assert (w_empty || w_level != 0);
        if (has_fifo) begin
            assert (!r_push || r_level != DEPTH);
            assert (BLOCK != 0 || r_empty == (r_level == 0));
            assert (r_empty || r_level != 0);
        end
        cover (moves && t_next && !t_read && t_mine && t_own_index == w_mark && t_index == 2 && w_value == 4'b0110);
        cover (pop && has_fifo && r_have && r_popped == r_mark && r_value[5:2] == 4'd3);
        cover (w_full && moves && issues && comes);
        cover (eager && r_claimed - r_popped > DEPTH);
        cover (cmd_valid_i && issued == mark && t_mine && t_read && moves && !t_next);
    end

    // ---- The counts and the arbiter's registers
    wire [Q-1:0] head, move, issue, back;
    assign {head, move, issue, back} = places_i;
    wire [Q-1:0] n_head = head - back, n_move = move - back, n_issue = issue - back, n_mark = mark - back;
    wire [KIND-1:0] move_kind = kinds_i[KIND*move +: KIND], back_kind = kinds_i[KIND*back +: KIND],
                    t_kind = kinds_i[KIND*mark +: KIND];
    wire [W-1:0] moved = moved_i, came = came_i;
    wire [W-1:0] moved_me = move_kind[KIND-1:4] == me ? moved : 0;
    wire [W-1:0] came_me  = back_kind[KIND-1:4] == me ? came : 0;
    wire [3:0] w_word = w_words[4*w_mark[F-1:0] +: 4];
    wire [5:0] r_word = r_words[6*r_mark[F-1:0] +: 6];
    // b_* are s_*, with the counts themselves for the slot that is accepted next.
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
            wire [KIND-1:0] kind = kinds_i[KIND*f +: KIND];
            wire [Q-1:0]    d    = ME - back;
            wire [W-1:0]    w    = words_of(kind[2:0]);
            wire            mine = kind[KIND-1:4] == me;
            always @* if (!rst_i && d < n_head) begin
                assert (kind[2:0] <= F && {1'b0, kind[KIND-1:4]} < PORTS);
                assert (b_w[W*NEXT +: W] == b_w[W*f +: W] + (kind[3] ? NONE : w));
                assert (b_r[W*NEXT +: W] == b_r[W*f +: W] + (kind[3] ? w : NONE));
                assert (d < n_move || b_wo[W*NEXT +: W] == b_wo[W*f +: W] + (kind[3] || !mine ? NONE : w));
                assert (b_ro[W*NEXT +: W] == b_ro[W*f +: W] + (kind[3] && mine ? w : NONE));
            end
        end
    endgenerate
    always @* if (!rst_i) begin
        assert ((later_i & ack_i) == 0);
        assert (full_i == ({1'b0, n_head} == SLOTS - 1));
        assert (moving_i[KIND] == (move != head) && (move == head || moving_i[KIND-1:0] == move_kind));
        assert (move_at_i == (move != head && !move_kind[3] ? {{((1<<PORT_BITS)-1){1'b0}}, 1'b1} << move_kind[KIND-1:4] : 0));
        assert (accepted == head && issued == issue);
        assert (n_issue <= n_move && n_move <= n_head);
        assert (!g_any || {1'b0, n_head} != SLOTS - 1); // the queue has a place for it
        assert (moved == 0 || (move != head && !move_kind[3] && moved < words_of(move_kind[2:0])));
        assert (came == 0 || (back != issue && back_kind[3] && came < words_of(back_kind[2:0])));
        assert (all_moved == b_w[W*move +: W] + moved && w_moved == b_wo[W*move +: W] + moved_me);
        assert (all_asked == b_r[W*issue +: W]);
        assert (all_came == b_r[W*back +: W] + came && r_pushed == b_ro[W*back +: W] + came_me);
        assert (in_ready_i || back == issue || !back_kind[3] || (back_kind[KIND-1:4] == me ? !has_fifo && !pop : 1'b1));
        assert (t_live == (n_mark < n_head && (t_kind[3] || n_mark >= n_issue)));
        if (t_live) begin
            assert (t_kind == {t_port, t_read, t_size} && addrs_i[ADDR_BITS*mark +: ADDR_BITS] == t_addr);
            assert (t_stream == (t_read ? s_r[W*mark +: W] : s_w[W*mark +: W]));
            assert (!t_mine || (!t_read && n_mark < n_move) || t_own == (t_read ? s_ro[W*mark +: W] : s_wo[W*mark +: W]));
        end
        assert (w_indexes == {w_pushed[F:0], w_moved[F:0]});
        if (w_have) begin
            assert (w_word == w_value);
            if (w_moved == w_mark && !w_empty)
                assert (head_word == w_value);
        end
        if (has_fifo) begin
            assert (r_indexes == {r_pushed[F:0], r_popped[F:0]});
            assert (r_level <= DEPTH);
            assert (eager || r_claimed - r_popped <= DEPTH);
            if (eager) begin
                assert (r_level <= (BLOCK != 0 ? 2 : 1));
                assert (BLOCK == 0 || r_level != 2 || !r_empty);
            end
            if (r_have) begin
                assert (r_mark - r_popped < r_level);
                assert (r_word == r_value);
            end
        end else
            assert (!r_have && r_level == 0);
    end
endmodule
`endif
