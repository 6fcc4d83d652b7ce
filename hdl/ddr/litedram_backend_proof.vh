// SPDX-License-Identifier: MIT
//
// litedram_backend_proof: commands and words keep LiteDRAM's rules, and no word is lost.
// Included at the foot of litedram_backend.v, only for the prover.

    reg past = 1'b0;
    initial assume (rst_i);
    reg [7:0] words = 0;  // pushed, and not yet claimed by a command
    reg [7:0] writes = 0; // commands whose word LiteDRAM has not yet taken
    reg [7:0] reads = 0;  // commands whose word LiteDRAM has not yet given
    wire pushed = wr_valid_i && wr_ready_o;
    wire wrote  = taken && dram_cmd_we_o, read = taken && !dram_cmd_we_o;
    always @(posedge clk_i) begin
        past   <= 1'b1;
        words  <= rst_i ? 8'd0 : words + {7'd0, pushed} - {7'd0, wrote};
        writes <= rst_i ? 8'd0 : writes + {7'd0, wrote} - {7'd0, dram_wdata_ready_i};
        reads  <= rst_i ? 8'd0 : reads + {7'd0, read} - {7'd0, dram_rdata_valid_i};
        // The arbiter asks for 1, 2, 4 .. words, aligned, that fit the FIFO, and keeps a command until it is
        // ready; the words of a write are there before its command.
        assume ((cmd_last_i & (cmd_last_i + 5'd1)) == 5'd0);
        assume (cmd_last_i < (1 << WRITE_LOG2));
        assume ((cmd_addr_i[7:3] & cmd_last_i) == 5'd0);
        assume (!cmd_valid_i || cmd_read_i || words + {3'd0, index} > {3'd0, cmd_last_i});
        if (past && $past(cmd_valid_i) && !$past(cmd_ready_o) && !$past(rst_i))
            assume (cmd_valid_i && $stable(cmd_read_i) && $stable(cmd_addr_i) && $stable(cmd_last_i));
        // LiteDRAM moves data only for commands that it took, in its own time.
        assume (!(dram_wdata_ready_i && writes == 0));
        assume (!(dram_rdata_valid_i && reads == 0));
        if (past && $past(dram_init_done_i))
            assume (dram_init_done_i);
        if (past && !rst_i && !$past(rst_i)) begin
            // LiteDRAM never finds an empty write FIFO or a full read FIFO.
            assert (!(dram_wdata_ready_i && !dram_wdata_valid_o));
            assert (!(dram_rdata_valid_i && !dram_rdata_ready_o));
            // A command that it has not taken stays.
            if ($past(dram_cmd_valid_o) && !$past(dram_cmd_ready_i))
                assert (dram_cmd_valid_o && $stable(dram_cmd_we_o) && $stable(dram_cmd_addr_o));
            // Every word of a transfer goes in its turn; then the next transfer begins.
            if ($past(taken))
                assert (index == ($past(cmd_ready_o) ? 5'd0 : $past(index) + 5'd1));
            if (taken)
                assert (dram_cmd_addr_o == cmd_addr_i[ADDR_WIDTH-1:3] + {{ADDR_WIDTH-8{1'b0}}, index});
            assert (cmd_ready_o == (dram_cmd_ready_i && dram_cmd_valid_o && index == cmd_last_i) ||
                    !cmd_valid_i);
            cover (dram_wdata_ready_i && taken && !dram_cmd_we_o && index == 5'd1);
            cover (promised == (1 << READ_LOG2) && cmd_valid_i && cmd_read_i);
            cover ($past(taken) && $past(cmd_ready_o) && $past(cmd_last_i) == 5'd3);
        end
    end
