// SPDX-License-Identifier: MIT
//
// axis_memory_proof: requests keep the rules of docs/memory.md. Included at the foot of axis_memory.v, only for the prover.
// The halves have proofs of their own.

    // The port has two FIFOs of 32 words and a controller that acknowledges when it likes.
    reg       past = 1'b0;
    reg [5:0] pushed, promised; // words in the write FIFO; words of reads that are acknowledged, not yet popped
    reg [5:0] there;            // of those, in the read FIFO
    reg [6:0] owed;             // words of acknowledged writes, still in the write FIFO
    (* anyseq *) wire may_move, may_come;
    wire      moved = may_move && owed != 7'd0;
    wire      came  = may_come && there != promised;
    (* hierconn *) wire [2:0] \u_read.asked ;
    (* hierconn *) wire [2:0] \u_read.place ;
    (* hierconn *) wire [2:0] \u_write.place ;
    (* hierconn *) wire [2:0] \u_write.queued ;
    (* hierconn *) wire [2:0] \u_write.unacked ;
    wire f_reading = request && request_read, f_writing = request && !request_read;
    initial assume (rst_i);
    always @* begin
        assume (!npi_addr_ack_i || npi_addr_req_o);
        assume (npi_rd_empty_i == (there == 6'd0));
        assume (npi_wr_almost_full_i == (pushed == 6'd32));
    end
    always @(posedge clk_i) begin
        past     <= !rst_i;
        pushed   <= pushed + {5'd0, npi_wr_push_o} - {5'd0, moved};
        owed     <= owed + (npi_addr_ack_i && !npi_rnw_o ? 7'd8 : 7'd0) - {6'd0, moved};
        promised <= promised + (npi_addr_ack_i && npi_rnw_o ? 6'd8 : 6'd0) - {5'd0, npi_rd_pop_o};
        there    <= there + {5'd0, came} - {5'd0, npi_rd_pop_o};
        if (rst_i) begin
            pushed   <= 6'd0;
            owed     <= 7'd0;
            promised <= 6'd0;
            there    <= 6'd0;
        end
    end
    always @* if (!rst_i && past) begin
        assert (!npi_wr_push_o || pushed != 6'd32);
        assert (!npi_rd_pop_o || there != 6'd0);
        assert (promised <= 6'd32 && !(f_reading && promised > 6'd24));
        assert (!f_writing || {1'b0, pushed} >= owed + 7'd8);
        assert (there <= promised && pushed <= 6'd32 && owed <= 7'd32);
        assert ({\u_read.asked , 3'd0} == promised + {2'd0, f_reading, 3'd0} + {3'd0, \u_read.place });
        assert (\u_read.asked <= 3'd4 && \u_write.unacked <= 3'd4);
        assert (\u_write.unacked == \u_write.queued + {2'd0, f_writing});
        assert ({1'b0, pushed} == owed + {1'b0, \u_write.unacked , 3'd0} + {4'd0, \u_write.place });
        assert (npi_addr_o[5:0] == 6'd0);
        assert (!idle_o || (!request && promised == 6'd0 && \u_write.unacked == 3'd0 && !m_axis_tvalid_o && !done_valid_o));
        cover (npi_addr_ack_i && !npi_rnw_o && promised == 6'd32);
        cover (done_valid_o && m_axis_tvalid_o && m_axis_tlast_o);
    end
    always @(posedge clk_i) if (past && !rst_i && !$past(rst_i) && $past(npi_addr_req_o && !npi_addr_ack_i))
        assert (npi_addr_req_o && $stable(npi_rnw_o) && $stable(npi_size_o) && $stable(npi_addr_o));
