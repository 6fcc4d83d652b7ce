// SPDX-License-Identifier: MIT
//
// npi_fifo_proof: words come out as they went in, in order; flags tell the count.
// Included at the foot of npi_fifo.v, only for the prover.

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
