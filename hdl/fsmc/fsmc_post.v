// SPDX-License-Identifier: MIT
//
// fsmc_post: halfword writes merged into words of four; closed words go to the memory port, addresses queue.
//
// A halfword joins the open word if it belongs to it. The word is closed when all its bytes are there,
// when a write elsewhere comes, and with flush_i: its data goes into the port's write FIFO at once, its
// address waits here for its request. So one word is in flip-flops, and the others in the FIFO's RAM.

`default_nettype none

module fsmc_post #(
    parameter ADDR_BITS = 25, // of a halfword address
    parameter WIDTH     = 16, // of a halfword
    parameter LOG2      = 4   // 2**LOG2 - 1 closed words can wait; the port's FIFO has room for them
) (
    input  wire                 clk_i,
    input  wire                 rst_i,
    // writes: one cycle each
    input  wire                 wr_i,
    input  wire [ADDR_BITS-1:0] wr_addr_i, // halfword
    input  wire [WIDTH-1:0]     wr_data_i,
    input  wire [1:0]           wr_be_i,
    output wire                 wr_lost_o, // in the cycle of wr_i: there was no room
    output wire                 room_o,    // for two halfwords at least
    input  wire                 flush_i,
    output wire                 idle_o,    // nothing is open and nothing waits
    // a word is closed
    output wire                 push_o,    // one cycle
    output reg  [4*WIDTH-1:0]   push_data_o,
    output wire [7:0]           push_be_o,
    // the oldest closed word
    output wire                 word_valid_o,
    output wire [ADDR_BITS-3:0] word_addr_o,
`ifdef FORMAL
    // the halfword that the proof looks at, any; what others write there while nothing waits
    input  wire [ADDR_BITS-1:0] place_i,
    input  wire                 foreign_i,
    input  wire [WIDTH-1:0]     foreign_data_i,
    output reg  [WIDTH-1:0]     memory_o, // what the memory has there
    output reg  [WIDTH-1:0]     newest_o, // what was written there last
    output wire [LOG2-1:0]      waiting_o, // closed words
`endif
    input  wire                 word_taken_i
);
    localparam WORD = ADDR_BITS - 2;

    reg [WORD-1:0] addrs [0:(1<<LOG2)-1];
    // head..tail-1 are closed. Initial values: as in npi_queue.
    reg [LOG2-1:0] head = 0, tail = 0;
    reg            open;
    reg [WORD-1:0] open_addr;
    reg [7:0]      open_be;

    wire       joins = open_addr == wr_addr_i[ADDR_BITS-1:2];
    wire [LOG2-1:0] count = tail - head;
    wire full   = &count; // the open word has no successor: it stays open
    wire close  = open && !full && (&open_be || flush_i || (wr_i && !joins));
    wire accept = wr_i && !(full && open && !joins);

    assign wr_lost_o    = wr_i && !accept;
    // The open word counts as closed, so that room does not go away by itself.
    assign room_o       = !(&count[LOG2-1:1] || (open && count == (1 << LOG2) - 3));
    assign word_valid_o = head != tail; // sooner there than count
    assign idle_o       = !open && !word_valid_o;
    assign word_addr_o  = addrs[head];
    assign push_o       = close;
    assign push_be_o    = open_be;

    wire [3:0] bank = 4'd1 << wr_addr_i[1:0];
    wire [7:0] take = {{2{bank[3]}}, {2{bank[2]}}, {2{bank[1]}}, {2{bank[0]}}} & {4{wr_be_i}} & {8{accept}};
    genvar b;
    generate
        for (b = 0; b < 8; b = b + 1) begin : g_byte
            always @(posedge clk_i)
                if (take[b])
                    push_data_o[WIDTH/2*b +: WIDTH/2] <= wr_data_i[WIDTH/2*(b%2) +: WIDTH/2];
        end
    endgenerate

    always @(posedge clk_i) begin
        if (close) begin
            addrs[tail] <= open_addr;
            tail <= tail + 1'b1;
        end
        if (close || accept)
            open <= accept;
        open_be <= take | (open && !close ? open_be : 8'd0);
        if (accept)
            open_addr <= wr_addr_i[ADDR_BITS-1:2];
        if (word_taken_i)
            head <= head + 1'b1;
        if (rst_i) begin
            head <= 0;
            tail <= 0;
            open <= 1'b0;
        end
    end

`ifdef FORMAL
    assign waiting_o = count;
    localparam HALF = WIDTH / 2, DEPTH = 1 << LOG2;
    reg past = 1'b0;
    wire [1:0] place_lane = place_i[1:0];
    // The port's write FIFO: of every word the halfword that is looked at, and its byte enables.
    reg [WIDTH+1:0] fifo [0:DEPTH-1];
    wire [WIDTH+1:0] open_half = {push_be_o[2*place_lane +: 2], push_data_o[WIDTH*place_lane +: WIDTH]};
    always @(posedge clk_i)
        if (push_o)
            fifo[tail] <= open_half;

    // What the memory will have when all that waits has been written, oldest first: the open word is
    // the last of `after`.
    wire [WIDTH*(DEPTH+1)-1:0] after;
    assign after[WIDTH-1:0] = memory_o;
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
            wire hits = (closed || (q == count && open)) && addr == place_i[ADDR_BITS-1:2];
            assign after[WIDTH*(q+1) +: HALF] = hits && be[0] ? data[HALF-1:0] : after[WIDTH*q +: HALF];
            assign after[WIDTH*(q+1)+HALF +: HALF] = hits && be[1] ? data[WIDTH-1:HALF] : after[WIDTH*q+HALF +: HALF];
        end
    endgenerate
    wire [WIDTH-1:0] final_value = after[WIDTH*DEPTH +: WIDTH];
    wire [WIDTH-1:0] head_data;
    wire [1:0] head_be;
    assign {head_be, head_data} = fifo[head];

    always @(posedge clk_i) begin
        past <= 1'b1;
        if (past)
            assume (!rst_i && $stable(place_i));
        else
            assume (rst_i && !wr_i && !foreign_i && !word_taken_i);
        assume (!word_taken_i || word_valid_o);
        assume (!foreign_i || (idle_o && !wr_i));

        if (accept && wr_addr_i == place_i)
            newest_o <= {wr_be_i[1] ? wr_data_i[WIDTH-1:HALF] : newest_o[WIDTH-1:HALF],
                         wr_be_i[0] ? wr_data_i[HALF-1:0] : newest_o[HALF-1:0]};
        if (word_taken_i && word_addr_o == place_i[ADDR_BITS-1:2])
            memory_o <= {head_be[1] ? head_data[WIDTH-1:HALF] : memory_o[WIDTH-1:HALF],
                         head_be[0] ? head_data[HALF-1:0] : memory_o[HALF-1:0]};
        if (foreign_i) begin
            memory_o <= foreign_data_i;
            newest_o <= foreign_data_i;
        end
        if (rst_i)
            newest_o <= memory_o;

        if (past && !rst_i) begin
            assert (final_value == newest_o);
            // Two writes may come before anybody has seen that there is room no more.
            assert (!wr_lost_o || !$past(room_o));
            // The oldest word stays as it is until it is taken.
            if ($past(word_valid_o && !word_taken_i && !rst_i))
                assert (word_valid_o && $stable(word_addr_o));
        end
        cover (past && wr_lost_o);
        cover (past && !$past(idle_o) && idle_o && memory_o != $past(memory_o));
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
