// SPDX-License-Identifier: MIT
//
// async_fifo: FIFO between two clock domains. The clocks may have any ratio and phase, and either
// clock may stop.
//
// Each side sends its pointer to the other side in Gray code, through a two-stage synchroniser. The
// name of a signal ends in `_async` before the synchroniser and in `_sync` after it; only `_sync`
// may be used.
//
// The FIFO has no reset, because a reset would reach the two clock domains at different times. The
// pointers are 0 after configuration. To empty the FIFO, the reader takes the words that are in it.

`default_nettype none

module async_fifo #(
    parameter WIDTH = 11,
    parameter LOG2  = 5 // depth: 2**LOG2 words, LOG2 is 2..6
) (
    // writer
    input  wire             write_clk_i,
    input  wire             push_i,     // pushes a word; allowed only while full_o is low
    input  wire [WIDTH-1:0] data_i,
    output wire             full_o,
    // reader
    input  wire             read_clk_i,
    // takes the word on data_o; allowed only while empty_o is low
    input  wire             pop_i,
    output wire [WIDTH-1:0] data_o,     // valid while empty_o is low
    output wire             empty_o
);
    reg [WIDTH-1:0] words [0:(1<<LOG2)-1];
    reg [LOG2:0]  written, taken;       // read and write pointers, one bit wider than the address
    // the same pointers in Gray code, registered in the clock of the side that sends them
    reg [LOG2:0]  to_reader, to_writer;
    wire [LOG2:0] to_reader_async, to_writer_async;
    wire [LOG2:0] to_reader_sync, to_writer_sync;
    cdc_bit #(.WIDTH(LOG2+1), .EXACT(1)) u_to_reader (
        .clk_i(read_clk_i), .bit_async_i(to_reader_async), .bit_sync_o(to_reader_sync));
    cdc_bit #(.WIDTH(LOG2+1), .EXACT(1)) u_to_writer (
        .clk_i(write_clk_i), .bit_async_i(to_writer_async), .bit_sync_o(to_writer_sync));

    initial {written, taken, to_reader, to_writer} = {(4*LOG2+4){1'b0}};

    // ---- writer
    wire [LOG2:0] next_written = written + 1'b1;
    // The FIFO is full if the write pointer is DEPTH ahead of the read pointer. In Gray code the
    // two upper bits of the pointers then differ, and the other bits are equal.
    assign full_o  = to_reader == {~to_writer_sync[LOG2:LOG2-1], to_writer_sync[LOG2-2:0]};
    always @(posedge write_clk_i)
        if (push_i) begin
            words[written[LOG2-1:0]] <= data_i;
            written   <= next_written;
            to_reader <= next_written ^ (next_written >> 1);
        end

    // ---- reader
    wire [LOG2:0] next_taken = taken + 1'b1;
    assign data_o  = words[taken[LOG2-1:0]];
    assign empty_o = to_reader_sync == to_writer;
    always @(posedge read_clk_i)
        if (pop_i) begin
            taken     <= next_taken;
            to_writer <= next_taken ^ (next_taken >> 1);
        end

`ifdef VERILATOR
    cdc_skew #(.WIDTH(LOG2+1)) u_skew_to_reader (
        .src_clk_i(write_clk_i), .bits_i(to_reader), .dst_clk_i(read_clk_i),
        .bits_o(to_reader_async));
    cdc_skew #(.WIDTH(LOG2+1)) u_skew_to_writer (
        .src_clk_i(read_clk_i), .bits_i(to_writer), .dst_clk_i(write_clk_i),
        .bits_o(to_writer_async));
`elsif FORMAL // below
`else
    assign to_reader_async = to_reader;
    assign to_writer_async = to_writer;
`endif

`ifdef FORMAL
    // Proves that words leave in order and unchanged. Time advances in steps; in each step, either
    // clock, both clocks or none of them has an edge. If a bit changed in the step before an edge
    // of the other clock, the edge may sample the old or the new value, independently for each bit.
    (* hierconn, init = 8'd0 *) wire [LOG2:0] \u_to_reader.bit_meta , \u_to_writer.bit_meta ;

    (* gclk *) wire step;
    (* anyseq *) reg [LOG2:0] reader_sees, writer_sees;
    reg [LOG2:0] was_to_reader = 0, was_to_writer = 0;
    always @(posedge step)
        {was_to_reader, was_to_writer} <= {to_reader, to_writer};
    assign to_reader_async = (to_reader & reader_sees) | (was_to_reader & ~reader_sees);
    assign to_writer_async = (to_writer & writer_sees) | (was_to_writer & ~writer_sees);

    // `value` is the word under observation. The prover chooses its position `place`.
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
        // The FIFO never holds more words than its depth. A side may see an old value of the other
        // side's pointer, but never a value that this pointer has not reached yet.
        assert (count <= DEPTH && held_seen <= DEPTH);
        assert (full_o == (held_seen == DEPTH));
        assert (taken - t1 <= taken - t2 && taken - t2 <= held_seen);
        assert (written - w1 <= written - w2 && written - w2 <= count);
        if (place - taken < count)
            assert (words[place[LOG2-1:0]] == value);
        // Therefore the reader takes the words in order and unchanged.
        if (!empty_o && taken == place)
            assert (data_o == value);
        cover (full_o);
        cover (!empty_o && taken[LOG2] && data_o != {WIDTH{1'b0}});
    end
`endif
`ifdef COVER_POINTS
    is_full: cover property (@(posedge write_clk_i) full_o);
`endif
endmodule
