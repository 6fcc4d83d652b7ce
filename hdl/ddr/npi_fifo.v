// SPDX-License-Identifier: MIT
//
// npi_fifo: first-in first-out; its first word is on data_o while empty_o is 0.
//
// Words are in LUT RAM, or with BLOCK in block RAM: that takes no LUTs for words, and one clock more from
// push_i to empty_o. A push while full and a pop while empty are the user's errors; they are proven absent
// where the FIFO is used.

`default_nettype none

module npi_fifo #(
    parameter WIDTH = 72,
    parameter LOG2  = 5, // 2**LOG2 words
    parameter BLOCK = 0  // 1: words in block RAM
) (
    input  wire             clk_i,
    input  wire             rst_i, // also empties it
    input  wire             push_i,
    input  wire [WIDTH-1:0] data_i,
    input  wire             pop_i,
    output wire [WIDTH-1:0] data_o,
    output wire             empty_o,
    output wire             full_o
);
    reg  [LOG2:0] write_index, read_index;
    // The index after the word on data_o; pop_i only decides whether to go there, so it may come late.
    wire [LOG2:0] next = read_index + {{LOG2{1'b0}}, BLOCK == 0 || !empty_o};

    // full_o is a register, because requesters' paths begin here.
    wire [LOG2:0] after = write_index + 1'b1;
    wire          nearly = after[LOG2-1:0] == read_index[LOG2-1:0]; // room for one, of any count but the full one
    reg           full;
    assign full_o = full;

    always @(posedge clk_i) begin
        if (push_i)
            write_index <= after;
        if (pop_i)
            read_index <= next;
        full <= !pop_i && (full || (push_i && nearly));
        if (rst_i) begin
            full        <= 1'b0;
            write_index <= 0;
            read_index  <= 0;
        end
    end

    generate
        if (BLOCK == 0) begin : g_lut
            reg [WIDTH-1:0] words [0:(1<<LOG2)-1];
            assign empty_o = write_index == read_index;
            assign data_o  = words[read_index[LOG2-1:0]];
            always @(posedge clk_i)
                if (push_i)
                    words[write_index[LOG2-1:0]] <= data_i;
        end else begin : g_block
            // no_rw_check (Yosys): no word is read in the clock of its write (see below). Without it, chips whose RAM
            // does not give the old word, such as ECP5, spend 150 flip-flops and 80 LUTs on holding it.
            (* ram_style = "block", no_rw_check *)
            reg [WIDTH-1:0] words [0:(1<<LOG2)-1];
            reg [WIDTH-1:0] word;
            reg             empty;
            // The RAM gives only words of earlier clocks: it is never read where it is being
            // written.
            wire fetch = empty || pop_i;
            wire ready = next != write_index;
            assign empty_o = empty;
            assign data_o  = word;
            always @(posedge clk_i) begin
                if (push_i)
                    words[write_index[LOG2-1:0]] <= data_i;
                if (fetch && ready)
                    word <= words[next[LOG2-1:0]];
                empty <= rst_i || (fetch && !ready);
            end
        end
    endgenerate

`ifdef FORMAL
    // Words come out as they went in, in order; flags tell the count.
    parameter PROOF = 0; // 1 where the FIFO itself is proven: its user's errors are assumed away

    // The FIFO's words and indexes, for proofs of its users.
    wire [(WIDTH<<LOG2)-1:0] f_words;
    wire [2*LOG2+1:0]        f_indexes = {write_index, read_index};
    genvar f;
    generate
        for (f = 0; f < (1 << LOG2); f = f + 1) begin : g_words
            if (BLOCK == 0) begin : g_lut_word
                assign f_words[WIDTH*f +: WIDTH] = g_lut.words[f];
            end else begin : g_block_word
                assign f_words[WIDTH*f +: WIDTH] = g_block.words[f];
            end
        end
    endgenerate
    reg past = 1'b0;
    always @(posedge clk_i)
        past <= 1'b1;
    generate
        if (PROOF == 0) begin : g_used
            always @(posedge clk_i)
                if (past && !rst_i) begin
                    assert (!(push_i && full_o));
                    assert (!(pop_i && empty_o));
                end
        end else begin : g_proof
            initial assume (rst_i);
            // Any one word comes out as it went in, in its place.
            (* anyconst *) reg [LOG2:0] place;
            reg [WIDTH-1:0] value;
            reg inside = 1'b0;
            wire [LOG2:0] count = write_index - read_index;
            always @(posedge clk_i) begin
                assume (!(push_i && full_o));
                assume (!(pop_i && empty_o));
                if (push_i && write_index == place) begin
                    value  <= data_i;
                    inside <= 1'b1;
                end
                if ((pop_i && read_index == place) || rst_i)
                    inside <= 1'b0;
                if (past) begin
                    assert (count <= (1 << LOG2));
                    assert (full_o == (count == (1 << LOG2)));
                    assert (empty_o || count != 0);
                    if (BLOCK == 0)
                        assert (empty_o == (count == 0));
                    else if ($past(count) != 0 && !$past(pop_i) && !$past(rst_i))
                        assert (!empty_o); // a clock later, not more
                    assert (inside == ((place - read_index) < count));
                    if (inside && read_index == place && !empty_o)
                        assert (data_o == value);
                    cover (full_o);
                    cover ($past(full_o) && $past(pop_i) && !empty_o && inside);
                end
            end
        end
    endgenerate
`endif
`ifdef COVER_POINTS
    is_full: cover property (@(posedge clk_i) full_o);
    both_at_once: cover property (@(posedge clk_i) push_i && pop_i);
    empties: cover property (@(posedge clk_i) pop_i && next == write_index && !push_i);
`endif
endmodule
