// SPDX-License-Identifier: MIT
//
// async_fifo: words from one clock to another, whatever their ratio and phase; either may stand still.
//
// Each side tells the other its session and its pointer, in Gray code, out of flip-flops and through two more.
// The reader may restart the FIFO: it drops what is there and what is on its way, with a new session: its pointer goes
// to 0 with the session's flip, seen a clock earlier than anybody looks at it; the writer answers so in turn.
// No reset: the clocks' resets come at different times. Pointers begin at 0 with the configuration; a reader
// that wants it empty takes what is in it, or restarts.

`default_nettype none

module async_fifo #(
    parameter WIDTH    = 11,
    parameter LOG2     = 5, // 2**LOG2 words, 2..6
    parameter SPARE    = 0, // full_o comes while so many words still fit, 0..2**LOG2 - 1
    parameter RESTARTS = 0  // 1: restart_i and begins_o are used
) (
    // writer
    input  wire             write_clk_i,
    input  wire             push_i,     // SPARE times at most while full_o is high, never with begins_o
    input  wire [WIDTH-1:0] data_i,
    output wire             full_o,
    output wire             begins_o,   // one cycle: what was pushed is gone; what comes is of the new session
    // reader
    input  wire             read_clk_i,
    input  wire             restart_i,  // one cycle, without pop_i
    input  wire             pop_i,      // only while empty_o is low
    output wire [WIDTH-1:0] data_o,     // valid while empty_o is low
    output wire             empty_o     // of this session
);
    localparam TOP = LOG2 + 1; // of what crosses: the session; below it the pointer
    localparam [LOG2:0] DEPTH = 1 << LOG2;

    reg [WIDTH-1:0] words [0:(1<<LOG2)-1];
    reg [LOG2:0] written, taken;                // one bit more than the address
    reg [TOP:0]  to_reader, to_writer;          // what crosses
    reg [TOP:0]  at_reader_maybe, at_reader;
    reg [TOP:0]  at_writer_maybe, at_writer;
    reg          session;                       // the writer's: told a clock after its pointer is 0
    reg          waiting;                       // to restart, until the session before has been answered
    wire [TOP:0] into_reader, into_writer;      // what the first flip-flops see

    initial begin
        {written, taken, session, waiting}            = {(2*LOG2+4){1'b0}};
        {to_reader, at_reader_maybe, at_reader}       = {3*(LOG2+2){1'b0}};
        {to_writer, at_writer_maybe, at_writer}       = {3*(LOG2+2){1'b0}};
    end

    // ---- writer
    wire [LOG2:0] next_written = written + 1'b1;
    wire full;
    assign begins_o = at_writer[TOP] != session;
    assign full_o   = full || begins_o;
    generate
        if (SPARE == 0) begin : g_full
            // A whole turn ahead: in Gray code the two upper bits differ and the others do not.
            assign full = to_reader[LOG2:0] == {~at_writer[LOG2:LOG2-1], at_writer[LOG2-2:0]};
        end else begin : g_almost_full
            wire [LOG2:0] seen;
            genvar b;
            for (b = 0; b <= LOG2; b = b + 1) begin : g_seen
                assign seen[b] = ^at_writer[LOG2:b];
            end
            wire [LOG2:0] held = written - seen;
            assign full = held >= DEPTH - SPARE[LOG2:0];
        end
    endgenerate

    always @(posedge write_clk_i) begin
        at_writer_maybe <= into_writer;
        at_writer       <= at_writer_maybe;
        session         <= at_writer[TOP];
        to_reader[TOP]  <= session;
        if (push_i) begin
            words[written[LOG2-1:0]] <= data_i;
            written           <= next_written;
            to_reader[LOG2:0] <= next_written ^ (next_written >> 1);
        end
        if (begins_o) begin
            written           <= {(LOG2+1){1'b0}};
            to_reader[LOG2:0] <= {(LOG2+1){1'b0}};
        end
    end

    // ---- reader
    wire answered = at_reader[TOP] == to_writer[TOP];
    wire wants    = RESTARTS != 0 && (restart_i || waiting);
    wire restarts = wants && answered;
    wire [LOG2:0] next_taken = taken + 1'b1;
    assign data_o  = words[taken[LOG2-1:0]];
    assign empty_o = !answered || waiting || at_reader[LOG2:0] == to_writer[LOG2:0];

    always @(posedge read_clk_i) begin
        at_reader_maybe <= into_reader;
        at_reader       <= at_reader_maybe;
        waiting         <= wants && !answered;
        to_writer[TOP]  <= to_writer[TOP] ^ restarts;
        if (pop_i) begin
            taken             <= next_taken;
            to_writer[LOG2:0] <= next_taken ^ (next_taken >> 1);
        end
        if (restarts) begin
            taken             <= {(LOG2+1){1'b0}};
            to_writer[LOG2:0] <= {(LOG2+1){1'b0}};
        end
    end

`ifdef FORMAL
    // Time goes in steps, with an edge of either clock, of both or of none in each. What changed in the step
    // before a flip-flop of the other clock takes it may come as it was or as it is, each bit by itself.
    (* gclk *) wire step;
    (* anyseq *) reg [TOP:0] reader_sees, writer_sees;
    reg [TOP:0] was_to_reader = 0, was_to_writer = 0;
    always @(posedge step)
        {was_to_reader, was_to_writer} <= {to_reader, to_writer};
    assign into_reader = (to_reader & reader_sees) | (was_to_reader & ~reader_sees);
    assign into_writer = (to_writer & writer_sees) | (was_to_writer & ~writer_sees);

    // What the reader lays out with restart_i, and the writer takes over with begins_o: an address, say.
    localparam NOTE = 2;
    (* anyseq *) reg [NOTE-1:0] any_note, note_sees;
    reg [NOTE-1:0] note = 0, was_note = 0, noted = 0;
    always @(posedge step)
        was_note <= note;
    always @(posedge read_clk_i)
        if (restart_i)
            note <= any_note;
    always @(posedge write_clk_i)
        if (begins_o)
            noted <= (note & note_sees) | (was_note & ~note_sees);

    // The word with number `place` of a session, whichever.
    (* anyconst *) reg [LOG2:0] place;
    reg [WIDTH-1:0] value;
    always @(posedge write_clk_i)
        if (push_i && written == place)
            value <= data_i;

    function [LOG2:0] binary(input [LOG2:0] code);
        integer b;
        begin
            binary[LOG2] = code[LOG2];
            for (b = LOG2 - 1; b >= 0; b = b - 1)
                binary[b] = binary[b+1] ^ code[b];
        end
    endfunction
    wire [LOG2:0] w1 = binary(at_reader_maybe[LOG2:0]), w2 = binary(at_reader[LOG2:0]);
    wire [LOG2:0] t1 = binary(at_writer_maybe[LOG2:0]), t2 = binary(at_writer[LOG2:0]);
    wire [LOG2:0] held_seen = written - t2, count = written - taken;
    // The session's flip goes round: reader, its synchroniser, writer, the other synchroniser.
    wire [6:0] round = {to_writer[TOP], at_writer_maybe[TOP], at_writer[TOP], session, to_reader[TOP],
                        at_reader_maybe[TOP], at_reader[TOP]};
    wire [5:0] flips = round[6:1] ^ round[5:0];
    wire same      = session == to_writer[TOP];          // the writer is in the reader's session
    wire told      = at_reader_maybe[TOP] == to_writer[TOP];

    always @* begin
        assume (!(push_i && (begins_o || held_seen == DEPTH)));
        assume (!(pop_i && (empty_o || restart_i)));
        assume (RESTARTS != 0 || !restart_i);
        // Once at a time.
        assert ((flips & (flips - 6'd1)) == 6'd0);
        assert (to_reader[LOG2:0] == (written ^ (written >> 1)) && to_writer[LOG2:0] == (taken ^ (taken >> 1)));
        if (same) begin
            // Never more than fits; what a side sees of the other is behind the truth, never ahead of it.
            assert (count <= DEPTH && held_seen <= DEPTH);
            assert (taken - t1 <= taken - t2);
            assert (full_o == (held_seen >= DEPTH - SPARE));
            assert (waiting || noted == note);
            if (place - taken < count)
                assert (words[place[LOG2-1:0]] == value);
        end
        if (told)
            assert (written - w1 <= count);
        if (answered)
            assert (written - w1 <= written - w2 && written - w2 <= count);
        if (!answered)
            assert (taken == 0);
        // So: what the reader takes is in order, unchanged, and of its own session.
        if (!empty_o) begin
            assert (same && noted == note);
            if (taken == place)
                assert (data_o == value);
        end
        cover (full_o && !begins_o);
        cover (!empty_o && taken[LOG2] && data_o != {WIDTH{1'b0}});
        cover (RESTARTS == 0 || (!empty_o && noted == 1 && place == 1 && taken == 1));
        cover (RESTARTS == 0 || (waiting && answered));
    end
`else
    assign into_reader = to_reader;
    assign into_writer = to_writer;
`endif
`ifdef COVER_POINTS
    is_full: cover property (@(posedge write_clk_i) full);
    session_begins: cover property (@(posedge write_clk_i) begins_o);
    restart_waits: cover property (@(posedge read_clk_i) wants && !answered);
`endif
endmodule
