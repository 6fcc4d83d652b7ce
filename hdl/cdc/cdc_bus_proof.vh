// SPDX-License-Identifier: MIT
//
// cdc_bus_proof: cdc_bus hands each word over once, in order, unchanged; only for the prover (formal.cdc_bus).
//
// Time goes in steps; either clock and the data may change in each, so every ratio and phase is covered.
// An input that changes together with an edge is seen as it was before it; cdc_bit may see it a clock later.

    (* gclk *) wire step;
    reg past = 1'b0, was_src = 1'b1, was_clk = 1'b1, was_valid = 1'b0, known = 1'b0;
    reg [WIDTH-1:0] was_data = 0;
    reg was_given = 1'b0, gave = 1'b0;
    reg [WIDTH-1:0] older = 0, newer = 0; // words that have not been handed over; with none, `newer` is the last one
    reg [1:0] count = 2'd0;
    reg [2:0] clocks = 3'd3;             // edges of dst_clk_i since the last word's edge
    wire rise        = past && src_clk_i && !was_src;
    wire edge_of_clk = past && dst_clk_i && !was_clk;
    wire writes      = rise && was_given;
    wire handed      = edge_of_clk && was_valid; // the user has seen dst_valid_o
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
        // Two edges of src_clk_i that hand over are at least three edges of dst_clk_i apart; ringing is closer.
        assume (!new_write || clocks >= 3'd3);
    end
    wire [1:0] left  = count - {1'b0, handed}; // words left in this step
    wire       gives = edge_of_clk ? was_valid : gave; // the clock after dst_valid_o
    always @* if (past) begin
        // Each word is pending at once and handed over once, in order, as it was.
        assert (!handed || count != 2'd0);
        assert (left <= 2'd1 || dst_valid_o);
        assert (pending_async_o == (new_write || left != 2'd0 || gives));
        assert (pending_sync_o == (dst_valid_o || gives));
        if (dst_valid_o) begin
            assert (left != 2'd0);
            assert (dst_data_o == (left == 2'd2 ? older : newer));
        end
        assert (left == 2'd0 || clocks + {2'd0, edge_of_clk} <= 3'd3 || (clocks == 3'd3 && handed));
        // The source's word stands from its edge until the next.
        if (known || new_write)
            assert (src_data_o == (new_write ? was_data : newer));
        // The copy of the last word stays until the next.
        if (known && left == 2'd0)
            assert (dst_data_o == newer);
        cover (rings);
        cover (new_write && clocks == 3'd3 && dst_valid_o);
        cover (dst_valid_o && rise && !writes);
    end
