// SPDX-License-Identifier: MIT
//
// npi_stream_proof: requests keep the rules of docs/memory.md; the core gets its words and no others.
// Included at the foot of npi_stream.v, only for the prover.

    // The port has two FIFOs of 32 words and a controller that acknowledges when it likes.
    reg       past = 1'b0;
    reg [5:0] pushed, promised; // words in the write FIFO; words of reads that are acknowledged, not yet popped
    reg [5:0] there;            // of those, in the read FIFO
    reg [6:0] owed;             // words of acknowledged writes, still in the write FIFO
    (* anyseq *) wire may_move, may_come;
    wire      moved = may_move && owed != 7'd0;
    wire      came  = may_come && there != promised;
    // The core takes what is offered, starts when idle, flushes without a word.
    reg [WORD_BITS-1:0] f_left; // words that it may still take
    reg [2:0] f_begun;          // words it gave since the burst began
    reg [ADDR_BITS-1:6] f_read, f_write; // where the next bursts go, once there was a start
    reg       f_reads, f_writes;
    initial assume (rst_i);
    always @* begin
        assume (!npi_addr_ack_i || npi_addr_req_o);
        assume (npi_rd_empty_i == (there == 6'd0));
        assume (npi_wr_almost_full_i == (pushed == 6'd32));
        assume (!read_take_i || read_valid_o);
        assume (!read_start_i || (read_idle_o && !read_stop_i));
        assume (!write_start_i || (write_idle_o && !write_valid_i && !write_flush_i));
        assume (!write_flush_i || !write_valid_i);
    end
    always @(posedge clk_i) begin
        past     <= !rst_i;
        pushed   <= pushed + {5'd0, npi_wr_push_o} - {5'd0, moved};
        owed     <= owed + (npi_addr_ack_i && !npi_rnw_o ? 7'd8 : 7'd0) - {6'd0, moved};
        promised <= promised + (npi_addr_ack_i && npi_rnw_o ? 6'd8 : 6'd0) - {5'd0, npi_rd_pop_o};
        there    <= there + {5'd0, came} - {5'd0, npi_rd_pop_o};
        f_left   <= read_stop_i ? {WORD_BITS{1'b0}} : read_start_i ? read_words_i
                    : f_left - {{(WORD_BITS - 1){1'b0}}, read_take_i};
        if (write_valid_i && write_ready_o)
            f_begun <= f_begun + 3'd1;
        else if (padding && full)
            f_begun <= 3'd0;
        f_read   <= read_start_i ? read_base_i : f_read + {{(ADDR_BITS - 7){1'b0}}, npi_addr_ack_i && npi_rnw_o};
        f_write  <= write_start_i ? write_base_i : f_write + {{(ADDR_BITS - 7){1'b0}}, npi_addr_ack_i && !npi_rnw_o};
        f_reads  <= !rst_i && (f_reads || read_start_i);
        f_writes <= !rst_i && (f_writes || write_start_i);
        if (rst_i) begin
            pushed   <= 6'd0;
            owed     <= 7'd0;
            promised <= 6'd0;
            there    <= 6'd0;
            f_left   <= {WORD_BITS{1'b0}};
            f_begun  <= 3'd0;
        end
    end
    always @* if (!rst_i && past) begin
        // By the rules of docs/memory.md no FIFO overflows or is popped empty, and a write's words
        // precede its request.
        assert (!npi_wr_push_o || pushed != 6'd32);
        assert (!npi_rd_pop_o || there != 6'd0);
        assert (promised <= 6'd32 && !(npi_addr_req_o && npi_rnw_o && promised > 6'd24));
        assert (!(npi_addr_req_o && !npi_rnw_o) || {1'b0, pushed} >= owed + 7'd8);
        assert (outstanding == promised && there <= promised);
        assert (!read_idle_o || (f_left == {WORD_BITS{1'b0}} && promised == 6'd0 && !(npi_addr_req_o && npi_rnw_o)));
        assert ({1'b0, pushed} == owed + {1'b0, bursts, 3'd0} + {4'd0, filled});
        assert (bursts <= 3'd4 && owed <= 7'd32);
        assert (!write_idle_o || (filled == 3'd0 && bursts == 3'd0));
        // The core gets as many words as it requested, no more; all requested words come.
        assert (to_give == f_left);
        assert (!read_valid_o || f_left != {WORD_BITS{1'b0}});
        assert (to_ask == {WORD_BITS{1'b0}} || to_give >= to_ask);
        // While words are still to be requested, those on their way are the core's.
        assert (to_ask == {WORD_BITS{1'b0}} || {1'b0, to_give} == {1'b0, to_ask} + {{(WORD_BITS - 5){1'b0}}, outstanding});
        assert (pushed <= 6'd32);
        assert (!padding || filled != 3'd0);
        assert (!npi_addr_req_o || npi_rnw_o || bursts != 3'd0);
        // Bursts follow each other from the base.
        assert (!f_reads || read_addr == f_read);
        assert (!f_writes || write_addr == f_write);
        // A word that is not the core's writes nothing.
        assert (!npi_wr_push_o || npi_wr_be_o == 8'd0 || (write_valid_i && write_ready_o));
        cover (read_take_i && f_left == {{(WORD_BITS - 1){1'b0}}, 1'b1} && npi_addr_req_o && !npi_rnw_o);
        cover (npi_rd_pop_o && !read_valid_o);
        cover (padding && full);
        cover (acked_write && bursts == 3'd1 && filled == 3'd0);
        cover (promised == 6'd32);
    end
    always @(posedge clk_i) if (past && !rst_i && !$past(rst_i) && $past(npi_addr_req_o && !npi_addr_ack_i)) begin
        assert (npi_addr_req_o && $stable(npi_rnw_o) && $stable(npi_size_o));
        assert ($stable(npi_addr_o));
    end
    // Idle is shown one clock later, not more.
    always @(posedge clk_i) if (past && !rst_i && !$past(rst_i)) begin
        assert (write_idle_o || $past(filled != 3'd0 || bursts != 3'd0 || npi_wr_push_o));
        assert (read_idle_o || $past(to_give != {WORD_BITS{1'b0}} || promised != 6'd0 || read_start_i || (npi_addr_req_o && npi_rnw_o)));
    end
