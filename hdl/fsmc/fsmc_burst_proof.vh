// SPDX-License-Identifier: MIT
//
// fsmc_burst_proof: fsmc_burst asks for the halfwords of a burst in order; only for the prover (formal.fsmc_burst).

    // Only the side of clk_i is proven: pins and FIFOs are cut off, and do what they are proven to do or more.
    reg        past = 1'b0, was_begins = 1'b0;
    reg [24:0] asked, count;  // address of this session; number of its halfwords that went into the FIFO
    always @(posedge clk_i) begin
        past       <= 1'b1;
        was_begins <= begins;
        if (begins)
            asked <= addr_sync;
        count <= begins ? 25'd0 : count + {24'd0, rd_valid_o && rd_ready_i};
    end
    reg known = 1'b0;         // a session has begun
    always @(posedge clk_i)
        known <= known || begins;
    always @* begin
        assume (!begins || no_room);
        // The halfwords from the session's address on go into the FIFO, in order.
        if (rd_valid_o)
            assert (known && !no_room && !begins);
        if (known)
            assert (rd_addr_o == asked + count);
        assert (!reading || known);
        assert (wr_valid_o == !none);
        cover (past && rd_valid_o && count == 25'd3 && asked == 25'd9);
        cover (was_begins && rd_valid_o);
    end
