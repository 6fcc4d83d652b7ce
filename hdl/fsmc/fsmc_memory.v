// SPDX-License-Identifier: MIT
//
// fsmc_memory: memory part of the FSMC bridge: posts halfword writes, merged into words of four
// halfwords, and answers halfword reads from a read-ahead buffer.
//
// fsmc_post handles the writes. Reads are answered from two buffers, one for blocks with even
// numbers and one for blocks with odd numbers. The first miss in a block fetches one word; a second
// miss in the same block fetches the whole block. After that, when the processor enters a block,
// the next block is read ahead. Read-ahead stops at multiples of 4 KiB, because both buffers share
// the upper address bits. Nothing is fetched while a write waits. A write, or drop_i, discards all
// data in the buffers and all words that have not arrived yet. Therefore a read never returns data
// that is older than a previous write.
//
// NWAIT depends on the AND of rd_same_o and rd_found_o, which does not glitch while the address is
// stable. A single flip-flop (a bit of full, or have_one) makes the data of a buffer valid. A fetch
// clears this flip-flop one clock before it loads the address (the tag) of the new data.

`default_nettype none
`include "count_up.vh"

module fsmc_memory #(
    parameter ADDR_BITS   = 25, // width of a halfword address
    parameter WIDTH       = 16, // width of a halfword; 16, but smaller in proofs
    // number of closed words (fsmc_post) that can wait: 2**POST_LOG2 - 1
    parameter POST_LOG2   = 4,
    parameter BLOCK_LOG2  = 3,  // number of words in a block: 2**BLOCK_LOG2, BLOCK_LOG2 1..4
    parameter REGION_LOG2 = 9   // read-ahead stops at multiples of 2**REGION_LOG2 words
) (
    input  wire                 clk_i,
    input  wire                 rst_i,
    // page: address bits above the window; may change only while idle_o is high
    input  wire [5:0]           page_i,
    // writes: one per cycle of wr_i; a write that does not fit is lost
    input  wire                 wr_i,
    input  wire [ADDR_BITS-1:0] wr_addr_i, // halfword address
    input  wire [WIDTH-1:0]     wr_data_i,
    input  wire [1:0]           wr_be_i,
    output wire                 wr_lost_o, // high in the cycle of a write that is lost
    output wire                 room_o,    // room for at least two halfwords
    output wire                 more_room_o, // room for at least three halfwords
    // reads: rd_data_o depends on the pins combinationally. rd_miss_i requests missing data at
    // rd_at_i, which is the address copied to clk_i.
    input  wire [ADDR_BITS-1:0] rd_addr_async_i, // halfword address
    input  wire [ADDR_BITS-1:0] rd_at_i,
    input  wire                 rd_used_i, // a read of this halfword is in progress
    input  wire                 rd_miss_i, // a read waits for data that is not in a buffer
    output wire                 rd_same_o,  // rd_same_o && rd_found_o: the halfword is in a buffer
    output wire                 rd_found_o,
    // the halfword is in a block that was already valid one clock ago
    output wire                 rd_safe_o,
    output wire [WIDTH-1:0]     rd_data_o,
    // ordering
    // closes the open word, so that all posted data is written
    input  wire                 flush_i,
    input  wire                 drop_i,    // discards the data in the read buffers
    output wire                 idle_o,    // the memory has acknowledged all writes
    // memory port
    output wire [ADDR_BITS+6:0] npi_addr_o,
    output reg                  npi_addr_req_o,
    input  wire                 npi_addr_ack_i,
    output reg                  npi_rnw_o,
    output wire [3:0]           npi_size_o,
    output wire [4*WIDTH-1:0]   npi_wr_data_o, // parts of words (MERGE in npi_arbiter)
    output wire [7:0]           npi_wr_be_o,
    output wire                 npi_wr_push_o,
    input  wire [4*WIDTH-1:0]   npi_rd_data_i,
    output wire                 npi_rd_pop_o,
    input  wire                 npi_rd_empty_i,
    input  wire                 npi_init_done_i
);
    localparam WORD  = ADDR_BITS - 2;                // width of a word address
    // width of the part of a word address that selects a region of 2**REGION_LOG2 words
    localparam UPPER = WORD - REGION_LOG2;
    // width of the part that selects a pair of blocks in the region; the bits below select block
    // and word
    localparam PAIR  = REGION_LOG2 - BLOCK_LOG2 - 1;
    localparam BLOCK = 1 << BLOCK_LOG2;

    // ---- Posted writes
    wire            post_valid;
    wire [WORD-1:0] post_addr;
    fsmc_post #(.ADDR_BITS(ADDR_BITS), .WIDTH(WIDTH), .LOG2(POST_LOG2)) u_fsmc_post (
        .clk_i(clk_i), .rst_i(rst_i),
        .wr_i(wr_i), .wr_addr_i(wr_addr_i), .wr_data_i(wr_data_i), .wr_be_i(wr_be_i),
        .wr_lost_o(wr_lost_o), .room_o(room_o), .more_room_o(more_room_o),
        .flush_i(flush_i || rd_miss_i), .idle_o(idle_o),
        .store_be_o(npi_wr_be_o), .store_data_o(npi_wr_data_o), .push_o(npi_wr_push_o),
        .word_valid_o(post_valid), .word_addr_o(post_addr),
        .word_taken_i(npi_addr_ack_i && !npi_rnw_o)
    );

    // ---- Read buffer
    reg [UPPER-1:0]      upper;           // region of both blocks in the buffers
    reg [PAIR-1:0]       pair0, pair1;    // pair number of the even block and of the odd block
    // bit n of full: all words of block n have arrived; settled: the value of full one clock ago
    reg [1:0]            full, settled;
    reg                  current;         // block that the processor reads
    // the other buffer contains the next block, or will contain it
    reg                  ahead;
    // A fetch is requested (wanted), then in progress (busy). If it is stale, its words are
    // discarded. It reads one word (single) or a block. have_one: the word that caused the fetch,
    // at index one_word in its block, has arrived.
    reg                  wanted, busy, stale, single, have_one;
    reg                  loads;           // second clock of a fetch, which loads the tags
    reg                  target;          // block that this fetch reads
    // block of the words that arrive; follows target one clock later
    reg                  fetch_block;
    reg [BLOCK_LOG2-1:0] fetch_word, one_word;

    wire [BLOCK_LOG2-1:0] rd_word  = rd_addr_async_i[BLOCK_LOG2+1:2];
    wire                  rd_block = rd_addr_async_i[BLOCK_LOG2+2];
    wire [PAIR-1:0]       rd_pair  = rd_addr_async_i[REGION_LOG2+1:BLOCK_LOG2+3];
    wire [UPPER-1:0]      rd_upper = rd_addr_async_i[ADDR_BITS-1:REGION_LOG2+2];

    // A carry chain compares the tags, because this is the shortest path to NWAIT. Each bit of
    // same_pair and same_upper takes one LUT: it is 1 if one bit of the pair number, or three bits
    // of the region, are equal. If all these bits are 1, the addition of 1 below gives a carry.
    localparam TRIPLES = (UPPER + 2) / 3;
    wire [3*TRIPLES-1:0] moved = {{(3*TRIPLES-UPPER){1'b0}}, rd_upper ^ upper};
    wire [TRIPLES-1:0]   same_upper;
    wire [PAIR-1:0]      same_pair = ~(rd_pair ^ (rd_block ? pair1 : pair0));
    genvar t;
    generate
        for (t = 0; t < TRIPLES; t = t + 1) begin : g_triple
            assign same_upper[t] = moved[3*t +: 3] == 3'd0;
        end
    endgenerate
    wire [TRIPLES+PAIR:0] sum = {1'b0, same_pair, same_upper} + 1'b1;
    wire same_block = sum[TRIPLES+PAIR];
    wire here       = rd_block ? full[1] : full[0];
    assign rd_same_o = same_block;
    fsmc_found u_fsmc_found (
        .block_i(rd_block), .full_i(full), .have_one_i(have_one), .one_block_i(fetch_block),
        .is_one_i(rd_word == one_word), .found_o(rd_found_o)
    );
    wire   rd_hit     = same_block && rd_found_o;
    wire   unused_sum = &{1'b0, sum[TRIPLES+PAIR-1:0], rd_hit, 1'b0};
    wire   whole     = same_block && idle_o && here;
    assign rd_safe_o = whole && (rd_block ? settled[1] : settled[0]);

    wire fill = !npi_rd_empty_i && !stale;
    assign npi_rd_pop_o = !npi_rd_empty_i;
    reg [4*WIDTH-1:0] line [0:2*BLOCK-1];
    always @(posedge clk_i)
        if (fill)
            line[{fetch_block, fetch_word}] <= npi_rd_data_i;
    wire [4*WIDTH-1:0] rd_line = line[{rd_block, rd_word}];
    wire [2*WIDTH-1:0] rd_pairs = rd_addr_async_i[1] ? rd_line[4*WIDTH-1:2*WIDTH] :
        rd_line[2*WIDTH-1:0];
    assign rd_data_o = rd_addr_async_i[0] ? rd_pairs[2*WIDTH-1:WIDTH] : rd_pairs[WIDTH-1:0];

    // ---- The next fetch depends only on the registered copy of the address. While the pins
    // change, the copy may contain any address. A word that is fetched for such an address is
    // useless, but its tag is correct.
    wire [BLOCK_LOG2-1:0] at_word  = rd_at_i[BLOCK_LOG2+1:2];
    wire                  at_block = rd_at_i[BLOCK_LOG2+2];
    wire [PAIR-1:0]       at_pair  = rd_at_i[REGION_LOG2+1:BLOCK_LOG2+3];
    wire [UPPER-1:0]      at_upper = rd_at_i[ADDR_BITS-1:REGION_LOG2+2];
    // Copies of both comparisons of the address at the pins, registered together with rd_at_i. If
    // the pins change meanwhile, a copy may be wrong; then only a useless word is fetched, or valid
    // data is discarded.
    wire region_at_pins = &same_upper;
    wire same_sync, same_region;
    cdc_copy #(.WIDTH(2)) u_same (
        .clk_i(clk_i), .bus_async_i({same_block, region_at_pins}),
        .bus_sync_o({same_sync, same_region})
    );
    wire at_alone = same_sync && fetch_block == at_block && have_one;
    wire at_whole = same_sync && idle_o && (at_block ? full[1] : full[0]);

    `COUNT_UP(word_after, BLOCK_LOG2)
    `COUNT_UP(pair_after, PAIR)
    wire [PAIR-1:0] next_pair = ahead ? pair_after(at_pair) : at_pair;

    wire fetching = wanted || busy;
    wire last     = npi_rd_pop_o && (single || &fetch_word);
    wire miss     = rd_miss_i && idle_o && !fetching && !at_whole &&
        !(at_alone && at_word == one_word);
    // the second miss in the block of the single word; it fetches the whole block
    wire second   = at_alone;
    wire enter    = rd_used_i && at_whole && ahead && at_block != current;
    wire border   = current && &pair1;         // the current block is the last block of a region
    wire next     = rd_used_i && at_whole && !ahead && at_block == current && !border && !fetching;

    // ---- The port transfers posted words before it fetches
    wire start      = !npi_addr_req_o && npi_init_done_i && (post_valid || wanted);
    wire start_read = start && !post_valid;
    wire [WORD-1:0] fetch_addr = {upper, fetch_block ? pair1 : pair0, fetch_block, fetch_word};
    // page of the current request, which is stable until the request is acknowledged
    reg [5:0] page;
    always @(posedge clk_i)
        if (!npi_addr_req_o)
            page <= page_i;
    assign npi_addr_o    = {page, npi_rnw_o ? fetch_addr : post_addr, 3'd0};
    assign npi_size_o    = npi_rnw_o && !single ? BLOCK_LOG2[3:0] : 4'd0;

    always @(posedge clk_i) begin
        settled <= full;
        loads   <= miss || next;
        if (start)
            npi_rnw_o <= !post_valid;
        if (start || npi_addr_ack_i)
            npi_addr_req_o <= start;
        if (start_read)
            {wanted, busy} <= 2'b01;

        if (npi_rd_pop_o && !single)
            fetch_word <= word_after(fetch_word);
        if (last)
            {busy, stale} <= 2'b00;
        if (fill && fetch_word == one_word)
            have_one <= 1'b1;
        if (last && !stale && !single) begin
            if (fetch_block)
                full[1] <= 1'b1;
            else
                full[0] <= 1'b1;
        end

        if (enter) begin
            current <= at_block;
            ahead   <= 1'b0;
        end
        if (miss || next) begin
            wanted   <= 1'b1;
            target   <= at_block ^ next;
            single   <= miss && !second;
            have_one <= 1'b0;
            ahead    <= next;
            if (at_block ^ next)
                full[1] <= 1'b0;
            else
                full[0] <= 1'b0;
        end
        if (miss) begin
            current <= at_block;
            if (!same_region)
                full <= 2'b00;
        end
        // If the address has changed since the previous clock, the words of another address are
        // fetched. This is harmless, because the tag is the address of these words.
        if (loads) begin
            fetch_block <= target;
            fetch_word  <= single ? at_word : {BLOCK_LOG2{1'b0}};
            one_word    <= at_word;
            if (target)
                pair1 <= at_pair;
            else
                pair0 <= next_pair;
            if (full == 2'b00)
                upper <= at_upper;
        end

        if (drop_i || wr_i || rst_i) begin
            full   <= 2'b00;
            wanted <= 1'b0;
            ahead  <= 1'b0;
            have_one <= 1'b0;
            // Words of a request that has been acknowledged still arrive, and must be discarded.
            stale  <= start_read || (busy && !last);
        end
        if (rst_i) begin
            busy  <= 1'b0;
            stale <= 1'b0;
            loads <= 1'b0;
            npi_addr_req_o <= 1'b0;
        end
    end

`ifdef FORMAL
    // Proves that a read returns the value written last. The proof in fsmc_post provides these
    // signals: `place` is the halfword under observation; `foreign` is high when another master
    // writes it; `memory` is its value in memory, `newest` the value that was written last.
    (* hierconn *) wire [ADDR_BITS-1:0] \u_fsmc_post.place ;
    (* hierconn *) wire \u_fsmc_post.foreign ;
    (* hierconn *) wire [WIDTH-1:0] \u_fsmc_post.memory , \u_fsmc_post.newest ;
    (* hierconn *) wire [POST_LOG2-1:0] \u_fsmc_post.count ;
    wire [ADDR_BITS-1:0] place = \u_fsmc_post.place ;
    wire foreign = \u_fsmc_post.foreign ;
    wire [WIDTH-1:0] memory = \u_fsmc_post.memory , newest = \u_fsmc_post.newest ;

    reg past = 1'b0;
    reg untold = 1'b0;         // another master has written the halfword since the last drop_i
    // Model of the memory port. It counts the words pushed, and returns the words of a read in
    // order, with the values that the memory had when the request was acknowledged.
    reg [POST_LOG2-1:0] pushed; // number of words pushed for requests that are not acknowledged yet
    reg [4:0] to_come;
    reg [WORD-1:0] coming;     // address of the word that arrives next
    reg [WIDTH-1:0] coming_data;
    wire taken = npi_addr_req_o && npi_addr_ack_i;
    wire [WORD-1:0] npi_word = npi_addr_o[ADDR_BITS:3];
    wire [WORD-1:0] place_word = place[ADDR_BITS-1:2];
    wire [1:0] lane = place[1:0];
    wire [WIDTH-1:0] came = lane[1]
        ? (lane[0] ? npi_rd_data_i[4*WIDTH-1:3*WIDTH] : npi_rd_data_i[3*WIDTH-1:2*WIDTH])
        : (lane[0] ? npi_rd_data_i[2*WIDTH-1:WIDTH] : npi_rd_data_i[WIDTH-1:0]);
    // `kept` is the halfword under observation, as stored in the read buffer.
    wire [BLOCK_LOG2-1:0] place_in_block = place[BLOCK_LOG2+1:2];
    wire place_block = place[BLOCK_LOG2+2];
    wire [4*WIDTH-1:0] place_line = line[{place_block, place_in_block}];
    wire [WIDTH-1:0] kept = lane[1]
        ? (lane[0] ? place_line[4*WIDTH-1:3*WIDTH] : place_line[3*WIDTH-1:2*WIDTH])
        : (lane[0] ? place_line[2*WIDTH-1:WIDTH] : place_line[WIDTH-1:0]);
    wire place_same = place[ADDR_BITS-1:REGION_LOG2+2] == upper &&
                      place[REGION_LOG2+1:BLOCK_LOG2+3] == (place_block ? pair1 : pair0);
    wire place_filled = fetch_block == place_block && busy && !stale && to_come != 5'd0 &&
                        !single && place_in_block < fetch_word;
    wire place_alone  = fetch_block == place_block && have_one && place_in_block == one_word;
    wire fetching_for = loads ? target : fetch_block; // block that the current fetch reads
    // Only the following property uses these registers: the block that is read ahead follows the
    // block that is being read. The property holds if the address is stable, that is, if rd_at_i
    // equals the address at the pins one clock earlier, and does not change while the fetch begins.
    reg  [ADDR_BITS-1:0] pins_were, next_at;
    wire [WORD-BLOCK_LOG2-1:0] read_block = {upper, current ? pair1 : pair0, current};
    reg  true_at, steady;

    always @(posedge clk_i) begin
        past <= 1'b1;
        pins_were <= rd_addr_async_i;
        if (miss || next) begin
            next_at <= rd_at_i;
            true_at <= rd_at_i == pins_were;
        end
        if (loads)
            steady <= true_at && rd_at_i == next_at;
        if (past)
            assume (!rst_i);
        else
            assume (rst_i && !wr_i && !npi_addr_ack_i && npi_rd_empty_i && !foreign);
        assume (!npi_addr_ack_i || npi_addr_req_o);
        assume (npi_rd_empty_i || to_come != 5'd0);
        if (!npi_rd_empty_i && coming == place_word)
            assume (came == coming_data);
        assume (!foreign || (idle_o && !wr_i));

        pushed <= pushed + npi_wr_push_o - (taken && !npi_rnw_o);
        untold <= foreign || (untold && !drop_i);
        if (!npi_rd_empty_i) begin
            to_come <= to_come - 5'd1;
            coming  <= coming + 1'b1;
        end
        if (taken && npi_rnw_o) begin
            to_come     <= 5'd1 << npi_size_o;
            coming      <= npi_word;
            coming_data <= memory;
        end
        if (rst_i) begin
            to_come <= 5'd0;
            pushed  <= 0;
            untold  <= 1'b0;
        end

        if (past && !rst_i) begin
            // A read returns the value that the processor has written last. If another master has
            // written since, and drop_i has followed, the read returns the other master's value.
            if (rd_hit && rd_addr_async_i == place && !untold)
                assert (rd_data_o == newest);
            assert (!rd_safe_o || rd_hit);
            if (idle_o)
                assert (memory == newest);
            // Missing data is requested if no other request is pending.
            if (rd_miss_i && idle_o && !wanted && !busy)
                // |(a ^ b) instead of a != b: otherwise Yosys merges this comparison with the
                // previous one
                assert (miss || at_whole || (at_alone && !(|(at_word ^ one_word))));
            // A block stays valid until a fetch replaces it, or all data is discarded.
            if ($past(!rst_i && !drop_i && !wr_i && !(miss && !same_region)))
                assert (($past(full) & ~full &
                         ($past(miss || next) ? ~(2'b01 << target) : 2'b11)) == 2'b00);
            assert (region_at_pins == (rd_upper == upper));
            // Both blocks have the same upper address bits, so a miss in another region invalidates
            // both.
            if ($past(miss && !same_region))
                assert (full == 2'b00);
            // Read-ahead never replaces the block being read, and the block that it fetches is in
            // the same region.
            assert (!ahead || fetching_for != current);
            if (ahead && steady && fetching && !loads)
                assert (fetch_addr[WORD-1:BLOCK_LOG2] == read_block + 1'b1);
            // A miss fetches the address that was requested, also in another region.
            if (!ahead && steady && fetching && !loads && !stale)
                assert (fetch_addr[WORD-1:BLOCK_LOG2] == next_at[ADDR_BITS-1:BLOCK_LOG2+2]);
            if (ahead && loads && true_at)
                assert (full[current] && next_at[ADDR_BITS-1:BLOCK_LOG2+2] == read_block &&
                        !(&read_block[REGION_LOG2-BLOCK_LOG2-1:0]));
            // A hit does not glitch while the address is stable. A tag changes only if the flags
            // that make its data valid are 0 before and after the change.
            if (!$past(rst_i)) begin
                if ($stable(rd_addr_async_i) && $past(rd_hit && !miss && !next) && !rd_hit)
                    assert ($past(wr_i || drop_i));
                assert (!rd_hit || !$past(wr_i || drop_i));
                assert ($stable(upper) || (full | $past(full)) == 2'b00);
                assert ($stable(pair0) || !(full[0] || $past(full[0])));
                assert ($stable(pair1) || !(full[1] || $past(full[1])));
                assert ($stable({upper, pair0, pair1, fetch_block, one_word}) ||
                        !(have_one || $past(have_one)));
            end
            // The rules of the memory port hold: only one read at a time; the data of a write is
            // pushed before its request; blocks are aligned.
            if (npi_addr_req_o) begin
                assert (!npi_rnw_o || to_come == 5'd0);
                assert (npi_rnw_o || pushed != 0);
                assert (!npi_rnw_o || (!loads && (single || fetch_word == 0)));
            end
            if ($past(npi_addr_req_o && !npi_addr_ack_i && !rst_i)) begin
                assert (npi_addr_req_o && $stable(npi_rnw_o) && $stable(npi_size_o));
                assert ($stable(npi_addr_o));
            end
            assert (pushed == \u_fsmc_post.count );
            // Invariants that make the properties above inductive.
            assert (!(wanted && busy));
            assert (!wanted || loads || single || fetch_word == 0);
            assert (!loads || !(busy || have_one || full[target]));
            assert (!single || loads || !fetching || stale || fetch_word == one_word);
            assert (!stale || busy);
            assert (!(wanted || (busy && !stale) || have_one || full != 2'b00) || idle_o);
            assert (busy == ((npi_addr_req_o && npi_rnw_o) || to_come != 5'd0));
            assert (!npi_addr_req_o || npi_rnw_o || post_valid);
            if (to_come != 5'd0) begin
                assert (coming == fetch_addr || stale);
                assert (single ? to_come == 5'd1 : to_come == BLOCK - fetch_word);
            end
            assert (!wanted || !have_one);
            assert (!full[fetching_for] || !fetching || stale);
            // The word was fetched as a single word, or has arrived as part of its block.
            assert (!(have_one && busy && !stale) || (!single && one_word < fetch_word));
            if (place_same && !untold) begin
                assert (!(full[place_block] || place_filled || place_alone) || kept == memory);
                assert (!(busy && !stale && to_come != 5'd0 && coming == place_word) ||
                        coming_data == memory);
            end
            if (busy && !stale && to_come != 5'd0 && !untold)
                assert (coming_data == memory);
        end
        cover (past && rd_safe_o && rd_block && ahead && $past(ahead));
        cover (past && rd_hit && rd_addr_async_i == place && newest != 0 &&
               $past(memory, 4) != memory);
        cover (past && stale && !npi_rd_empty_i);
    end
`endif
`ifdef COVER_POINTS
    reads_ahead: cover property (@(posedge clk_i) next);
    stops_at_border: cover property (@(posedge clk_i) rd_used_i && at_whole && !ahead &&
                                     at_block == current && border);
    dropped_on_its_way: cover property (@(posedge clk_i) npi_rd_pop_o && stale);
    second_miss_fetches_block: cover property (@(posedge clk_i) miss && second);
    hit_while_block_comes: cover property (@(posedge clk_i) rd_hit && !here && busy && rd_used_i);
    drop_while_it_is_asked_for: cover property (@(posedge clk_i) (drop_i || wr_i) && start_read);
`endif
endmodule
