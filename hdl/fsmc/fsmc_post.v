// SPDX-License-Identifier: MIT
//
// fsmc_post: merges halfword writes into words of four halfwords, pushes complete words into the
// write FIFO of the memory port, and queues their addresses.
//
// A halfword that belongs to the open word is merged into this word. A word is closed when it is
// complete, when a write to another word arrives, or if flush_i is high. Its data then moves into
// the write FIFO of the port, while its address waits in this module for the request. Therefore
// only the open word occupies flip-flops; the closed words are in the RAM of the FIFO.

`default_nettype none

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
    // high for one cycle: the word is closed and its data moves to the FIFO
    output wire                 push_o,
    output reg  [4*WIDTH-1:0]   push_data_o,
    output wire [7:0]           push_be_o,
    // closed word that has waited longest
    output wire                 word_valid_o,
    output wire [ADDR_BITS-3:0] word_addr_o,
    input  wire                 word_taken_i
);
    localparam WORD = ADDR_BITS - 2;

    reg [WORD-1:0] addrs [0:(1<<LOG2)-1];
    // The `count` entries that start at `head` are the addresses of the closed words. The initial
    // value prevents Yosys from duplicating the register head (as in npi_queue).
    reg [LOG2-1:0] head = 0, count;
    reg            open, none; // none: count == 0
    reg [WORD-1:0] open_addr;
    reg [7:0]      open_be;

    wire       joins = open_addr == wr_addr_i[ADDR_BITS-1:2];
    wire [LOG2-1:0] tail = head + count;
    wire full   = &count; // no other word can be closed, so the open word stays open
    wire close  = open && !full && (&open_be || flush_i || (wr_i && !joins));
    wire accept = wr_i && !(full && open && !joins);

    assign wr_lost_o    = wr_i && !accept;
    // The open word is counted as a closed word, so that only a write reduces the room.
    assign room_o       = !(&count[LOG2-1:1] || (open && count == (1 << LOG2) - 3));
    localparam [LOG2-1:0] LOW = 3;
    assign more_room_o  = !(&(count | LOW) && (count[0] || count[1] || open));
    assign word_valid_o = !none;
    assign idle_o       = !open && !word_valid_o;
    assign word_addr_o  = addrs[head];
    assign push_o       = close;
    assign push_be_o    = open_be;

    wire [3:0] bank = 4'd1 << wr_addr_i[1:0];
    wire [7:0] take = {{2{bank[3]}}, {2{bank[2]}}, {2{bank[1]}}, {2{bank[0]}}} & {4{wr_be_i}} &
        {8{accept}};
    genvar b;
    generate
        for (b = 0; b < 8; b = b + 1) begin : g_byte
            always @(posedge clk_i)
                if (take[b])
                    push_data_o[WIDTH/2*b +: WIDTH/2] <= wr_data_i[WIDTH/2*(b%2) +: WIDTH/2];
        end
    endgenerate

    always @(posedge clk_i) begin
        if (close)
            addrs[tail] <= open_addr;
        if (close != word_taken_i)
            // the adder does not depend on `close`, which arrives late
            count <= word_taken_i ? count - 1'b1 : count + 1'b1;
        if (close || word_taken_i)
            none <= !close && count == 1;
        if (close || accept)
            open <= accept;
        open_be <= take | (open && !close ? open_be : 8'd0);
        if (accept)
            open_addr <= wr_addr_i[ADDR_BITS-1:2];
        if (word_taken_i)
            head <= head + 1'b1;
        if (rst_i) begin
            head <= 0;
            count <= 0;
            none <= 1'b1;
            open <= 1'b0;
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
    wire [WIDTH+1:0] open_half =
        {push_be_o[2*place_lane +: 2], push_data_o[WIDTH*place_lane +: WIDTH]};
    always @(posedge clk_i)
        if (push_o)
            fifo[tail] <= open_half;

    // Part n of `after` is the value that the halfword will have in memory when the n oldest
    // waiting words have been written. The open word is the last of them.
    wire [WIDTH*(DEPTH+1)-1:0] after;
    assign after[WIDTH-1:0] = memory;
    genvar q;
    generate
        for (q = 0; q < DEPTH; q = q + 1) begin : g_after
            wire [LOG2-1:0] at = head + q;
            wire closed = q < count;
            wire [WORD-1:0] addr_ram = addrs[at];
            wire [WIDTH+1:0] half_ram = fifo[at];
            wire [WORD-1:0] addr = closed ? addr_ram : open_addr;
            wire [WIDTH-1:0] data;
            wire [1:0] be;
            assign {be, data} = closed ? half_ram : open_half;
            wire hits = (closed || (q == count && open)) && addr == place[ADDR_BITS-1:2];
            assign after[WIDTH*(q+1) +: HALF] = hits &&
                be[0] ? data[HALF-1:0] : after[WIDTH*q +: HALF];
            assign after[WIDTH*(q+1)+HALF +: HALF] = hits &&
                be[1] ? data[WIDTH-1:HALF] : after[WIDTH*q+HALF +: HALF];
        end
    endgenerate
    wire [WIDTH-1:0] final_value = after[WIDTH*DEPTH +: WIDTH];
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
            // A complete word is closed at once; it does not wait for a write to another word,
            // or for a flush.
            assert (push_o || !(open && push_be_o == 8'hFF && count != DEPTH - 1));
            // The word that has waited longest is stable until it is taken.
            if ($past(word_valid_o && !word_taken_i && !rst_i))
                assert (word_valid_o && $stable(word_addr_o));
        end
        cover (past && wr_lost_o);
        cover (past && !$past(idle_o) && idle_o && memory != $past(memory));
    end
`endif
`ifdef COVER_POINTS
    whole_word: cover property (@(posedge clk_i) close && &open_be);
    part_of_word: cover property (@(posedge clk_i) close && !(&open_be));
    write_elsewhere_closes: cover property (@(posedge clk_i) close && accept && !joins);
    joins_the_last_that_fits: cover property (@(posedge clk_i) wr_i && full && joins && open);
    no_room: cover property (@(posedge clk_i) wr_lost_o);
`endif
endmodule
