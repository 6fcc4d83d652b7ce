// SPDX-License-Identifier: MIT
//
// async_fifo: carries words from one clock to another, whatever their ratio and phase; either may stand still.
//
// Each side sends the other its session and its pointer, in Gray code, from flip-flops through two more: `_async` is
// what arrives, `_meta` the first flip-flop, `_sync` the second, which alone may be looked at.
//
// The reader may restart the FIFO. Its session bit flips and its pointer returns to 0; it then ignores the words in
// the FIFO until the writer, which answers by the same flip, has returned its own pointer to 0.
//
// There is no reset, because the resets of two clocks come at different times. Pointers begin at 0 with the
// configuration; a reader that wants the FIFO empty takes what is in it, or restarts it.

`default_nettype none

module async_fifo #(
    parameter WIDTH    = 11,
    parameter LOG2     = 5, // 2**LOG2 words, 2..6
    parameter SPARE    = 0, // words that still fit when full_o rises, 0..2**LOG2 - 1
    parameter RESTARTS = 0  // 1: restart_i and begins_o are used
) (
    // writer
    input  wire             write_clk_i,
    input  wire             push_i,     // at most SPARE times while full_o is high, never with begins_o
    input  wire [WIDTH-1:0] data_i,
    output wire             full_o,
    output wire             begins_o,   // one cycle: the words so far are dropped, the next ones belong to a new session
    // reader
    input  wire             read_clk_i,
    input  wire             restart_i,  // one cycle, without pop_i
    input  wire             pop_i,      // only while empty_o is low
    output wire [WIDTH-1:0] data_o,     // valid while empty_o is low
    output wire             empty_o     // there is no word of this session
);
    localparam TOP = LOG2 + 1; // number of the session's bit in what crosses; the pointer is below it
    localparam [LOG2:0] DEPTH = 1 << LOG2;

    reg [WIDTH-1:0] words [0:(1<<LOG2)-1];
    reg [LOG2:0] written, taken;                // pointers, one bit wider than the address
    reg [TOP:0]  to_reader, to_writer;          // session and pointer, in the clock of the side that sends them
    wire [TOP:0] to_reader_async, to_writer_async;
    wire [TOP:0] to_reader_sync, to_writer_sync;
    cdc_bit #(.WIDTH(LOG2+2), .EXACT(1)) u_to_reader (
        .clk_i(read_clk_i), .bit_async_i(to_reader_async), .bit_sync_o(to_reader_sync));
    cdc_bit #(.WIDTH(LOG2+2), .EXACT(1)) u_to_writer (
        .clk_i(write_clk_i), .bit_async_i(to_writer_async), .bit_sync_o(to_writer_sync));
    reg          session;                       // the writer's session; it is sent a clock after the pointer has become 0
    reg          waiting;                       // a restart waits until the one before it has been answered

    initial begin
        {written, taken, session, waiting}          = {(2*LOG2+4){1'b0}};
        to_reader = {(LOG2+2){1'b0}};
        to_writer = {(LOG2+2){1'b0}};
    end

    // ---- writer
    wire [LOG2:0] next_written = written + 1'b1;
    wire full;
    assign begins_o = to_writer_sync[TOP] != session;
    assign full_o   = full || begins_o;
    generate
        if (SPARE == 0) begin : g_full
            // Full is one whole turn ahead: in Gray code the two upper bits differ and the others are equal.
            assign full = to_reader[LOG2:0] == {~to_writer_sync[LOG2:LOG2-1], to_writer_sync[LOG2-2:0]};
        end else begin : g_almost_full
            wire [LOG2:0] seen;
            genvar b;
            for (b = 0; b <= LOG2; b = b + 1) begin : g_seen
                assign seen[b] = ^to_writer_sync[LOG2:b];
            end
            wire [LOG2:0] held = written - seen;
            assign full = held >= DEPTH - SPARE[LOG2:0];
        end
    endgenerate

    always @(posedge write_clk_i) begin
        session         <= to_writer_sync[TOP];
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
    wire answered = to_reader_sync[TOP] == to_writer[TOP];
    wire wants    = RESTARTS != 0 && (restart_i || waiting);
    wire restarts = wants && answered;
    wire [LOG2:0] next_taken = taken + 1'b1;
    assign data_o  = words[taken[LOG2-1:0]];
    assign empty_o = !answered || waiting || to_reader_sync[LOG2:0] == to_writer[LOG2:0];

    always @(posedge read_clk_i) begin
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
`include "async_fifo_proof.vh"
`elsif VERILATOR
    cdc_skew #(.WIDTH(LOG2+2)) u_skew_to_reader (
        .src_clk_i(write_clk_i), .bits_i(to_reader), .dst_clk_i(read_clk_i), .bits_o(to_reader_async));
    cdc_skew #(.WIDTH(LOG2+2)) u_skew_to_writer (
        .src_clk_i(read_clk_i), .bits_i(to_writer), .dst_clk_i(write_clk_i), .bits_o(to_writer_async));
`else
    assign to_reader_async = to_reader;
    assign to_writer_async = to_writer;
`endif
`ifdef COVER_POINTS
    is_full: cover property (@(posedge write_clk_i) full);
    session_begins: cover property (@(posedge write_clk_i) begins_o);
    restart_waits: cover property (@(posedge read_clk_i) wants && !answered);
`endif
endmodule
