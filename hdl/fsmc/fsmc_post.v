// SPDX-License-Identifier: MIT
//
// fsmc_post: merges halfword writes into words of four, pushes closed words to the memory port and queues their addresses.
//
// A halfword joins the open word if it belongs to it. The word is closed when all its bytes are
// there, when a write elsewhere comes, and with flush_i. Its data then goes into the port's write
// FIFO at once, while its address waits here for its request. So one word is in flip-flops, the
// others in the FIFO's RAM.

`default_nettype none

module fsmc_post #(
    parameter ADDR_BITS = 25, // bits of a halfword address
    parameter WIDTH     = 16, // bits of a halfword
    parameter LOG2      = 4   // 2**LOG2 - 1 closed words can wait; the port's FIFO has room for them
) (
    input  wire                 clk_i,
    input  wire                 rst_i,
    // writes: one cycle each
    input  wire                 wr_i,
    input  wire [ADDR_BITS-1:0] wr_addr_i, // halfword address
    input  wire [WIDTH-1:0]     wr_data_i,
    input  wire [1:0]           wr_be_i,
    output wire                 wr_lost_o, // in the cycle of wr_i: there was no room
    output wire                 room_o,    // there is room for two halfwords at least
    output wire                 more_room_o, // there is room for three
    input  wire                 flush_i,
    output wire                 idle_o,    // nothing is open and nothing waits
    // word that is being closed
    output wire                 push_o,    // one cycle
    output reg  [4*WIDTH-1:0]   push_data_o,
    output wire [7:0]           push_be_o,
    // the oldest closed word
    output wire                 word_valid_o,
    output wire [ADDR_BITS-3:0] word_addr_o,
    input  wire                 word_taken_i
);
    localparam WORD = ADDR_BITS - 2;

    reg [WORD-1:0] addrs [0:(1<<LOG2)-1];
    // `count` words from `head` on are closed. The initial value keeps Yosys from keeping head twice (npi_queue).
    reg [LOG2-1:0] head = 0, count;
    reg            open;
    reg [WORD-1:0] open_addr;
    reg [7:0]      open_be;

    wire       joins = open_addr == wr_addr_i[ADDR_BITS-1:2];
    wire [LOG2-1:0] tail = head + count;
    wire full   = &count; // no closed word more fits, so the open one stays open
    wire close  = open && !full && (&open_be || flush_i || (wr_i && !joins));
    wire accept = wr_i && !(full && open && !joins);

    assign wr_lost_o    = wr_i && !accept;
    // The open word counts as closed, so that room never shrinks without a write.
    assign room_o       = !(&count[LOG2-1:1] || (open && count == (1 << LOG2) - 3));
    localparam [LOG2-1:0] LOW = 3;
    assign more_room_o  = !(&(count | LOW) && (count[0] || count[1] || open));
    assign word_valid_o = |count;
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
        if (close)
            addrs[tail] <= open_addr;
        if (close != word_taken_i)
            count <= close ? count + 1'b1 : count - 1'b1;
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
            open <= 1'b0;
        end
    end

`ifdef FORMAL
`include "fsmc_post_proof.vh"
`endif
`ifdef COVER_POINTS
    whole_word: cover property (@(posedge clk_i) close && &open_be);
    part_of_word: cover property (@(posedge clk_i) close && !(&open_be));
    write_elsewhere_closes: cover property (@(posedge clk_i) close && accept && !joins);
    joins_the_last_that_fits: cover property (@(posedge clk_i) wr_i && full && joins && open);
    no_room: cover property (@(posedge clk_i) wr_lost_o);
`endif
endmodule
