// SPDX-License-Identifier: MIT
//
// mcb_backend_proof: the MCB never gets a command that it refuses, and no word is lost.
// Included at the foot of mcb_backend.v, only for the prover.

    reg past = 1'b0;
    initial assume (rst_i);
    reg [7:0] asked = 0; // words of reads that were asked for and not yet taken
    always @(posedge clk_i) begin
        past <= 1'b1;
        asked <= rst_i ? 8'd0
                       : asked + (mcb_cmd_en_o && mcb_cmd_instr_o[0] ? {2'd0, mcb_cmd_bl_o} + 8'd1 : 8'd0)
                               - {7'd0, mcb_rd_en_o};
        // The MCB shows only requested words.
        assume (mcb_rd_empty_i || asked != 0);
        if (past && !rst_i) begin
            // The MCB never gets a command that it refuses; promised words stay within 0..64.
            assert (asked == 8'd64 - {1'b0, free} && free <= 7'd64);
            assert (!(mcb_cmd_en_o && (mcb_cmd_full_i || !mcb_calib_done_i)));
            assert (!(mcb_wr_en_o && mcb_wr_full_i));
            assert (!(mcb_rd_en_o && mcb_rd_empty_i));
            // Nothing is lost on the way.
            assert (mcb_cmd_en_o == (cmd_valid_i && cmd_ready_o));
            assert (mcb_wr_en_o == (wr_valid_i && wr_ready_o));
            assert (mcb_rd_en_o == (rd_valid_o && rd_ready_i));
            if (mcb_cmd_en_o)
                assert (mcb_cmd_instr_o == {2'b00, cmd_read_i} && mcb_cmd_bl_o == {1'b0, cmd_last_i});
            // Writes never wait for room of reads; reads wait only while more than half is promised.
            if (mcb_calib_done_i && !mcb_cmd_full_i && (!cmd_read_i || asked <= 8'd32))
                assert (cmd_ready_o);
            cover (asked == 8'd64);
            cover (cmd_valid_i && !cmd_ready_o && mcb_calib_done_i && !mcb_cmd_full_i);
            cover (mcb_cmd_en_o && mcb_wr_en_o && mcb_rd_en_o);
        end
    end
