// SPDX-License-Identifier: MIT
//
// fsmc_post: merges halfword writes into words of four halfwords in the write FIFO of the memory
// port, and queues the addresses of these words.
//
// The FIFO collects the open word (MERGE in npi_arbiter): a halfword is stored in the FIFO in the
// clock in which it arrives. The word is closed after a write of its last byte, when a write to
// another word arrives, or if flush_i is high. Its address then waits in this module for the
// request.

`default_nettype none
`include "count_up.vh"
`include "shift_order.vh"

module fsmc_post #(
    parameter ADDR_BITS = 25, // width of a halfword address
    parameter WIDTH     = 16, // width of a halfword
    // number of closed words that can wait: 2**LOG2 - 1, which must not exceed the depth of the
    // FIFO
    parameter LOG2      = 4
) (
    input  wire                 clk_i,
    input  wire                 rst_i,
    // writes: one per cycle of wr_i
    input  wire                 wr_i,
    input  wire [ADDR_BITS-1:0] wr_addr_i, // halfword address
    input  wire [WIDTH-1:0]     wr_data_i,
    input  wire [1:0]           wr_be_i,
    // high in the cycle of a write that is lost, because there is no room for it
    output wire                 wr_lost_o,
    output wire                 room_o,    // room for at least two halfwords
    output wire                 more_room_o, // room for at least three halfwords
    input  wire                 flush_i,
    output wire                 idle_o,    // no word is open, and no closed word waits
    // write FIFO of the port
    // the FIFO stores these bytes; in the cycle of push_o, they belong to the next word
    output wire [7:0]           store_be_o,
    output wire [4*WIDTH-1:0]   store_data_o,
    output wire                 push_o,    // high for one cycle: the word is closed
    // closed word that has waited longest
    output wire                 word_valid_o,
    output wire [ADDR_BITS-3:0] word_addr_o,
    input  wire                 word_taken_i
);
    localparam WORD = ADDR_BITS - 2;

    reg [WORD-1:0] addrs [0:(1<<LOG2)-1];
    // The `count` entries from `head` to the one before `tail`, in shift order, are the addresses
    // of the closed words. The initial values prevent Yosys from duplicating head (as in
    // npi_queue).
    `SHIFT_ORDER(after, LOG2)
    reg [LOG2-1:0] head = 0, tail = 0, count;
    reg            open, none; // none: count == 0
    reg [WORD-1:0] open_addr;
    reg            ended; // the last byte of the open word was written

    wire       joins = open_addr == wr_addr_i[ADDR_BITS-1:2];

    `COUNT_UP(up, LOG2)

    wire full   = &count; // no other word can be closed, so the open word stays open
    wire close  = open && !full && (ended || flush_i || (wr_i && !joins));
    wire accept = wr_i && !(full && open && !joins);
    wire begins = accept && |wr_be_i; // a word without bytes is not opened

    assign wr_lost_o    = wr_i && !accept;
    // The open word is counted as a closed word, so that only a write reduces the room.
    assign room_o       = !(&count[LOG2-1:1] || (open && count == (1 << LOG2) - 3));
    localparam [LOG2-1:0] LOW = 3;
    assign more_room_o  = !(&(count | LOW) && (count[0] || count[1] || open));
    assign word_valid_o = !none;
    assign idle_o       = !open && !word_valid_o;
    assign word_addr_o  = addrs[head];
    assign push_o       = close;

    wire [3:0] bank = 4'd1 << wr_addr_i[1:0];
    wire [7:0] take = {{2{bank[3]}}, {2{bank[2]}}, {2{bank[1]}}, {2{bank[0]}}} & {4{wr_be_i}} &
        {8{accept}};
    assign store_be_o   = take;
    assign store_data_o = {4{wr_data_i}};

    always @(posedge clk_i) begin
        if (close)
            addrs[tail] <= open_addr;
        if (close != word_taken_i)
            // the number does not depend on `close`, which arrives late
            count <= word_taken_i ? ~up(~count) : up(count);
        if (close)
            tail <= after(tail);
        if (close || word_taken_i)
            none <= !close && count == 1;
        open  <= begins || (open && !close);
        ended <= take[7] || (ended && !close);
        if (accept)
            open_addr <= wr_addr_i[ADDR_BITS-1:2];
        if (word_taken_i)
            head <= after(head);
        if (rst_i) begin
            head <= 0;
            tail <= 0;
            count <= 0;
            none <= 1'b1;
            open <= 1'b0;
            ended <= 1'b0;
        end
    end

`ifdef FORMAL
    // Proves that every accepted halfword reaches the memory, in order. `place` is the address of
    // the halfword under observation, which the prover chooses. Other masters may write this
    // halfword while no word of this module waits.
    (* anyconst *) reg [ADDR_BITS-1:0] place;
    (* anyseq *) reg foreign;
    (* anyseq *) reg [WIDTH-1:0] foreign_data;
    // memory: value of the halfword at `place` in memory; newest: value that was written last
    reg [WIDTH-1:0] memory, newest;
    localparam HALF = WIDTH / 2, DEPTH = 1 << LOG2;
    reg past = 1'b0;
    wire [1:0] place_lane = place[1:0];
    // Model of the write FIFO of the port. For each word it stores the halfword under observation
    // and the byte enables of this halfword.
    reg [WIDTH+1:0] fifo [0:DEPTH-1];
    reg [WIDTH+1:0] open_half; // the halfword under observation in the word that the FIFO collects
    reg             begun = 1'b0; // the FIFO has stored bytes of this word
    wire [1:0]      store_half_be = store_be_o[2*place_lane +: 2];
    wire [WIDTH-1:0] store_half = store_data_o[WIDTH*place_lane +: WIDTH];
    always @(posedge clk_i) begin
        if (push_o)
            fifo[tail] <= open_half;
        open_half[WIDTH +: 2] <= store_half_be | (push_o || rst_i ? 2'b00 : open_half[WIDTH +: 2]);
        if (store_half_be[0])
            open_half[HALF-1:0] <= store_half[HALF-1:0];
        if (store_half_be[1])
            open_half[WIDTH-1:HALF] <= store_half[WIDTH-1:HALF];
        begun <= !rst_i && (|store_be_o || (begun && !push_o));
    end

    // Part n of `value` is the value that the halfword will have in memory when the n oldest
    // waiting words have been written. The open word is the last of them.
    wire [WIDTH*(DEPTH+1)-1:0] value;
    assign value[WIDTH-1:0] = memory;
    wire [LOG2*(DEPTH+1)-1:0] places; // places of these words in `addrs`
    assign places[LOG2-1:0] = head;
    genvar q;
    generate
        for (q = 0; q < DEPTH; q = q + 1) begin : g_value
            wire [LOG2-1:0] at = places[LOG2*q +: LOG2];
            assign places[LOG2*(q+1) +: LOG2] = after(at);
            wire closed = q < count;
            wire [WORD-1:0] addr_ram = addrs[at];
            wire [WIDTH+1:0] half_ram = fifo[at];
            wire [WORD-1:0] addr = closed ? addr_ram : open_addr;
            wire [WIDTH-1:0] data;
            wire [1:0] be;
            assign {be, data} = closed ? half_ram : open_half;
            wire hits = (closed || (q == count && open)) && addr == place[ADDR_BITS-1:2];
            assign value[WIDTH*(q+1) +: HALF] = hits &&
                be[0] ? data[HALF-1:0] : value[WIDTH*q +: HALF];
            assign value[WIDTH*(q+1)+HALF +: HALF] = hits &&
                be[1] ? data[WIDTH-1:HALF] : value[WIDTH*q+HALF +: HALF];
            always @(posedge clk_i)
                assert (!past || rst_i || q != count || tail == at);
        end
    endgenerate
    wire [WIDTH-1:0] final_value = value[WIDTH*DEPTH +: WIDTH];
    wire [WIDTH-1:0] head_data;
    wire [1:0] head_be;
    assign {head_be, head_data} = fifo[head];

    reg more_was = 1'b0, more = 1'b0; // more_room_o one and two clocks ago
    always @(posedge clk_i) begin
        past <= 1'b1;
        {more, more_was} <= {more_was, more_room_o && past};
        if (past)
            assume (!rst_i && $stable(place));
        else
            assume (rst_i && !wr_i && !foreign && !word_taken_i);
        assume (!word_taken_i || word_valid_o);
        assume (!foreign || (idle_o && !wr_i));

        if (accept && wr_addr_i == place)
            newest <= {wr_be_i[1] ? wr_data_i[WIDTH-1:HALF] : newest[WIDTH-1:HALF],
                         wr_be_i[0] ? wr_data_i[HALF-1:0] : newest[HALF-1:0]};
        if (word_taken_i && word_addr_o == place[ADDR_BITS-1:2])
            memory <= {head_be[1] ? head_data[WIDTH-1:HALF] : memory[WIDTH-1:HALF],
                         head_be[0] ? head_data[HALF-1:0] : memory[HALF-1:0]};
        if (foreign) begin
            memory <= foreign_data;
            newest <= foreign_data;
        end
        if (rst_i)
            newest <= memory;

        if (past && !rst_i) begin
            assert (final_value == newest);
            // Two writes may arrive before the processor can react to the lack of room.
            assert (!wr_lost_o || !$past(room_o));
            // After room for three halfwords, three writes may arrive.
            assert (!(wr_lost_o && more));
            // Only a write uses room. If there was room for three halfwords, there is room for two
            // after a write.
            assert (room_o || !$past(room_o && !wr_i));
            assert (more_room_o || !$past(more_room_o && !wr_i));
            assert (room_o || !(more_room_o || $past(more_room_o)));
            assert (none == (count == 0));
            // The last byte of a word closes the word at once; the word does not wait for a write
            // to another word, or for a flush.
            assert (push_o || !($past(store_be_o[7]) && count != DEPTH - 1));
            // The FIFO collects exactly the open word, which has at least one byte. Only the open
            // word is pushed.
            assert (begun == open);
            assert (!push_o || begun);
            assert (!ended || open);
            assert (open || open_half[WIDTH +: 2] == 2'b00);
            // The word that has waited longest is stable until it is taken.
            if ($past(word_valid_o && !word_taken_i && !rst_i))
                assert (word_valid_o && $stable(word_addr_o));
        end
        cover (past && wr_lost_o);
        cover (past && !$past(idle_o) && idle_o && memory != $past(memory));
    end
`endif
`ifdef COVER_POINTS
    last_byte_closes: cover property (@(posedge clk_i) close && ended);
    part_of_word: cover property (@(posedge clk_i) close && !ended);
    write_elsewhere_closes: cover property (@(posedge clk_i) close && accept && !joins);
    joins_the_last_that_fits: cover property (@(posedge clk_i) wr_i && full && joins && open);
    no_room: cover property (@(posedge clk_i) wr_lost_o);
`endif
endmodule
