// SPDX-License-Identifier: MIT
//
// npi_write_fifo: write FIFO of one port of npi_arbiter: words of eight bytes with byte enables.
//
// BYTES is for a port that writes single bytes and puts each byte on all eight lanes. The FIFO then
// stores lane 0 only, which takes 16 bits per word instead of 72.
//
// MERGE is for a port that writes parts of words. The FIFO collects a word: in each clock, it
// stores the bytes with a 1 in be_i, and push_i completes the word. Bytes that are stored in the
// clock of push_i belong to the next word. The byte enables of the word are 1 for all bytes that
// were stored for it; each word needs at least one. The port must not store bytes while the FIFO is
// full, or in the clock of the push that fills it.

`default_nettype none

module npi_write_fifo #(
    parameter BYTES = 0, // 1: the eight lanes of a word have the same byte
    parameter MERGE = 0, // 1: the FIFO collects words; BYTES must be 0
    parameter LOG2  = 5, // depth, 2**LOG2 words
    parameter BLOCK = 0  // 1: words are in block RAM; 0: in LUT RAM
) (
    input  wire        clk_i,
    input  wire        rst_i, // reset, which also empties the FIFO
    input  wire        push_i,
    input  wire [63:0] data_i,
    input  wire [7:0]  be_i,
    input  wire        pop_i,
    output wire [63:0] data_o,
    output wire [7:0]  be_o,
    output wire        empty_o,
    output wire        full_o
);
    localparam STORED = BYTES != 0 ? 8 : 64; // number of data bits that are stored
    localparam LANES  = MERGE != 0 ? 8 : 1;
    wire [7+STORED:0] word_in, word_out;
    wire [LANES-1:0]  store;
    npi_fifo #(.WIDTH(8 + STORED), .LOG2(LOG2), .BLOCK(BLOCK), .LANES(LANES)) u_fifo (
        .clk_i(clk_i), .rst_i(rst_i),
        .push_i(push_i), .store_i(store), .data_i(word_in),
        .pop_i(pop_i), .data_o(word_out), .empty_o(empty_o), .full_o(full_o)
    );
    genvar b;
    generate
        if (MERGE != 0) begin : g_merge
            // Each lane contains a byte and its enable, which is the parity bit of the block RAM.
            // The first bytes of a word are stored together with all enables.
            for (b = 0; b < 8; b = b + 1) begin : g_lane
                assign word_in[9*b +: 9] = {be_i[b], data_i[8*b +: 8]};
                assign {be_o[b], data_o[8*b +: 8]} = word_out[9*b +: 9];
            end
            reg  begun; // bytes of the word have been stored
            wire stores = |be_i;
            assign store = be_i | {8{stores && (push_i || !begun)}};
            always @(posedge clk_i)
                begun <= !rst_i && (stores || (begun && !push_i));
        end else begin : g_whole
            assign word_in = {be_i, data_i[STORED-1:0]};
            assign be_o    = word_out[STORED +: 8];
            assign data_o  = {(64/STORED){word_out[STORED-1:0]}};
            assign store   = 1'b0;
            wire unused = &{1'b0, data_i, 1'b0};
        end
    endgenerate

`ifdef FORMAL
    // Proves that a FIFO that stores lane 0, or that collects words, acts like a FIFO that stores
    // whole words. npi_arbiter is proven with FIFOs that store whole words.
    localparam DEPTH = 1 << LOG2;
    // words in the FIFO; numbers of the next word to write and to pop
    (* hierconn *) wire [(8+STORED)*DEPTH-1:0] \u_fifo.f_words ;
    (* hierconn *) wire [2*LOG2-1:0]           \u_fifo.f_indexes ;
    wire [(8+STORED)*DEPTH-1:0] words = \u_fifo.f_words ;
    wire [2*LOG2-1:0]           indexes = \u_fifo.f_indexes ;
    wire [LOG2-1:0]             read = indexes[LOG2-1:0], used = indexes[2*LOG2-1:LOG2] - read;
    generate
        if (BYTES != 0 || MERGE != 0) begin : g_proof
            // With MERGE, `open` is the word that the port is collecting.
            reg  [71:0] open;
            wire [71:0] all_in = MERGE != 0 ? open : {be_i, data_i};
            wire [71:0] all;
            wire        all_empty, all_full;
            npi_fifo #(.WIDTH(72), .LOG2(LOG2), .BLOCK(BLOCK)) u_all (
                .clk_i(clk_i), .rst_i(rst_i), .push_i(push_i), .store_i(1'b0), .data_i(all_in),
                .pop_i(pop_i), .data_o(all), .empty_o(all_empty), .full_o(all_full)
            );
            (* hierconn *) wire [72*DEPTH-1:0] \u_all.f_words ;
            (* hierconn *) wire [2*LOG2-1:0]   \u_all.f_indexes ;
            wire [72*DEPTH-1:0] all_words = \u_all.f_words ;
            wire [2*LOG2-1:0]   all_indexes = \u_all.f_indexes ;
            reg past = 1'b0;
            initial assume (rst_i);
            integer e, n;
            reg [LOG2-1:0] place;
            reg [71:0]     word; // the word at `place` in the FIFO
            reg            same; // this word has the byte enables and the enabled bytes of the port
            always @(posedge clk_i) begin
                past <= 1'b1;
                assume (MERGE != 0 || data_i == {8{data_i[7:0]}});
                // Pushing while full and popping while empty are errors of the user.
                assume (!(push_i && full_o) && !(pop_i && empty_o));
                for (n = 0; n < 8; n = n + 1)
                    if (MERGE != 0 && be_i[n])
                        open[8*n +: 8] <= data_i[8*n +: 8];
                open[71:64] <= be_i | (push_i || rst_i ? 8'd0 : open[71:64]);
                if (MERGE != 0) begin
                    assume (!rst_i || be_i == 8'd0);
                    assume (!push_i || open[71:64] != 8'd0);
                    // the number of words that the FIFO holds with the word that is stored
                    assume (be_i == 8'd0 || {full_o, used} + {{LOG2{1'b0}}, push_i} < DEPTH);
                end
                if (past) begin
                    assert (all_empty == empty_o && all_full == full_o);
                    if (!empty_o) begin
                        assert (all[71:64] == be_o);
                        for (n = 0; n < 8; n = n + 1)
                            assert (!be_o[n] || all[8*n +: 8] == data_o[8*n +: 8]);
                        assert (MERGE != 0 || all[63:0] == data_o);
                    end
                    // These invariants make the assertions above inductive.
                    assert (all_indexes == indexes);
                    assert (!full_o || used == 0);
                    assert (empty_o || full_o || used != 0);
                    for (e = 0; e < DEPTH; e = e + 1) begin
                        place = e[LOG2-1:0] - read;
                        if (MERGE == 0) begin
                            if (full_o || place < used)
                                assert (all_words[72*e +: 72] ==
                                        {words[16*e+8 +: 8], {8{words[16*e +: 8]}}});
                        end else begin
                            word = full_o || place < used ? all_words[72*e +: 72] : open;
                            same = 1'b1;
                            for (n = 0; n < 8; n = n + 1)
                                if (words[72*e + 9*n + 8] != word[64 + n] ||
                                    (word[64 + n] && words[72*e + 9*n +: 8] != word[8*n +: 8]))
                                    same = 1'b0;
                            if (full_o || place < used || (place == used && open[71:64] != 8'd0))
                                assert (same);
                        end
                    end
                end
                cover (past && full_o);
                cover (past && !empty_o && {be_o, data_o[7:0]} == 16'h8142);
                cover (MERGE == 0 ||
                       (past && !empty_o && be_o == 8'h81 && data_o[63:56] == 8'h42));
            end
            if (MERGE != 0) begin : g_begun
                always @(posedge clk_i)
                    if (past)
                        assert (g_merge.begun == (open[71:64] != 8'd0));
            end
        end
    endgenerate
`endif
endmodule
