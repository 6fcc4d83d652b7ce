// SPDX-License-Identifier: MIT
//
// fsmc_memory: memory half of the FSMC bridge: posted halfword writes, merged into words of four
// halfwords, and halfword reads from a read-ahead buffer.
//
// fsmc_post handles the writes. Reads are answered from two buffers of one block each, for blocks
// with even and odd numbers. The first miss fetches one word, a second miss in the same block
// fetches the block. After that, entering a block fetches the next one, up to the next multiple of
// 4 KiB (the buffers share the upper address bits). Nothing is fetched while a write waits. A
// write, or drop_i, discards all data read, including words that have not arrived yet. A read
// therefore never returns data older than a previous write.

`default_nettype none

module fsmc_memory #(
    parameter ADDR_BITS   = 25, // width of a halfword address
    parameter WIDTH       = 16, // width of a halfword; less in proofs
    parameter POST_LOG2   = 4,  // closed words that can wait: 2**POST_LOG2 - 1
    parameter BLOCK_LOG2  = 3,  // words in a block: 2**BLOCK_LOG2; 1..4
    parameter REGION_LOG2 = 9   // read-ahead stops at multiples of 2**REGION_LOG2 words
) (
    input  wire                 clk_i,
    input  wire                 rst_i,
    // address bits above the window; writes need idle_o while it changes
    input  wire [5:0]           page_i,
    // writes: one cycle each; a write without room_o is lost
    input  wire                 wr_i,
    input  wire [ADDR_BITS-1:0] wr_addr_i, // halfword address
    input  wire [WIDTH-1:0]     wr_data_i,
    input  wire [1:0]           wr_be_i,
    output wire                 wr_lost_o, // high in the cycle of a wr_i without room
    output wire                 room_o,    // room for at least two halfwords
    output wire                 more_room_o, // room for three
    // reads: combinational from the pins; rd_miss_i requests missing data at rd_at_i, the copy of
    // the address in clk_i
    input  wire [ADDR_BITS-1:0] rd_addr_async_i, // halfword address
    input  wire [ADDR_BITS-1:0] rd_at_i,
    input  wire                 rd_used_i, // the halfword is being read
    input  wire                 rd_miss_i, // a read waits for its data
    output wire                 rd_hit_o,
    output wire                 rd_safe_o, // a hit in a block that was valid a clock ago
    output wire [WIDTH-1:0]     rd_data_o,
    // ordering
    input  wire                 flush_i,   // write out all posted data
    input  wire                 drop_i,    // discard the read buffers
    output wire                 idle_o,    // all writes have been acknowledged
    // memory port
    output wire [ADDR_BITS+6:0] npi_addr_o,
    output reg                  npi_addr_req_o,
    input  wire                 npi_addr_ack_i,
    output reg                  npi_rnw_o,
    output wire [3:0]           npi_size_o,
    output wire [4*WIDTH-1:0]   npi_wr_data_o,
    output wire [7:0]           npi_wr_be_o,
    output wire                 npi_wr_push_o,
    input  wire [4*WIDTH-1:0]   npi_rd_data_i,
    output wire                 npi_rd_pop_o,
    input  wire                 npi_rd_empty_i,
    input  wire                 npi_init_done_i
);
    localparam WORD  = ADDR_BITS - 2;                // width of a word address
    localparam UPPER = WORD - REGION_LOG2;           // of these, the bits of the region
    // of these, the bits of the pair of blocks in a region; block and word follow
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
        .push_o(npi_wr_push_o), .push_data_o(npi_wr_data_o), .push_be_o(npi_wr_be_o),
        .word_valid_o(post_valid), .word_addr_o(post_addr),
        .word_taken_i(npi_addr_ack_i && !npi_rnw_o)
    );

    // ---- Read buffer
    reg [UPPER-1:0]      upper;           // region of both blocks
    reg [PAIR-1:0]       pair0, pair1;    // pair of the even and of the odd block
    // bit n: block n is complete; it was complete one clock ago
    reg [1:0]            full, settled;
    reg                  current;         // the block being read
    reg                  ahead;           // the other block holds the next block, or will
    // A fetch has read the words below fetch_word or, with have_single, only that word.
    reg                  wanted, busy, stale, single, have_single;
    reg                  fetch_block;
    reg [BLOCK_LOG2-1:0] fetch_word;

    wire [BLOCK_LOG2-1:0] rd_word  = rd_addr_async_i[BLOCK_LOG2+1:2];
    wire                  rd_block = rd_addr_async_i[BLOCK_LOG2+2];
    wire [PAIR-1:0]       rd_pair  = rd_addr_async_i[REGION_LOG2+1:BLOCK_LOG2+3];
    wire [UPPER-1:0]      rd_upper = rd_addr_async_i[ADDR_BITS-1:REGION_LOG2+2];

    wire same_block = rd_upper == upper && (rd_block ? rd_pair == pair1 : rd_pair == pair0);
    wire filling    = fetch_block == rd_block && busy && !stale && !single && rd_word < fetch_word;
    wire alone      = fetch_block == rd_block && have_single;
    wire here       = rd_block ? full[1] : full[0];
    assign rd_hit_o  = same_block && (here || filling || (alone && rd_word == fetch_word));
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

    // ---- The next fetch depends only on the registered copy of the address. While the pins move
    // the copy may contain any address: the fetched word is then useless, but its tag is correct.
    wire [BLOCK_LOG2-1:0] at_word  = rd_at_i[BLOCK_LOG2+1:2];
    wire                  at_block = rd_at_i[BLOCK_LOG2+2];
    wire [PAIR-1:0]       at_pair  = rd_at_i[REGION_LOG2+1:BLOCK_LOG2+3];
    wire [UPPER-1:0]      at_upper = rd_at_i[ADDR_BITS-1:REGION_LOG2+2];
    wire same_sync;
    cdc_copy #(.WIDTH(1)) u_same (.clk_i(clk_i), .bus_async_i(same_block), .bus_sync_o(same_sync));
    wire at_alone = same_sync && fetch_block == at_block && have_single;
    wire at_whole = same_sync && idle_o && (at_block ? full[1] : full[0]);

    wire fetching = wanted || busy;
    wire last     = npi_rd_pop_o && (single || &fetch_word);
    wire miss     = rd_miss_i && idle_o && !fetching && !at_whole &&
        !(at_alone && at_word == fetch_word);
    wire second   = at_alone;                  // a miss next to the single word: fetch the block
    wire enter    = rd_used_i && at_whole && ahead && at_block != current;
    wire border   = current && &pair1;         // the last block of a region
    wire next     = rd_used_i && at_whole && !ahead && at_block == current && !border && !fetching;

    // ---- The port handles posted words first
    wire start      = !npi_addr_req_o && npi_init_done_i && (post_valid || wanted);
    wire start_read = start && !post_valid;
    wire [WORD-1:0] fetch_addr = {upper, fetch_block ? pair1 : pair0, fetch_block, fetch_word};
    reg [5:0] page; // page of the request, held until it is acknowledged
    always @(posedge clk_i)
        if (!npi_addr_req_o)
            page <= page_i;
    assign npi_addr_o    = {page, npi_rnw_o ? fetch_addr : post_addr, 3'd0};
    assign npi_size_o    = npi_rnw_o && !single ? BLOCK_LOG2[3:0] : 4'd0;

    always @(posedge clk_i) begin
        settled <= full;
        if (start)
            npi_rnw_o <= !post_valid;
        if (start || npi_addr_ack_i)
            npi_addr_req_o <= start;
        if (start_read)
            {wanted, busy} <= 2'b01;

        if (npi_rd_pop_o && !single)
            fetch_word <= fetch_word + 1'b1;
        if (last)
            {busy, stale} <= 2'b00;
        if (last && !stale) begin
            have_single <= single;
            if (!single && fetch_block)
                full[1] <= 1'b1;
            if (!single && !fetch_block)
                full[0] <= 1'b1;
        end

        if (enter) begin
            current <= at_block;
            ahead   <= 1'b0;
        end
        if (miss || next) begin
            wanted      <= 1'b1;
            fetch_block <= at_block ^ next;
            single      <= miss && !second;
            have_single <= 1'b0;
            fetch_word  <= miss && !second ? at_word : {BLOCK_LOG2{1'b0}};
            ahead       <= next;
            if (at_block ^ next) begin
                pair1   <= at_pair;
                full[1] <= 1'b0;
            end else begin
                pair0   <= at_pair + {{(PAIR-1){1'b0}}, next};
                full[0] <= 1'b0;
            end
        end
        if (miss) begin
            current <= at_block;
            upper   <= at_upper;
            if (at_upper != upper)
                full <= 2'b00;
        end

        if (drop_i || wr_i || rst_i) begin
            full   <= 2'b00;
            wanted <= 1'b0;
            ahead  <= 1'b0;
            have_single <= 1'b0;
            // The words of an acknowledged request will still arrive.
            stale  <= start_read || (busy && !last);
        end
        if (rst_i) begin
            busy  <= 1'b0;
            stale <= 1'b0;
            npi_addr_req_o <= 1'b0;
        end
    end

`ifdef FORMAL
    // A read returns the value written last. fsmc_post_proof provides the halfword under
    // observation, the writes of others to it, and its values.
    (* hierconn *) wire [ADDR_BITS-1:0] \u_fsmc_post.place ;
    (* hierconn *) wire \u_fsmc_post.foreign ;
    (* hierconn *) wire [WIDTH-1:0] \u_fsmc_post.memory , \u_fsmc_post.newest ;
    (* hierconn *) wire [POST_LOG2-1:0] \u_fsmc_post.count ;
    wire [ADDR_BITS-1:0] place = \u_fsmc_post.place ;
    wire foreign = \u_fsmc_post.foreign ;
    wire [WIDTH-1:0] memory = \u_fsmc_post.memory , newest = \u_fsmc_post.newest ;

    reg past = 1'b0;
    reg untold = 1'b0;         // others have written since the last drop_i
    // The model of the port counts the words pushed, and returns the words of a read in order, as
    // the memory held them.
    reg [POST_LOG2-1:0] pushed; // words pushed with a request that is not acknowledged yet
    reg [4:0] to_come;
    reg [WORD-1:0] coming;     // address of the next word to arrive
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
        !single &&
                        place_in_block < fetch_word;
    wire place_alone  = fetch_block == place_block && have_single && place_in_block == fetch_word;

    always @(posedge clk_i) begin
        past <= 1'b1;
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
            // A read returns the last write of the processor, or data that others wrote before
            // drop_i.
            if (rd_hit_o && rd_addr_async_i == place && !untold)
                assert (rd_data_o == newest);
            assert (!rd_safe_o || rd_hit_o);
            if (idle_o)
                assert (memory == newest);
            // Missing data is requested if no other request is pending.
            if (rd_miss_i && idle_o && !wanted && !busy)
                // else one cell with the above
                assert (miss || at_whole || (at_alone && !(|(at_word ^ fetch_word))));
            // A block keeps its words until a fetch replaces it, or all are dropped.
            if ($past(!rst_i && !drop_i && !wr_i && !(miss && at_upper != upper)))
                assert (($past(full) & ~full &
                         ($past(miss || next) ? ~(2'b01 << fetch_block) : 2'b11)) == 2'b00);
            // The blocks' tags share the upper bits: a miss in another region takes both back.
            if ($past(miss && at_upper != upper))
                assert (full == 2'b00);
            // read-ahead never replaces the block being read
            assert (!ahead || fetch_block != current);
            // The rules of the port hold: one read at a time, data of a write before its request,
            // aligned blocks.
            if (npi_addr_req_o) begin
                assert (!npi_rnw_o || to_come == 5'd0);
                assert (npi_rnw_o || pushed != 0);
                assert (!npi_rnw_o || single || fetch_word == 0);
            end
            if ($past(npi_addr_req_o && !npi_addr_ack_i && !rst_i)) begin
                assert (npi_addr_req_o && $stable(npi_rnw_o) && $stable(npi_size_o));
                assert ($stable(npi_addr_o));
            end
            assert (pushed == \u_fsmc_post.count );
            // These invariants carry the proof of the above.
            assert (!(wanted && busy));
            assert (!wanted || single || fetch_word == 0);
            assert (!stale || busy);
            assert (!(wanted || (busy && !stale) || have_single || full != 2'b00) || idle_o);
            assert (busy == ((npi_addr_req_o && npi_rnw_o) || to_come != 5'd0));
            assert (!npi_addr_req_o || npi_rnw_o || post_valid);
            if (to_come != 5'd0) begin
                assert (coming == fetch_addr || stale);
                assert (single ? to_come == 5'd1 : to_come == BLOCK - fetch_word);
            end
            assert (!have_single || !fetching);
            assert (!full[fetch_block] || !(fetching || have_single) || stale);
            if (place_same && !untold) begin
                assert (!(full[place_block] || place_filled || place_alone) || kept == memory);
                assert (!(busy && !stale && to_come != 5'd0 && coming == place_word) ||
                        coming_data == memory);
            end
            if (busy && !stale && to_come != 5'd0 && !untold)
                assert (coming_data == memory);
        end
        cover (past && rd_safe_o && rd_block && ahead && $past(ahead));
        cover (past && rd_hit_o && rd_addr_async_i == place && newest != 0 &&
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
    hit_while_block_comes: cover property (@(posedge clk_i) rd_hit_o && filling && rd_used_i);
    drop_while_it_is_asked_for: cover property (@(posedge clk_i) (drop_i || wr_i) && start_read);
`endif
endmodule
