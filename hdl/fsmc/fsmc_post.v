// SPDX-License-Identifier: MIT
//
// fsmc_post: halfword writes merged into words of four, and a queue of words on their way to memory.
//
// A halfword joins the open word if it belongs to it. The word is closed, and can be taken, when all its
// bytes are there, when a write elsewhere comes, and with flush_i. (Half a halfword does not join a word
// that has the other half: the queue is RAM without byte write enables.)

`default_nettype none

module fsmc_post #(
    parameter ADDR_BITS = 25, // of a halfword address
    parameter WIDTH     = 16, // of a halfword
    parameter LOG2      = 4   // 2**LOG2 - 1 closed words can wait
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
    // the oldest closed word
    output wire                 word_valid_o,
    output wire [ADDR_BITS-3:0] word_addr_o,
    output wire [4*WIDTH-1:0]   word_data_o,
    output wire [7:0]           word_be_o,
`ifdef FORMAL
    // the halfword that the proof looks at, any; what others write there while nothing waits
    input  wire [ADDR_BITS-1:0] place_i,
    input  wire                 foreign_i,
    input  wire [WIDTH-1:0]     foreign_data_i,
    output reg  [WIDTH-1:0]     memory_o, // what the memory has there
    output reg  [WIDTH-1:0]     newest_o, // what was written there last
`endif
    input  wire                 word_taken_i
);
    localparam WORD = ADDR_BITS - 2;

    reg [WORD+7:0] tags [0:(1<<LOG2)-1];
    reg [LOG2-1:0] head, tail; // head..tail-1 are closed, tail is open or free
    reg            open;
    reg [WORD-1:0] open_addr;
    reg [7:0]      open_be;

    wire [3:0] bank = 4'd1 << wr_addr_i[1:0];
    wire [7:0] both = {{2{bank[3]}}, {2{bank[2]}}, {2{bank[1]}}, {2{bank[0]}}};
    wire       free = (open_be & both) == 8'd0;

    wire joins = open_addr == wr_addr_i[ADDR_BITS-1:2] && (&wr_be_i || free);
    wire [LOG2-1:0] tail_next = tail + 1'b1;
    wire [LOG2-1:0] count     = tail - head;
    wire full   = &count; // the open word has no successor: it stays open
    wire close  = open && !full && (&open_be || flush_i || (wr_i && !joins));
    wire accept = wr_i && !(full && open && !joins);
    wire [LOG2-1:0] place = close ? tail_next : tail;

    assign wr_lost_o    = wr_i && !accept;
    // The open word counts as closed, so that room does not go away by itself.
    assign room_o       = !(&count[LOG2-1:1] || (open && count == (1 << LOG2) - 3));
    assign word_valid_o = count != 0;
    assign idle_o       = !open && !word_valid_o;
    assign {word_be_o, word_addr_o} = tags[head];

`ifdef FORMAL
    localparam BANK = WIDTH << LOG2; // bits of a bank
    wire [4*BANK-1:0] all;
`endif
    genvar b;
    generate
        for (b = 0; b < 4; b = b + 1) begin : g_bank
            reg [WIDTH-1:0] words [0:(1<<LOG2)-1];
            always @(posedge clk_i)
                if (accept && bank[b])
                    words[place] <= wr_data_i;
            assign word_data_o[WIDTH*b +: WIDTH] = words[head];
`ifdef FORMAL
            genvar k;
            for (k = 0; k < (1 << LOG2); k = k + 1) begin : g_word
                assign all[BANK*b + WIDTH*k +: WIDTH] = words[k];
            end
`endif
        end
    endgenerate

    always @(posedge clk_i) begin
        if (close) begin
            tags[tail] <= {open_be, open_addr};
            tail <= tail_next;
        end
        if (close || accept)
            open <= accept;
        if (accept) begin
            open_addr <= wr_addr_i[ADDR_BITS-1:2];
            open_be   <= (open && !close ? open_be : 8'd0) | (both & {4{wr_be_i}});
        end
        if (word_taken_i)
            head <= head + 1'b1;
        if (rst_i) begin
            head <= 0;
            tail <= 0;
            open <= 1'b0;
        end
    end

`ifdef FORMAL
    localparam HALF = WIDTH / 2, DEPTH = 1 << LOG2;
    reg past = 1'b0;
    wire [1:0] place_lane = place_i[1:0];
    wire [BANK-1:0] mine = place_lane[1] ? (place_lane[0] ? all[3*BANK +: BANK] : all[2*BANK +: BANK])
                                         : (place_lane[0] ? all[1*BANK +: BANK] : all[0 +: BANK]);

    // What the memory will have when all that waits has been written, oldest first: the open word is
    // the last of `after`.
    wire [WIDTH*(DEPTH+1)-1:0] after;
    wire [WIDTH*DEPTH-1:0] queued;
    assign after[WIDTH-1:0] = memory_o;
    genvar q, w;
    generate
        for (q = 0; q < DEPTH; q = q + 1) begin : g_after
            wire [LOG2-1:0] at = head + q;
            wire closed = q < count;
            wire [WORD+7:0] tag_ram = tags[at];
            wire [WORD+7:0] tag = closed ? tag_ram : {open_be, open_addr};
            wire [WIDTH*(DEPTH+1)-1:0] find;
            assign find[WIDTH-1:0] = 0;
            for (w = 0; w < DEPTH; w = w + 1) begin : g_find
                assign find[WIDTH*(w+1) +: WIDTH] = at == w ? mine[WIDTH*w +: WIDTH] : find[WIDTH*w +: WIDTH];
            end
            wire [WIDTH-1:0] data = find[WIDTH*DEPTH +: WIDTH];
            wire [1:0] be = place_lane[1] ? (place_lane[0] ? tag[WORD+6 +: 2] : tag[WORD+4 +: 2])
                                          : (place_lane[0] ? tag[WORD+2 +: 2] : tag[WORD +: 2]);
            wire hits = (closed || (q == count && open)) && tag[WORD-1:0] == place_i[ADDR_BITS-1:2];
            assign queued[WIDTH*q +: WIDTH] = data;
            assign after[WIDTH*(q+1) +: HALF] = hits && be[0] ? data[HALF-1:0] : after[WIDTH*q +: HALF];
            assign after[WIDTH*(q+1)+HALF +: HALF] = hits && be[1] ? data[WIDTH-1:HALF] : after[WIDTH*q+HALF +: HALF];
        end
    endgenerate
    wire [WIDTH-1:0] final_value = after[WIDTH*DEPTH +: WIDTH];
    wire [WIDTH-1:0] head_data = queued[WIDTH-1:0];
    wire [1:0] head_be = place_lane[1] ? (place_lane[0] ? word_be_o[7:6] : word_be_o[5:4])
                                       : (place_lane[0] ? word_be_o[3:2] : word_be_o[1:0]);

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
                assert (word_valid_o && $stable(word_addr_o) && $stable(word_be_o) && $stable(word_data_o));
        end
        cover (past && wr_lost_o);
        cover (past && !$past(idle_o) && idle_o && memory_o != $past(memory_o));
    end
`endif
endmodule
