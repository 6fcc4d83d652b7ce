// SPDX-License-Identifier: MIT
//
// npi_queue: queue of accepted requests. It transfers the words of writes to the back-end, issues
// the commands, and returns the words of reads to their ports.
//
// One LUT RAM holds 2**LOG2 requests (one place stays free). Four pointers follow each other:
//   head   place for the next accepted request
//   move   write with words that are being sent to the back-end (reads are skipped)
//   issue  request of the next command; a write first sends all its words
//   back   read with words that are arriving (writes are skipped)
// In the same cycle, a request can be accepted, a write word can be sent, a command can be issued
// and a read word can arrive. Commands are issued in the order of acceptance.

`default_nettype none
`include "count_up.vh"
`include "shift_order.vh"

module npi_queue #(
    parameter PORT_BITS = 1,  // width of a port number
    parameter ADDR_BITS = 24, // width of the address of a 64-bit word
    parameter LOG2      = 4   // log2 of the number of places, 2..5
) (
    input  wire                 clk_i,
    input  wire                 rst_i,
    // accepted requests
    input  wire                 push_i,
    input  wire [PORT_BITS-1:0] push_port_i,
    input  wire                 push_read_i,
    input  wire [2:0]           push_size_i, // size of the transfer: 2**size words, size is 0..5
    input  wire [ADDR_BITS-1:0] push_addr_i,
    output wire                 full_o,
    // words of writes
    // port that must send a word next, one-hot; 0 if no port must send one
    output reg  [(1<<PORT_BITS)-1:0] move_at_o,
    output wire [PORT_BITS-1:0] move_port_o,
    input  wire                 move_done_i,  // high if the word is sent in this cycle
    // commands
    output wire                 cmd_valid_o,
    output wire                 cmd_read_o,
    output wire [ADDR_BITS-1:0] cmd_addr_o,
    output wire [4:0]           cmd_last_o,   // number of words minus 1
    input  wire                 cmd_ready_i,
    // words of reads
    // high if a word is expected from the back-end, for port back_port_o
    output wire                 back_valid_o,
    output wire [PORT_BITS-1:0] back_port_o,
    output wire [4:0]           back_index_o, // position of the word in its transfer
    input  wire                 back_done_i   // high if the word arrives in this cycle
);
    localparam KIND = PORT_BITS + 4;

    reg [ADDR_BITS-1:0] addrs [0:(1<<LOG2)-1];
    reg [KIND-1:0] kinds [0:(1<<LOG2)-1]; // kind of a request: port, read, size
    // The initial values prevent Yosys from making a second copy of these registers, as address
    // registers inside the RAM.
    reg [LOG2-1:0] head = 0, move = 0, issue = 0, back = 0;
    reg [4:0]      move_index, back_index;

    `SHIFT_ORDER(after, LOG2)
    `SHIFT_ORDER(moved_after, 5)
    `SHIFT_NUMBERS(moved_of, moved_number, moved_after, 5)

    `COUNT_UP(up, 5)

    // Returns the number of words minus 1 for a size; sizes 6 and 7 count as 5.
    function [4:0] last_of;
        input [2:0] size;
        last_of = {size[2] && |size[1:0], size[2], size[2] || &size[1:0], size[2] || size[1],
                   |size};
    endfunction
    // Returns the number of words minus 1 for the size of the request at `move`.
    function [4:0] move_last_of;
        input [2:0] size;
        case (size)
            3'd0:    move_last_of = moved_of(0);
            3'd1:    move_last_of = moved_of(1);
            3'd2:    move_last_of = moved_of(3);
            3'd3:    move_last_of = moved_of(7);
            3'd4:    move_last_of = moved_of(15);
            default: move_last_of = moved_of(31);
        endcase
    endfunction

    // The queue is full if only one place is free. `full` is a flip-flop, because requests wait for
    // this signal.
    wire [LOG2-1:0] head_next = after(head);
    wire            nearly    = after(head_next) == back;
    reg             full;
    assign full_o = full;

    // The kind of the request at `move` is in flip-flops, because the write FIFOs depend on it.
    // These flip-flops are loaded from the RAM or, if the request is not in the RAM yet, from the
    // input.
    reg             moving;
    reg [KIND-1:0]  move_kind;
    wire [KIND-1:0] push_kind = {push_port_i, push_read_i, push_size_i};
    wire [LOG2-1:0] move_next = after(move);
    wire            fresh     = !moving || move_next == head;
    wire            next_is   = !fresh || push_i;
    wire [KIND-1:0] next_kind = fresh ? push_kind : kinds[move_next];

    wire       move_read, issue_read, back_read;
    wire [2:0] move_size, issue_size, back_size;
    wire [PORT_BITS-1:0] issue_port;
    assign {move_port_o, move_read, move_size} = move_kind;
    assign {issue_port, issue_read, issue_size} = kinds[issue];
    assign {back_port_o, back_read, back_size} = kinds[back];

    wire       move_last  = move_index == move_last_of(move_size);
    wire       move_ends  = moving && (move_read || (move_done_i && move_last));

    assign cmd_valid_o = issue != move;
    assign cmd_read_o  = issue_read;
    assign cmd_addr_o  = addrs[issue];
    assign cmd_last_o  = last_of(issue_size);

    wire coming     = back != issue;
    wire back_last  = back_index == last_of(back_size);
    wire back_ends  = coming && (!back_read || (back_done_i && back_last));
    assign back_valid_o = coming && back_read;
    assign back_index_o = back_index;

    always @(posedge clk_i) begin
        if (push_i) begin
            addrs[head] <= push_addr_i;
            kinds[head] <= push_kind;
            head        <= head_next;
        end
        if (move_done_i)
            move_index <= moved_after(move_index);
        if (move_ends)
            move <= move_next;
        if (move_ends || !moving) begin
            moving    <= next_is;
            move_kind <= next_kind;
            move_at_o <=
                {{((1<<PORT_BITS)-1){1'b0}}, next_is && !next_kind[3]} << next_kind[KIND-1:4];
        end
        if (cmd_valid_o && cmd_ready_i)
            issue <= after(issue);
        if (back_done_i)
            back_index <= up(back_index);
        if (back_ends)
            back <= after(back);
        full <= !back_ends && (full || (push_i && nearly));
        if (rst_i) begin
            full  <= 1'b0;
            head  <= 0;
            move  <= 0;
            issue <= 0;
            back  <= 0;
            moving    <= 1'b0;
            move_at_o <= 0;
        end
        if (rst_i || (move_done_i && move_last))
            move_index <= 5'd0;
        if (rst_i || (back_done_i && back_last))
            back_index <= 5'd0;
    end

    wire unused = &{1'b0, issue_port, 1'b0};

`ifdef FORMAL
    // Proves that the four pointers never pass each other, and that the kind of a request does not
    // change. npi_arbiter_proof reads the following copies of the queue registers, in which the
    // requests are numbered by their position.
    `SHIFT_NUMBERS(place_of, number_of, after, LOG2)
    wire [(KIND<<LOG2)-1:0]      f_kinds;
    wire [(ADDR_BITS<<LOG2)-1:0] f_addrs;
    wire [4*LOG2-1:0]            f_places =
        {number_of(head), number_of(move), number_of(issue), number_of(back)};
    wire [4:0]                   f_moved  = moved_number(move_index);
    wire [KIND:0]                f_moving = {moving, move_kind};
    genvar f;
    generate
        for (f = 0; f < (1 << LOG2); f = f + 1) begin : g_places
            assign f_kinds[KIND*f +: KIND] = kinds[place_of(f)];
            assign f_addrs[ADDR_BITS*f +: ADDR_BITS] = addrs[place_of(f)];
        end
    endgenerate
    wire move_valid = |move_at_o;
    reg past = 1'b0;
    initial assume (rst_i);

    // A request at any position of the ring leaves the queue once, unchanged, and in order.
    (* anyconst *) reg [LOG2-1:0] place;
    reg [ADDR_BITS-1:0] addr;
    reg [KIND-1:0] kind;
    reg            inside = 1'b0, issued = 1'b0;
    // number of words of this request that have been sent, and number that have arrived
    reg [5:0]      moved = 0, came = 0;
    wire           is_read   = kind[3];
    wire [5:0]     all_words = {1'b0, last_of(kind[2:0])} + 6'd1;
    // distance of each pointer from `back`, the oldest pointer
    wire [LOG2-1:0] f_head, f_move, f_issue, f_back;
    assign {f_head, f_move, f_issue, f_back} = f_places;
    wire [LOG2-1:0] n_head = f_head - f_back, n_move = f_move - f_back, n_issue = f_issue - f_back,
                    n_place = number_of(place) - f_back;

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
            // The four pointers keep their order.
            assert (n_issue <= n_move);
            assert (n_move <= n_head);
            assert (inside == (n_place < n_head));
            assert (moving == (move != head));
            assert (full == (head_next == back));
            assert (!moving || move != place || move_kind == kind);
            assert (move_at_o ==
                    (moving && !move_read ? {{((1<<PORT_BITS)-1){1'b0}}, 1'b1} << move_port_o : 0));
            assert (f_moved <= last_of(move_size) || !moving || move_read);
            assert (back_index <= last_of(back_size) || !coming || !back_read);
            if (!moving || move_read)
                assert (move_index == 5'd0);
            if (!coming || !back_read)
                assert (back_index == 5'd0);
            if (inside) begin
                assert (addrs[place] == addr && kinds[place] == kind);
                assert (issued == (n_place < n_issue));
                // The words of a write are not sent before the words of earlier writes, and all of
                // them are sent before the command of the write.
                if (n_place > n_move)
                    assert (moved == 6'd0);
                if (move == place && moving)
                    assert (moved == (is_read ? 6'd0 : {1'b0, f_moved}));
                if (n_place < n_move)
                    assert (moved == (is_read ? 6'd0 : all_words));
                // The words of a read do not arrive before the words of earlier reads; back_index
                // counts the words.
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
            // A command, or the request for a word of a write, stays unchanged until it is
            // accepted.
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
            // Each line reaches a cycle with three of the four actions. All four at once would need
            // more requests than the three that fit into the queue of this proof.
            cover (move_done_i && cmd_valid_o && cmd_ready_i && back_done_i);
            cover (push_i && move_done_i && back_done_i);
        end
    end
`endif
`ifdef COVER_POINTS
    is_full: cover property (@(posedge clk_i) full_o);
    longest_write: cover property (@(posedge clk_i) cmd_valid_o && cmd_ready_i && !cmd_read_o &&
                                   cmd_last_o == 5'd31);
    longest_read: cover property (@(posedge clk_i) cmd_valid_o && cmd_ready_i && cmd_read_o &&
                                  cmd_last_o == 5'd31);
    back_end_holds_command: cover property (@(posedge clk_i) cmd_valid_o && !cmd_ready_i);
    all_at_once: cover property (@(posedge clk_i) push_i && move_done_i && cmd_valid_o &&
                                 cmd_ready_i && back_done_i);
`endif
endmodule
