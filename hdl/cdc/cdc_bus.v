// SPDX-License-Identifier: MIT
//
// cdc_bus: transfers each word from src_clk_i to dst_clk_i exactly once, two to three clocks later.
//
// A register in the source's clock domain holds the word. The destination copies it in the clock
// in which the second flip-flop of the synchroniser toggles. Without a handshake, the next word
// must come at least two clocks of dst_clk_i later, plus the skew of the paths. The module has no
// reset. Constraints: one period of dst_clk_i from src_data's register to the copy, and the
// constraints of cdc_bit.

`default_nettype none

module cdc_bus #(
    parameter WIDTH = 8
) (
    input  wire             src_clk_i,
    input  wire             src_valid_i,
    input  wire [WIDTH-1:0] src_data_i,
    // last word that was accepted, in the clock domain src_clk_i
    output reg  [WIDTH-1:0] src_data_o,
    input  wire             dst_clk_i,
    output wire             dst_valid_o,    // one cycle
    // word, valid from dst_valid_o until the next word is accepted
    output wire [WIDTH-1:0] dst_data_o,
    output wire             pending_sync_o, // pending_async_o, synchronised to dst_clk_i
    output wire             pending_async_o // high while a word has not been transferred yet
);
    always @(posedge src_clk_i)
        if (src_valid_i)
            src_data_o <= src_data_i;

    cdc_pulse u_cdc_pulse (
        .src_clk_i(src_clk_i), .src_valid_i(src_valid_i), .dst_clk_i(dst_clk_i),
        .dst_valid_o(dst_valid_o),
        .pending_sync_o(pending_sync_o), .pending_async_o(pending_async_o)
    );
    cdc_copy #(.WIDTH(WIDTH))
        u_cdc_copy (.clk_i(dst_clk_i), .bus_async_i(src_data_o), .bus_sync_o(dst_data_o));

`ifdef FORMAL
    // Proves that each word is transferred once, in order and unchanged. Time advances in steps. In
    // each step either clock and the data may change, so the proof covers every ratio and phase. An
    // input that changes in the same step as an edge is sampled with its old value; cdc_bit may
    // sample the new value one clock later.
    (* gclk *) wire step;
    reg past = 1'b0, was_src = 1'b1, was_clk = 1'b1, was_valid = 1'b0, known = 1'b0;
    reg [WIDTH-1:0] was_data = 0;
    reg was_given = 1'b0, gave = 1'b0;
    // up to two words that have not been transferred; without such words, `newer` is the last word
    // sent
    reg [WIDTH-1:0] older = 0, newer = 0;
    reg [1:0] count = 2'd0;
    // number of edges of dst_clk_i since the edge of src_clk_i that sent the last word
    reg [2:0] clocks = 3'd3;
    wire rise        = past && src_clk_i && !was_src;
    wire edge_of_clk = past && dst_clk_i && !was_clk;
    wire writes      = rise && was_given;
    wire handed      = edge_of_clk && was_valid; // the receiver has sampled dst_valid_o
    wire rings       = writes && clocks == 3'd0 && count != 2'd0 && was_data == newer;
    wire new_write   = writes && !rings;
    always @(posedge step) begin
        past      <= 1'b1;
        was_src   <= src_clk_i;
        was_clk   <= dst_clk_i;
        was_valid <= dst_valid_o;
        was_data  <= src_data_i;
        was_given <= src_valid_i;
        gave      <= gives;
        assume (past || (src_clk_i && dst_clk_i));
        count <= count + {1'b0, new_write} - {1'b0, handed};
        if (new_write) begin
            older  <= newer;
            newer  <= was_data;
            known  <= 1'b1;
            clocks <= 3'd0;
        end else if (edge_of_clk && clocks != 3'd7) begin
            clocks <= clocks + 3'd1;
        end
        // Assumption: dst_clk_i has at least three edges between two words. A second edge of
        // src_clk_i with the same data, before the next edge of dst_clk_i, is ringing, not a word.
        assume (!new_write || clocks >= 3'd3);
    end
    wire [1:0] left  = count - {1'b0, handed}; // number of words that are left after this step
    // dst_valid_o was high in the last clock of dst_clk_i
    wire       gives = edge_of_clk ? was_valid : gave;
    always @* if (past) begin
        // A word is pending as soon as it is sent, and is transferred once, in order and
        // unchanged.
        assert (!handed || count != 2'd0);
        assert (left <= 2'd1 || dst_valid_o);
        assert (pending_async_o == (new_write || left != 2'd0 || gives));
        assert (pending_sync_o == (dst_valid_o || gives));
        if (dst_valid_o) begin
            assert (left != 2'd0);
            assert (dst_data_o == (left == 2'd2 ? older : newer));
        end
        assert (left == 2'd0 || clocks + {2'd0, edge_of_clk} <= 3'd3 || (clocks == 3'd3 && handed));
        // src_data_o is the last word that was sent; it changes only at an edge that sends a word.
        if (known || new_write)
            assert (src_data_o == (new_write ? was_data : newer));
        // The copy of the last word stays unchanged until the next word arrives.
        if (known && left == 2'd0)
            assert (dst_data_o == newer);
        cover (rings);
        cover (new_write && clocks == 3'd3 && dst_valid_o);
        cover (dst_valid_o && rise && !writes);
    end
`endif
endmodule
