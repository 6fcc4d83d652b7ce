// SPDX-License-Identifier: MIT
//
// fsmc_registers_proof: an access makes at most one transfer, of a whole word; only for the prover (formal.fsmc_registers).

    // A hung slave is given up as soon as expired_i is high, which PATIENCE = 1 lets bus_rules
    // allow.
    bus_rules #(.MASTER(1), .PATIENCE(1)) u_bus_rules (
        .clk_i(clk_i), .rst_i(rst_i), .valid_i(bus_valid_o), .write_i(bus_write_o),
        .addr_i(bus_addr_o), .wdata_i(bus_wdata_o), .ready_i(bus_ready_i), .rdata_i(bus_rdata_i),
        .error_i(bus_error_i)
    );
    reg        past = 1'b0;
    reg [3:0]  patience;  // the bridge's time-out count, shorter
    reg [4:0]  stuck;     // clocks of this access without an answer
    reg [31:0] last_read; // the word that the bus gave last
    reg [15:0] last_low;  // low half written last
    reg        low_word;  // the low half of bus_addr_o's word was the last write
    reg        low_read;  // the access begun last reads a low half
    reg        was_busy = 1'b0;
    reg [40:0] write_was;
    always @* begin
        // NWAIT at the pins holds the next write and its data back until the one before is done.
        assume (!(busy_o && wr_i));
        assume (!(was_busy && busy_o) || write_was == {wr_addr_i, wr_data_i});
        // Time-outs come as the bridge counts them.
        assume (expired_i == patience[3]);
    end
    always @(posedge clk_i) begin
        past <= 1'b1;
        if (past)
            assume (!rst_i);
        else
            assume (rst_i);
        was_busy <= busy_o;
        write_was <= {wr_addr_i, wr_data_i};
        patience <= restart_o || patience[3] || rst_i ? 4'd0 : patience + 4'd1;
        stuck    <= !rst_i && (flushing || bus_valid_o) ? stuck + 5'd1 : 5'd0;
        if (ends && !bus_write_o)
            last_read <= bus_rdata_i;
        if (begins && keep)
            last_low <= wr_data_i;
        low_word <= !rst_i && (begins ? wr_i && !wr_addr_i[0] && wr_addr_i[24:11] == 14'd0 : low_word);
        if (begins)
            low_read <= !wr_i && !rd_addr_i[0];

        if (past && !rst_i) begin
            // An access makes one transfer at most, one at a time, and no transfer comes without an access.
            assert ({2'd0, flushing} + {2'd0, bus_valid_o} + {2'd0, give} + {2'd0, answering} <= 3'd1);
            if (bus_valid_o && !$past(bus_valid_o))
                assert ($past(flushing));
            if (flushing && !$past(flushing))
                assert ($past(idle && (wr_i || reading_i)));
            // Words stay whole: a kept high half belongs to the word read last; a word is written
            // with the low half that was written just before.
            assert (!half_read || (word == last_read && low_read));
            assert (!half_read || $past(half_read) || $past(reading_i));
            assert (half_write == low_word);
            assert (idle || !half_write);
            assert (!flushing && !bus_valid_o || !half_read);
            assert (!half_write || low == last_low);
            if ((flushing || bus_valid_o) && bus_write_o)
                assert (low == last_low);
            // Waiting ends after two time-outs and the steps between.
            assert (!flushing || stuck <= patience);
            assert (!bus_valid_o || stuck <= patience + 5'd9);
            assert (stuck <= 5'd18);
            // Memory writes come first, unless the memory hangs.
            if (bus_valid_o && !$past(bus_valid_o))
                assert ($past(idle_i) || $past(expired_i));
            // An answer goes only to the access that asked for it, and falls with either pin.
            assert (!done || !(ne_n_async_i || noe_n_async_i));
            assert (!$past(given_up && !begins) || !(done && !$past(done)));
        end
        cover (past && bus_valid_o && bus_write_o && bus_ready_i);
        cover (past && done && rd_addr_i[0] && $past(half_read, 3));
        cover (past && error_o && $past(expired_i));
        cover (past && error_memory_o);
    end
