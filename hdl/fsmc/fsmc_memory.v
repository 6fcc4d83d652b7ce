// SPDX-License-Identifier: MIT
//
// fsmc_memory: halfword writes posted and merged into 64-bit words, halfword reads from a buffer that reads ahead.
//
// Writes: a halfword joins the open word as long as it belongs to it. A word is closed, and goes to
// memory, when all its bytes are there, when a write elsewhere comes, and when flush_i asks for it.
// (Half a halfword never joins one that has the other half: the buffer has no byte write enables.)
// Reads: two buffers of one block each, blocks with an even and an odd number. A first miss fetches
// one word; a second miss in the same block fetches the block; from then on the next block is fetched
// as soon as a block is entered.
// Order: no word is fetched while a write waits; a write, or drop_i, drops all that was read, also what
// is still on its way. So a read never gives what is older than a write before it.

`default_nettype none

module fsmc_memory #(
    parameter POST_LOG2  = 4,  // 2**POST_LOG2 - 1 closed words can wait
    parameter BLOCK_LOG2 = 3   // 2**BLOCK_LOG2 words of 64 bits in a block, 1..4
) (
    input  wire                 clk_i,
    input  wire                 rst_i,
    input  wire [5:0]           page_i,    // address bits above the window; changes only when idle_o
    // writes: one cycle each, with room_o or they are lost
    input  wire                 wr_i,
    input  wire [24:0] wr_addr_i, // halfword
    input  wire [15:0]          wr_data_i,
    input  wire [1:0]           wr_be_i,
    output wire                 wr_lost_o, // in the cycle of wr_i
    output wire                 room_o,    // for two halfwords at least
    // reads: combinational; rd_miss_i asks for what is not there
    input  wire [24:0] rd_addr_i, // halfword
    input  wire                 rd_used_i, // the halfword is being read
    input  wire                 rd_miss_i, // somebody waits for it
    output wire                 rd_hit_o,
    output wire                 rd_safe_o, // a hit, and not in a block that is being filled
    output wire [15:0]          rd_data_o,
    // order
    input  wire                 flush_i,   // close the open word
    input  wire                 drop_i,    // forget what was read
    output wire                 idle_o,    // all writes have been acknowledged
    // memory port
    output wire [31:0]          npi_addr_o,
    output reg                  npi_addr_req_o,
    input  wire                 npi_addr_ack_i,
    output reg                  npi_rnw_o,
    output wire [3:0]           npi_size_o,
    output wire [63:0]          npi_wr_data_o,
    output wire [7:0]           npi_wr_be_o,
    output wire                 npi_wr_push_o,
    input  wire [63:0]          npi_rd_data_i,
    output wire                 npi_rd_pop_o,
    input  wire                 npi_rd_empty_i,
    input  wire                 npi_init_done_i
);
    localparam WORD = 23;                    // bits of a word address
    localparam TAG  = WORD - BLOCK_LOG2 - 1; // of an even-odd pair of blocks
    localparam BLOCK = 1 << BLOCK_LOG2;
    localparam DEPTH = 1 << POST_LOG2;

    // ---- Posted writes: data in four banks of a halfword, byte enables and address beside them.
    reg [WORD+7:0]    post_tags [0:DEPTH-1];
    reg [POST_LOG2-1:0] head, tail; // head..tail-1 are closed, tail is open or free
    reg               open;
    reg [WORD-1:0]    open_addr;
    reg [7:0]         open_be;

    wire [1:0] wr_lane = wr_addr_i[1:0];
    wire [7:0] wr_be;
    wire [3:0] wr_bank;
    genvar b;
    generate
        for (b = 0; b < 4; b = b + 1) begin : g_lane
            assign wr_bank[b] = wr_lane == b;
            assign wr_be[2*b +: 2] = wr_bank[b] ? wr_be_i : 2'b00;
        end
    endgenerate
    wire [7:0] wr_both = {{2{wr_bank[3]}}, {2{wr_bank[2]}}, {2{wr_bank[1]}}, {2{wr_bank[0]}}};

    wire joins  = open_addr == wr_addr_i[24:2] && (&wr_be_i || (open_be & wr_both) == 8'd0);
    wire close  = open && (&open_be || flush_i || rd_miss_i || (wr_i && !joins));
    wire [POST_LOG2-1:0] tail_next = tail + 1'b1;
    wire [POST_LOG2-1:0] count = tail - head;
    wire full   = &count;                  // the open word has no successor
    wire accept = wr_i && !(close && full) && !(full && !open);
    wire [POST_LOG2-1:0] wr_slot = close ? tail_next : tail;

    assign wr_lost_o = wr_i && !accept;
    assign room_o    = count < DEPTH - 4;
    assign idle_o    = !open && head == tail;

    generate
        for (b = 0; b < 4; b = b + 1) begin : g_post
            reg [15:0] bank [0:DEPTH-1];
            always @(posedge clk_i)
                if (accept && wr_bank[b])
                    bank[wr_slot] <= wr_data_i;
            assign npi_wr_data_o[16*b +: 16] = bank[head];
        end
    endgenerate

    // ---- What was read.
    reg [TAG-1:0]        tag0, tag1;      // of the even and the odd block
    reg [BLOCK-1:0]      valid0, valid1;
    reg                  current;         // the block being read: 0 even, 1 odd
    reg                  streaming;       // it was fetched as a block
    reg                  ahead;           // the other one is its successor, or will be
    // A fetch: wanted, then under way until its last word has come.
    reg                  fetch_wanted, fetch_busy, fetch_stale, fetch_block, fetch_single;
    reg [BLOCK_LOG2-1:0] fetch_word;

    wire [BLOCK_LOG2-1:0] rd_word  = rd_addr_i[BLOCK_LOG2+1:2];
    wire                  rd_block = rd_addr_i[BLOCK_LOG2+2];
    wire [TAG-1:0]        rd_tag   = rd_addr_i[24:BLOCK_LOG2+3];
    wire same_tag = rd_block ? tag1 == rd_tag : tag0 == rd_tag;
    wire [BLOCK-1:0] rd_valid = rd_block ? valid1 : valid0;
    wire same_block = same_tag && |rd_valid;
    wire fetching   = fetch_wanted || fetch_busy;

    assign rd_hit_o  = same_tag && rd_valid[rd_word] && idle_o;
    assign rd_safe_o = rd_hit_o && !(fetching && fetch_block == rd_block);

    wire fill = !npi_rd_empty_i && !fetch_stale;
    assign npi_rd_pop_o = !npi_rd_empty_i;
    wire [15:0] lane [0:3];
    generate
        for (b = 0; b < 4; b = b + 1) begin : g_line
            reg [15:0] bank [0:2*BLOCK-1];
            always @(posedge clk_i)
                if (fill)
                    bank[{fetch_block, fetch_word}] <= npi_rd_data_i[16*b +: 16];
            assign lane[b] = bank[{rd_block, rd_word}];
        end
    endgenerate
    assign rd_data_o = lane[rd_addr_i[1:0]];

    wire fetch_last = fetch_single || &fetch_word;
    wire miss = rd_miss_i && !rd_hit_o && idle_o && !fetching;
    wire enter = rd_used_i && rd_hit_o && ahead && rd_block != current;
    // The block after the current one; its number carries from the odd block into the tag.
    wire next_wanted = rd_used_i && rd_hit_o && rd_block == current && streaming && !ahead && !fetching;
    wire [TAG-1:0] current_tag = current ? tag1 : tag0;
    wire [TAG-1:0] next_tag = current_tag + {{(TAG-1){1'b0}}, current};
    wire forget = drop_i || wr_i;

    // ---- The port: a closed word first.
    wire port_free  = !npi_addr_req_o && npi_init_done_i;
    wire start_post = port_free && head != tail;
    wire start_read = port_free && head == tail && fetch_wanted;
    wire [WORD+7:0] post_tag = post_tags[head];
    wire [WORD-1:0] fetch_addr = {fetch_block ? tag1 : tag0, fetch_block, fetch_word};

    assign npi_addr_o    = {page_i, npi_rnw_o ? fetch_addr : post_tag[WORD-1:0], 3'd0};
    assign npi_size_o    = npi_rnw_o && !fetch_single ? BLOCK_LOG2[3:0] : 4'd0;
    assign npi_wr_be_o   = post_tag[WORD+7:WORD];
    assign npi_wr_push_o = start_post;

    integer i;
    always @(posedge clk_i) begin
        if (close) begin
            post_tags[tail] <= {open_be, open_addr};
            tail <= tail_next;
            open <= 1'b0;
        end
        if (accept) begin
            open      <= 1'b1;
            open_addr <= wr_addr_i[24:2];
            open_be   <= (close || !open ? 8'd0 : open_be) | wr_be;
        end

        if (start_post || start_read) begin
            npi_addr_req_o <= 1'b1;
            npi_rnw_o      <= !start_post;
        end
        if (start_read)
            {fetch_wanted, fetch_busy} <= 2'b01;
        if (npi_addr_ack_i) begin
            npi_addr_req_o <= 1'b0;
            if (!npi_rnw_o)
                head <= head + 1'b1;
        end

        if (npi_rd_pop_o) begin
            fetch_word <= fetch_word + 1'b1;
            if (fetch_last)
                {fetch_busy, fetch_stale} <= 2'b00;
        end
        for (i = 0; i < BLOCK; i = i + 1)
            if (fill && fetch_word == i[BLOCK_LOG2-1:0]) begin
                if (fetch_block)
                    valid1[i] <= 1'b1;
                else
                    valid0[i] <= 1'b1;
            end

        if (enter) begin
            current <= rd_block;
            ahead   <= 1'b0;
        end
        if (miss) begin
            // The other block is worth keeping: it may be what is read alternately.
            fetch_wanted <= 1'b1;
            fetch_block  <= rd_block;
            fetch_single <= !same_block;
            fetch_word   <= same_block ? {BLOCK_LOG2{1'b0}} : rd_word;
            current      <= rd_block;
            streaming    <= same_block;
            ahead        <= 1'b0;
        end else if (next_wanted) begin
            fetch_wanted <= 1'b1;
            fetch_block  <= !current;
            fetch_single <= 1'b0;
            fetch_word   <= {BLOCK_LOG2{1'b0}};
            ahead        <= 1'b1;
        end
        if (miss ? rd_block : next_wanted && !current) begin
            tag1   <= miss ? rd_tag : next_tag;
            valid1 <= {BLOCK{1'b0}};
        end
        if (miss ? !rd_block : next_wanted && current) begin
            tag0   <= miss ? rd_tag : next_tag;
            valid0 <= {BLOCK{1'b0}};
        end

        if (forget || rst_i) begin
            valid0 <= {BLOCK{1'b0}};
            valid1 <= {BLOCK{1'b0}};
            ahead  <= 1'b0;
            streaming    <= 1'b0;
            fetch_wanted <= 1'b0;
            // The words of a request that was made still come.
            if (start_read || (fetch_busy && !(npi_rd_pop_o && fetch_last)))
                fetch_stale <= 1'b1;
        end
        if (rst_i) begin
            head <= 0;
            tail <= 0;
            open <= 1'b0;
            fetch_busy  <= 1'b0;
            fetch_stale <= 1'b0;
            npi_addr_req_o <= 1'b0;
            npi_rnw_o      <= 1'b0;
            current <= 1'b0;
        end
    end
endmodule
