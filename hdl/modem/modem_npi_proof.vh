// SPDX-License-Identifier: MIT
//
// modem_npi_proof: words and acknowledgements keep the rules of a memory port.
// Included at the foot of modem_npi.v, only for the prover.

    reg past = 1'b0;
    initial assume (rst_i);
    reg [4:0] words = 5'd0; // pushed and not acknowledged
    reg       owed  = 1'b0; // a word was asked for and has not come
    always @(posedge clk_i) begin
        past <= 1'b1;
        // The memory answers a request only, and gives a word only for a read that it took.
        assume (!npi_addr_ack_i || npi_addr_req_o);
        assume (npi_rd_empty_i || owed);
        if (npi_addr_req_o && npi_addr_ack_i && npi_rnw_o)
            owed <= 1'b1;
        else if (npi_rd_pop_o)
            owed <= 1'b0;
        words <= words + npi_wr_push_o - (npi_addr_req_o && npi_addr_ack_i && !npi_rnw_o);
        if (rst_i) begin
            words <= 5'd0;
            owed  <= 1'b0;
        end
        if (past && !rst_i && !$past(rst_i)) begin
            // A request stays, with its address, until it is acknowledged.
            if ($past(npi_addr_req_o) && !$past(npi_addr_ack_i))
                assert (npi_addr_req_o && $stable(npi_addr_o) && $stable(npi_rnw_o));
            // One word of data before each write, never another.
            assert (words == (state == WRITE));
            assert (owed == (state == WAIT_WORD));
            assert (!(npi_rd_pop_o && npi_rd_empty_i));
            // A read that was withdrawn is never done, a write that was taken is requested.
            if (rd_done_o)
                assert ($past(rd_valid_i) && rd_valid_i && $past(wanted));
            if ($past(wr_ready_o))
                assert (wr_busy_o && npi_addr_o[10:3] == $past(wr_addr_i));
        end
        cover (past && !rst_i && wr_busy_o && npi_addr_ack_i);
        cover (past && !rst_i && rd_done_o);
        cover (past && !rst_i && npi_rd_pop_o && !rd_done_o);
    end
