// SPDX-License-Identifier: MIT
//
// fsmc_burst_pins_proof: a burst moves each halfword once, in order; only for the prover (formal.fsmc_burst_pins).

    // Time goes in steps: an edge of FSMC_CLK, an edge of NE1, or neither. Pins have their values
    // from before the edge.
    (* gclk *) wire step;
    localparam [4:0] DEPTH = 5'd16;
    reg        past = 1'b0, was_clk = 1'b0, was_ne_n = 1'b1;
    wire       edge_of_clk = past && fsmc_clk_i && !was_clk;
    always @(posedge step) begin
        past     <= 1'b1;
        was_clk  <= fsmc_clk_i;
        was_ne_n <= fsmc_ne_n_i;
        // FSMC_CLK runs only while NE1 is low.
        assume (past || (!fsmc_clk_i && fsmc_ne_n_i));
        assume (!edge_of_clk || (!was_ne_n && !fsmc_ne_n_i));
    end

    // ---- The processor drives NADV low at a burst's first edge only, and keeps NWE. From the LATENCYth edge on an edge moves a
    // halfword if NWAIT was high at the edge before.
    reg [4:0]  edge_no;  // edges of the burst so far, up to LATENCY
    reg        ready, writes;
    reg [24:0] beat;     // address of the halfword that moves next
    reg [24:0] first;    // address of the burst's first halfword
    wire first_edge = edge_no == 5'd0;
    wire moves = edge_no >= FIRST && ready;
    always @* begin
        assume (fsmc_ne_n_i || fsmc_nadv_n_i == !first_edge);
        assume (fsmc_ne_n_i || first_edge || fsmc_nwe_n_i == !writes);
    end
    always @(posedge fsmc_clk_i or posedge fsmc_ne_n_i)
        if (fsmc_ne_n_i) begin
            edge_no <= 5'd0;
            ready   <= 1'b0;
        end else begin
            ready <= fsmc_nwait_n_o;
            if (edge_no < FIRST)
                edge_no <= edge_no + 5'd1;
        end
    always @(posedge fsmc_clk_i) begin
        if (first_edge) begin
            writes <= !fsmc_nwe_n_i;
            beat   <= MUXED != 0 ? {fsmc_a_i[24:16], fsmc_d_i} : fsmc_a_i;
            first  <= MUXED != 0 ? {fsmc_a_i[24:16], fsmc_d_i} : fsmc_a_i;
        end else if (moves) begin
            beat <= beat + 25'd1;
        end
    end

    // ---- The FIFOs behave as async_fifo is proven to: the count that this side sees falls, or rises, by itself.
    reg [4:0] held = 5'd0;
    (* anyseq *) reg [4:0] fewer;
    always @* begin
        assume (fewer <= held);
        assume (full_i == (held >= DEPTH - 5'd2));
    end
    always @(posedge fsmc_clk_i)
        held <= fewer + {4'd0, push_o};
    // `value` is the halfword with number `place` that is popped in a burst.
    (* anyconst *) reg [2:0] place;
    reg [2:0]  popped, moved;
    reg [15:0] value;
    always @(posedge fsmc_clk_i or posedge fsmc_ne_n_i)
        if (fsmc_ne_n_i) begin
            popped <= 3'd0;
            moved  <= 3'd0;
        end else begin
            popped <= popped + {2'd0, pop_o};
            moved  <= moved + {2'd0, moves};
        end
    always @(posedge fsmc_clk_i)
        if (pop_o && popped == place)
            value <= pop_data_i;

    always @* if (past && !fsmc_ne_n_i) begin
        // Each halfword that the processor writes goes into the FIFO, with its address, and nothing else.
        assert (push_o == (moves && writes));
        if (push_o) begin
            assert (held < DEPTH);
            assert (push_data_o == {beat, ~fsmc_nbl_n_i, fsmc_d_i});
        end
        // Each halfword that it reads is the next one of a FIFO that was restarted at the first
        // edge.
        assert (restart_o == (first_edge && fsmc_nwe_n_i));
        assert (!pop_o || (!empty_i && !writes && !first_edge && addr_o == first));
        if (moves && !writes && moved == place)
            assert (fsmc_d_o == value);
        // These invariants carry the proof of the above.
        assert (begun_o == !first_edge && edges == edge_no && nwait_was == ready);
        if (begun_o) begin
            assert (write == writes && addr_o == (writes ? beat : first));
            assert (writes || popped - moved == {2'd0, fsmc_nwait_n_o} + {2'd0, ready});
            assert (!writes || held <= DEPTH - 5'd2 + {4'd0, !fsmc_nwait_n_o} + {4'd0, !fsmc_nwait_n_o && !ready});
            if (!writes && fsmc_nwait_n_o && popped - 3'd1 == place)
                assert (stage == value);
            if (!writes && ready && moved == place)
                assert (fsmc_d_o == value);
        end
        assert (edge_no >= FIRST - 5'd1 || !fsmc_nwait_n_o || writes);
        cover (push_o && held == DEPTH - 5'd1);
        cover (moves && !writes && moved == 3'd2 && place == 3'd2 && fsmc_d_o != 16'd0);
        cover (moves && writes && beat != first);
    end
