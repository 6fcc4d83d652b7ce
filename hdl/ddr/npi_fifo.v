// SPDX-License-Identifier: MIT
//
// npi_fifo: FIFO with first-word fall-through: while empty_o is 0, data_o is the first word.
//
// Words are stored in LUT RAM, or with BLOCK in block RAM. Block RAM needs no LUTs for the words,
// but one more clock from push_i to empty_o. The user must not push while the FIFO is full or pop
// while it is empty; the proofs of the users show that this does not happen.
//
// With LANES > 1, the user collects each word in the FIFO: store_i stores lanes of the word that is
// pushed next, and push_i only counts this word. Lanes that are stored in the clock of push_i
// belong to the word after it. The user must not store lanes while the FIFO is full, or in the
// clock of the push that fills it. Until a lane is stored, it contains a lane of an earlier word.

`default_nettype none
`include "shift_order.vh"

module npi_fifo #(
    parameter WIDTH = 72,
    parameter LOG2  = 5, // depth: 2**LOG2 words, LOG2 is 2..24
    parameter BLOCK = 0, // 1: the words are in block RAM; 0: in LUT RAM
    parameter LANES = 1  // number of lanes of a word; 1: push_i stores the word
) (
    input  wire             clk_i,
    input  wire             rst_i, // reset, which also empties the FIFO
    input  wire             push_i,
    input  wire [LANES-1:0] store_i, // not used if LANES is 1
    input  wire [WIDTH-1:0] data_i,
    input  wire             pop_i,
    output wire [WIDTH-1:0] data_o,
    output wire             empty_o,
    output wire             full_o
);
    `SHIFT_ORDER(after, LOG2)
    // write_place: address of the next word to write. read_place: address of the next word to move
    // to data_o; with LUT RAM, address of the word on data_o.
    reg  [LOG2-1:0] write_place, read_place;
    wire [LOG2-1:0] write_next = after(write_place);
    localparam LANE = WIDTH / LANES; // width of a lane
    wire [LOG2-1:0] store_place = LANES > 1 && push_i ? write_next : write_place;
    wire [LANES-1:0] store = LANES > 1 ? store_i : {LANES{push_i}};
    integer l;

    // full_o comes from a register, because long paths of the requesters begin at this output.
    wire nearly; // the FIFO is full, or has room for exactly one word
    wire moves;  // the word at read_place can move to data_o
    reg  full;
    assign full_o = full;
    wire unused = &{1'b0, store_i, 1'b0};

    always @(posedge clk_i) begin
        if (push_i)
            write_place <= write_next;
        if (moves)
            read_place <= after(read_place);
        full <= !pop_i && (full || (push_i && nearly));
        if (rst_i) begin
            full        <= 1'b0;
            write_place <= 0;
            read_place  <= 0;
        end
    end

    generate
        if (BLOCK == 0) begin : g_lut
            reg [WIDTH-1:0] words [0:(1<<LOG2)-1];
            assign nearly  = write_next == read_place;
            assign moves   = pop_i;
            assign empty_o = write_place == read_place && !full;
            assign data_o  = words[read_place];
            always @(posedge clk_i)
                for (l = 0; l < LANES; l = l + 1)
                    if (store[l])
                        words[store_place][LANE*l +: LANE] <= data_i[LANE*l +: LANE];
        end else begin : g_block
            // no_rw_check (Yosys): no word is read in the clock in which it is written (see below).
            // Without this attribute, Yosys would add 150 flip-flops and 80 LUTs on chips whose RAM
            // does not return the old word in this case, such as ECP5.
            (* ram_style = "block", no_rw_check *)
            reg [WIDTH-1:0] words [0:(1<<LOG2)-1];
            reg [WIDTH-1:0] word;
            reg             empty;
            // The RAM is never read at the address that is being written, so it returns only words
            // of earlier clocks. pop_i only drives an enable, so it may arrive late in the clock.
            wire fetch = empty || pop_i;
            wire ready = read_place != write_place;
            assign moves   = fetch && ready;
            // the count includes the word on data_o
            assign nearly  = after(write_next) == read_place;
            assign empty_o = empty;
            assign data_o  = word;
            always @(posedge clk_i) begin
                for (l = 0; l < LANES; l = l + 1)
                    if (store[l])
                        words[store_place][LANE*l +: LANE] <= data_i[LANE*l +: LANE];
                if (moves)
                    word <= words[read_place];
                empty <= rst_i || (fetch && !ready);
            end
        end
    endgenerate

`ifdef FORMAL
    // Proves that words leave in order and unchanged, and that the flags agree with the number of
    // words.
    // 1: this is the proof of the FIFO itself, and assumptions exclude errors of the user
    parameter PROOF = 0;

    // Numbers the words of the FIFO, and computes the numbers of the next word to write and to
    // pop, for the proofs of its users.
    `SHIFT_NUMBERS(place_of, number_of, after, LOG2)
    wire [LOG2-1:0] f_write = number_of(write_place);
    wire [LOG2-1:0] f_read  = number_of(read_place) - {{(LOG2-1){1'b0}}, BLOCK != 0 && !empty_o};
    wire [2*LOG2-1:0]        f_indexes = {f_write, f_read};
    wire [(WIDTH<<LOG2)-1:0] f_words;
    genvar f;
    generate
        for (f = 0; f < (1 << LOG2); f = f + 1) begin : g_words
            if (BLOCK == 0) begin : g_lut_word
                assign f_words[WIDTH*f +: WIDTH] = g_lut.words[place_of(f)];
            end else begin : g_block_word
                assign f_words[WIDTH*f +: WIDTH] = g_block.words[place_of(f)];
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
                    assert (LANES == 1 || !(|store_i && (full_o || (push_i && nearly))));
                end
        end else begin : g_proof
            initial assume (rst_i);
            // The word that is pushed at `place` leaves the FIFO unchanged, as word number `place`.
            (* anyconst *) reg [LOG2-1:0] place;
            reg [WIDTH-1:0] value;
            reg inside = 1'b0;
            wire [LOG2-1:0] from_read = place - f_read, used = f_write - f_read;
            wire [LOG2:0]   count = {full_o, used};
            always @(posedge clk_i) begin
                assume (!(push_i && full_o));
                assume (!(pop_i && empty_o));
                if (push_i && f_write == place) begin
                    value  <= data_i;
                    inside <= 1'b1;
                end
                if ((pop_i && f_read == place) || rst_i)
                    inside <= 1'b0;
                if (past) begin
                    assert (!full_o || used == 0);
                    assert (empty_o || count != 0);
                    if (BLOCK == 0)
                        assert (empty_o == (count == 0));
                    else if ($past(count) != 0 && !$past(pop_i) && !$past(rst_i))
                        assert (!empty_o); // the word appears at most one clock later
                    if (BLOCK != 0 && empty_o)
                        assert (count <= 1);
                    assert (inside == ({1'b0, from_read} < count));
                    if (inside)
                        assert (f_words[WIDTH*place +: WIDTH] == value);
                    if (inside && f_read == place && !empty_o)
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
    empties: cover property (@(posedge clk_i) pop_i && !push_i &&
                             write_place == (BLOCK != 0 ? read_place : after(read_place)));
`endif
endmodule
