// SPDX-License-Identifier: MIT
//
// npi_write_fifo: write FIFO of one port of npi_arbiter: words of eight bytes with byte enables.
//
// BYTES is for a port that writes single bytes and puts each byte on all eight lanes. The FIFO then
// stores lane 0 only, which takes 16 bits per word instead of 72.

`default_nettype none

module npi_write_fifo #(
    parameter BYTES = 0, // 1: the eight lanes of a word have the same byte
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
    wire [STORED-1:0] stored;
    npi_fifo #(.WIDTH(8 + STORED), .LOG2(LOG2), .BLOCK(BLOCK)) u_fifo (
        .clk_i(clk_i), .rst_i(rst_i),
        .push_i(push_i), .data_i({be_i, data_i[STORED-1:0]}),
        .pop_i(pop_i), .data_o({be_o, stored}), .empty_o(empty_o), .full_o(full_o)
    );
    assign data_o = {(64/STORED){stored}};
    wire unused = &{1'b0, data_i, 1'b0};

`ifdef FORMAL
    // Proves that a FIFO that stores lane 0 acts like a FIFO that stores all lanes. npi_arbiter is
    // proven with FIFOs that store all lanes.
    localparam DEPTH = 1 << LOG2;
    // words in the FIFO; numbers of the next word to write and to pop
    (* hierconn *) wire [(8+STORED)*DEPTH-1:0] \u_fifo.f_words ;
    (* hierconn *) wire [2*LOG2-1:0]           \u_fifo.f_indexes ;
    wire [(8+STORED)*DEPTH-1:0] words = \u_fifo.f_words ;
    wire [2*LOG2-1:0]           indexes = \u_fifo.f_indexes ;
    wire [LOG2-1:0]             read = indexes[LOG2-1:0], used = indexes[2*LOG2-1:LOG2] - read;
    generate
        if (BYTES != 0) begin : g_proof
            wire [71:0] all;
            wire        all_empty, all_full;
            npi_fifo #(.WIDTH(72), .LOG2(LOG2), .BLOCK(BLOCK)) u_all (
                .clk_i(clk_i), .rst_i(rst_i), .push_i(push_i), .data_i({be_i, data_i}),
                .pop_i(pop_i), .data_o(all), .empty_o(all_empty), .full_o(all_full)
            );
            (* hierconn *) wire [72*DEPTH-1:0] \u_all.f_words ;
            (* hierconn *) wire [2*LOG2-1:0]   \u_all.f_indexes ;
            wire [72*DEPTH-1:0] all_words = \u_all.f_words ;
            wire [2*LOG2-1:0]   all_indexes = \u_all.f_indexes ;
            reg past = 1'b0;
            initial assume (rst_i);
            integer e;
            reg [LOG2-1:0] place;
            always @(posedge clk_i) begin
                past <= 1'b1;
                assume (data_i == {8{data_i[7:0]}});
                // Pushing while full and popping while empty are errors of the user.
                assume (!(push_i && full_o) && !(pop_i && empty_o));
                if (past) begin
                    assert (all_empty == empty_o && all_full == full_o);
                    if (!empty_o)
                        assert (all == {be_o, data_o});
                    // These invariants make the assertions above inductive.
                    assert (all_indexes == indexes);
                    assert (!full_o || used == 0);
                    assert (empty_o || full_o || used != 0);
                    for (e = 0; e < DEPTH; e = e + 1) begin
                        place = e[LOG2-1:0] - read;
                        if (full_o || place < used)
                            assert (all_words[72*e +: 72] ==
                                    {words[16*e+8 +: 8], {8{words[16*e +: 8]}}});
                    end
                end
                cover (past && full_o);
                cover (past && !empty_o && {be_o, data_o[7:0]} == 16'h8142);
            end
        end
    endgenerate
`endif
endmodule
