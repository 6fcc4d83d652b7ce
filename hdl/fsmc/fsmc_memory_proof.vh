// SPDX-License-Identifier: MIT
//
// fsmc_memory_proof: a read of fsmc_memory gives what was written last; only for the prover (formal.fsmc_memory).

    // fsmc_post_proof provides the halfword under observation, the writes of others to it, and its values.
    (* hierconn *) wire [ADDR_BITS-1:0] \u_fsmc_post.place ;
    (* hierconn *) wire \u_fsmc_post.foreign ;
    (* hierconn *) wire [WIDTH-1:0] \u_fsmc_post.memory , \u_fsmc_post.newest ;
    (* hierconn *) wire [POST_LOG2-1:0] \u_fsmc_post.count ;
    wire [ADDR_BITS-1:0] place = \u_fsmc_post.place ;
    wire foreign = \u_fsmc_post.foreign ;
    wire [WIDTH-1:0] memory = \u_fsmc_post.memory , newest = \u_fsmc_post.newest ;

    reg past = 1'b0;
    reg untold = 1'b0;         // others have written since the last drop_i
    // The port's model counts the words pushed, and gives the words of a read in order, as the memory had them.
    reg [POST_LOG2-1:0] pushed; // words pushed whose request has not been acknowledged
    reg [4:0] to_come;
    reg [WORD-1:0] coming;     // address of the next word to come
    reg [WIDTH-1:0] coming_data;
    wire taken = npi_addr_req_o && npi_addr_ack_i;
    wire [WORD-1:0] npi_word = npi_addr_o[ADDR_BITS:3];
    wire [WORD-1:0] place_word = place[ADDR_BITS-1:2];
    wire [1:0] lane = place[1:0];
    wire [WIDTH-1:0] came = lane[1] ? (lane[0] ? npi_rd_data_i[4*WIDTH-1:3*WIDTH] : npi_rd_data_i[3*WIDTH-1:2*WIDTH])
                                    : (lane[0] ? npi_rd_data_i[2*WIDTH-1:WIDTH] : npi_rd_data_i[WIDTH-1:0]);
    // `kept` is the halfword under observation as the read buffer has it.
    wire [BLOCK_LOG2-1:0] place_in_block = place[BLOCK_LOG2+1:2];
    wire place_block = place[BLOCK_LOG2+2];
    wire [4*WIDTH-1:0] place_line = line[{place_block, place_in_block}];
    wire [WIDTH-1:0] kept = lane[1] ? (lane[0] ? place_line[4*WIDTH-1:3*WIDTH] : place_line[3*WIDTH-1:2*WIDTH])
                                    : (lane[0] ? place_line[2*WIDTH-1:WIDTH] : place_line[WIDTH-1:0]);
    wire place_same = place[ADDR_BITS-1:REGION_LOG2+2] == upper &&
                      place[REGION_LOG2+1:BLOCK_LOG2+3] == (place_block ? pair1 : pair0);
    wire place_filled = fetch_block == place_block && busy && !stale && to_come != 5'd0 && !single &&
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
            // A read gives what the processor wrote last, or what others wrote before drop_i.
            if (rd_hit_o && rd_addr_async_i == place && !untold)
                assert (rd_data_o == newest);
            assert (!rd_safe_o || rd_hit_o);
            if (idle_o)
                assert (memory == newest);
            // Missing data is requested, if nothing else is on the way.
            if (rd_miss_i && idle_o && !wanted && !busy)
                assert (miss || at_whole || (at_alone && !(|(at_word ^ fetch_word)))); // else one cell with the above
            // A block keeps its words until a fetch needs its place, or all are dropped.
            if ($past(!rst_i && !drop_i && !wr_i && !(miss && at_upper != upper)))
                assert (($past(full) & ~full & ($past(miss || next) ? ~(2'b01 << fetch_block) : 2'b11)) == 2'b00);
            assert (!ahead || fetch_block != current); // what is read ahead never takes the place of the block being read
            // The port's rules hold: one read at a time, data of a write before its request, aligned blocks.
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
                assert (!(busy && !stale && to_come != 5'd0 && coming == place_word) || coming_data == memory);
            end
            if (busy && !stale && to_come != 5'd0 && !untold)
                assert (coming_data == memory);
        end
        cover (past && rd_safe_o && rd_block && ahead && $past(ahead));
        cover (past && rd_hit_o && rd_addr_async_i == place && newest != 0 && $past(memory, 4) != memory);
        cover (past && stale && !npi_rd_empty_i);
    end
