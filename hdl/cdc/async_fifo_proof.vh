// SPDX-License-Identifier: MIT
//
// async_fifo_proof: words leave async_fifo in order and unchanged; only for the prover.
//
// It is included in the module's body. Time goes in steps, each with an edge of either clock, of both or of none.
// A bit that changed in the step before the other clock's edge may arrive old or new, each bit by itself.

    (* hierconn, init = 8'd0 *) wire [LOG2:0] \u_to_reader.bit_meta , \u_to_writer.bit_meta ;

    (* gclk *) wire step;
    (* anyseq *) reg [LOG2:0] reader_sees, writer_sees;
    reg [LOG2:0] was_to_reader = 0, was_to_writer = 0;
    always @(posedge step)
        {was_to_reader, was_to_writer} <= {to_reader, to_writer};
    assign to_reader_async = (to_reader & reader_sees) | (was_to_reader & ~reader_sees);
    assign to_writer_async = (to_writer & writer_sees) | (was_to_writer & ~writer_sees);

    // `value` is the word with number `place`; the prover chooses which.
    localparam [LOG2:0] DEPTH = 1 << LOG2;
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
    wire [LOG2:0] w1 = binary(\u_to_reader.bit_meta ), w2 = binary(to_reader_sync);
    wire [LOG2:0] t1 = binary(\u_to_writer.bit_meta ), t2 = binary(to_writer_sync);
    wire [LOG2:0] held_seen = written - t2, count = written - taken;

    always @* begin
        assume (!(push_i && full_o));
        assume (!(pop_i && empty_o));
        assert (to_reader == (written ^ (written >> 1)) && to_writer == (taken ^ (taken >> 1)));
        // The FIFO never holds more words than fit; each side sees the other's pointer late, never early.
        assert (count <= DEPTH && held_seen <= DEPTH);
        assert (full_o == (held_seen == DEPTH));
        assert (taken - t1 <= taken - t2 && taken - t2 <= held_seen);
        assert (written - w1 <= written - w2 && written - w2 <= count);
        if (place - taken < count)
            assert (words[place[LOG2-1:0]] == value);
        // The reader therefore takes words in order and unchanged.
        if (!empty_o && taken == place)
            assert (data_o == value);
        cover (full_o);
        cover (!empty_o && taken[LOG2] && data_o != {WIDTH{1'b0}});
    end
