// SPDX-License-Identifier: MIT
//
// async_fifo_proof: words leave async_fifo in order, unchanged and in their own session; only for the prover.
//
// It is included in the module's body. Time goes in steps, each with an edge of either clock, of both or of none.
// A bit that changed in the step before the other clock's edge may arrive old or new, each bit by itself.

    (* hierconn, init = 8'd0 *) wire [TOP:0] \u_to_reader.bit_meta , \u_to_writer.bit_meta ;

    (* gclk *) wire step;
    (* anyseq *) reg [TOP:0] reader_sees, writer_sees;
    reg [TOP:0] was_to_reader = 0, was_to_writer = 0;
    always @(posedge step)
        {was_to_reader, was_to_writer} <= {to_reader, to_writer};
    assign to_reader_async = (to_reader & reader_sees) | (was_to_reader & ~reader_sees);
    assign to_writer_async = (to_writer & writer_sees) | (was_to_writer & ~writer_sees);

    // The note stands for what the reader lays out with restart_i and the writer takes with begins_o, such as an address.
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

    // `value` is the word with number `place` of a session; the prover chooses which.
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
    wire [LOG2:0] w1 = binary(\u_to_reader.bit_meta [LOG2:0]), w2 = binary(to_reader_sync[LOG2:0]);
    wire [LOG2:0] t1 = binary(\u_to_writer.bit_meta [LOG2:0]), t2 = binary(to_writer_sync[LOG2:0]);
    wire [LOG2:0] held_seen = written - t2, count = written - taken;
    // The session's flip makes a round: from the reader through a synchroniser to the writer, and back through the other.
    wire [6:0] round = {to_writer[TOP], \u_to_writer.bit_meta [TOP], to_writer_sync[TOP], session, to_reader[TOP],
                        \u_to_reader.bit_meta [TOP], to_reader_sync[TOP]};
    wire [5:0] flips = round[6:1] ^ round[5:0];
    wire same      = session == to_writer[TOP];          // the writer is in the reader's session
    wire told      = \u_to_reader.bit_meta [TOP] == to_writer[TOP];

    always @* begin
        assume (!(push_i && (begins_o || held_seen == DEPTH)));
        assume (!(pop_i && (empty_o || restart_i)));
        assume (RESTARTS != 0 || !restart_i);
        // Only one flip is on its way at a time.
        assert ((flips & (flips - 6'd1)) == 6'd0);
        assert (to_reader[LOG2:0] == (written ^ (written >> 1)) && to_writer[LOG2:0] == (taken ^ (taken >> 1)));
        if (same) begin
            // The FIFO never holds more words than fit; each side sees the other's pointer late, never early.
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
        // The reader therefore takes words in order, unchanged, and of its own session.
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
