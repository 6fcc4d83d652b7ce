// SPDX-License-Identifier: MIT
//
// fsmc_words_proof: proves that 32-bit register words are atomic at the pins of fsmc_bridge; this
// file is a part of fsmc_bridge_proof.
//
// These properties hold for any sequence of accesses, each of them completed or aborted, to
// registers, to addresses after the last slot and to memory:
// - A word written to the bus consists of the last two completed register accesses of the
//   processor: the low half, then the high half of the same word. An aborted access writes nothing.
// - A write of a high half, or to an address after the last slot, causes exactly one transfer or
//   one error report, before the next register access continues. It causes a transfer if the
//   previous access was the write of the low half of the same word, and no read was attempted
//   between the two writes. Otherwise it causes an error report. A write of a low half causes
//   neither.
// - A read returns a half of the word that the bus returned last, and that word has the address of
//   the read. The transfer of this word began in this access or, for a high half, in the previous
//   read of its low half. If no access was attempted between these two reads, the transfer began
//   in the read of the low half, so both halves are from one transfer. Otherwise aborted reads,
//   also of the low half, may lie between the two reads. A read after the last slot returns 0.
// - Each read, even if it is aborted, makes at most one transfer. A transfer happens only for an
//   access.
//
// The second part of the file states how the registers of this proof depend on the registers of the
// bridge. With these invariants, all assertions together are inductive over two steps, so they are
// proven for sequences of any length.

    wire up = resets > 3'd1;

    reg        was_valid = 1'b0, was_write = 1'b0;
    reg [1:0]  was_addr = 2'd0;
    reg [31:0] was_rdata = 32'd0;
    always @(posedge step)
        {was_valid, was_write, was_addr, was_rdata} <=
            {bus_valid, bus_write, bus_addr[1:0], bus_rdata};
    wire reads     = access && ne2_i && !noe_n_i;
    wire was_reads = was_access && was_ne2 && !was_noe;
    wire wrote2    = wrote && was_ne2;
    wire read_done = was_reads && !selected && !gives_up;
    wire begins    = bus_valid && !was_valid;
    wire ends      = was_valid && !bus_valid;
    // no transfer
    wire reports   = clock && access_error && !error_memory && error_write && !(ends && was_write);
    // NWE rises before NE (RM0033). If the access is aborted, NWE rises after NE, never in the same
    // step.
    always @* assume (!(was_access && !selected && !was_nwe) || !nwe_n_i);

    // ---- Writes
    // low_may: the bridge may have stored the low half that was written last. low_sure: the bridge
    // has certainly stored it.
    reg       low_may = 1'b0, low_sure = 1'b0;
    reg [1:0] low_at = 2'd0, low = 2'd0;
    // owed: the bridge owes a transfer or an error report. may: a transfer is allowed; sure: a
    // transfer is required.
    reg       owed = 1'b0, may = 1'b0, sure = 1'b0;
    reg [1:0] word_at = 2'd0;
    reg [3:0] word = 4'd0;
    wire keeps    = !was_beyond && !was_a[0];
    wire pair     = !was_beyond && was_a[0] && low_may && low_at == was_a[2:1];
    wire low_may_n  = wrote2 ? keeps : low_may && !read_done;
    wire low_sure_n = wrote2 ? keeps : low_sure && !reads;
    wire [1:0] low_at_n = wrote2 ? was_a[2:1] : low_at;
    wire [1:0] low_n    = wrote2 ? was_d : low;
    wire owed_n   = wrote2 ? !keeps : owed && !(begins && bus_write) && !reports;
    wire may_n    = wrote2 ? pair : may;
    wire sure_n   = wrote2 ? pair && low_sure : sure;
    wire [1:0] word_at_n = wrote2 ? was_a[2:1] : word_at;
    wire [3:0] word_n    = wrote2 ? {was_d, low} : word;
    always @(posedge step) begin
        {low_may, low_sure, low_at, low} <= {low_may_n, low_sure_n, low_at_n, low_n};
        {owed, may, sure, word_at, word} <= {owed_n, may_n, sure_n, word_at_n, word_n};
    end
    always @* if (up) begin
        if (begins && bus_write)
            assert (owed && may);
        if (bus_valid && bus_write)
            assert (bus_addr == {8'd0, word_at} &&
                    bus_wdata == {14'd0, word[3:2], 14'd0, word[1:0]});
        if (reports)
            assert (owed && !sure && error_addr == {8'd0, word_at});
        if (access && ne2_i && nwait_n)
            assert (!owed_n);
        cover (begins && bus_write && sure && word == 4'b0110);
        cover (begins && bus_write && !sure);
        cover (reports && may);
    end

    // ---- Reads: transfers
    // unread: the transfer of the current access has not begun yet. forgotten: the transfer of an
    // aborted access has not begun yet.
    reg  unread = 1'b0, forgotten = 1'b0;
    wire fetches     = begins && !bus_write;
    wire unread_n    = reads && (!was_reads || (unread && !(fetches && !forgotten)));
    wire forgotten_n = (forgotten && !fetches) ||
        (gives_up && was_reads && unread && !(fetches && !forgotten));
    always @(posedge step)
        {unread, forgotten} <= {unread_n, forgotten_n};
    always @* if (up && fetches)
        assert (unread || forgotten);

    // ---- Reads: data. `its` is the address of any word, which the prover chooses
    (* anyconst *) reg [1:0] its;
    // asked: a transfer has begun in this access; got: this transfer has ended
    reg       asked = 1'b0, got = 1'b0;
    // half_may: the bridge may have stored the high half of the word `its`. half_sure: the bridge
    // has certainly stored it.
    reg       half_may = 1'b0, half_sure = 1'b0;
    reg [1:0] answer_at = 2'd0;
    reg [3:0] answer = 4'd0;
    wire answered = ends && !was_write;
    // the access that ends reads the low half of the word `its`
    wire mine     = !was_beyond && was_a == {its, 1'b0};
    wire asked_n  = access && (asked || (fetches && reads));
    wire got_n    = access && (got || (answered && was_reads && asked && was_addr == a_i[2:1]));
    wire half_may_n  = wrote2 ? 1'b0 : read_done ? mine : half_may ||
        (gives_up && was_reads && mine);
    wire half_sure_n = wrote2 ? 1'b0 : read_done ? mine :
                       half_sure && !(reads && (beyond_i || a_i != {its, 1'b1})) &&
                           !(gives_up && was_reads);
    wire [1:0] answer_at_n = answered ? was_addr : answer_at;
    wire [3:0] answer_n = answered ? {was_rdata[17:16], was_rdata[1:0]} : answer;
    always @(posedge step) begin
        {asked, got, half_may, half_sure} <= {asked_n, got_n, half_may_n, half_sure_n};
        {answer_at, answer} <= {answer_at_n, answer_n};
    end
    always @* if (up && reads && nwait_n) begin
        if (beyond_i)
            assert (d_out == 16'd0);
        else begin
            assert (answer_at_n == a_i[2:1]);
            assert (d_out == {14'd0, a_i[0] ? answer_n[3:2] : answer_n[1:0]});
            if (a_i[2:1] == its) begin
                assert (got_n || (a_i[0] && half_may));
                assert (!got_n || !a_i[0] || !half_sure);
            end
        end
        cover (a_i == {its, 1'b1} && !beyond_i && half_sure && d_out == 16'd2);
        cover (a_i == {its, 1'b1} && !beyond_i && half_may && got_n && d_out == 16'd1);
        cover (a_i == {its, 1'b1} && !beyond_i && half_may && !half_sure && !got_n);
    end

    // ---- The registers of this proof agree with the registers of the bridge. All values are from
    // the current step
    wire [3:0]  turn = turns[4:1] ^ turns[3:0];
    wire        s0 = \u_fsmc_bridge.u_access.bit_meta [4],
        s1 = \u_fsmc_bridge.u_access.bit_sync [4];
    wire        flushing   = \u_fsmc_bridge.u_fsmc_registers.flushing ,
        give = \u_fsmc_bridge.u_fsmc_registers.give ;
    wire        answering  = \u_fsmc_bridge.u_fsmc_registers.answering ,
        seen = \u_fsmc_bridge.u_fsmc_registers.seen ;
    wire        half_read  = \u_fsmc_bridge.u_fsmc_registers.half_read ,
        half_write = \u_fsmc_bridge.u_fsmc_registers.half_write ;
    wire        asked_high = \u_fsmc_bridge.u_fsmc_registers.asked_high ,
        read_given_up = \u_fsmc_bridge.u_fsmc_registers.given_up ;
    wire [1:0]  done_s =
        {\u_fsmc_bridge.u_fsmc_registers.u_done.bit_sync ,
         \u_fsmc_bridge.u_fsmc_registers.u_done.bit_meta };
    wire [31:0] kept   = \u_fsmc_bridge.u_fsmc_registers.word ;
    wire idle     = !flushing && !bus_valid && !give && !answering;
    wire done     = reads && nwait_n;
    wire writing  = (flushing || bus_valid) && bus_write;
    // the access that requested the transfer may still be in progress
    wire fetching = (flushing || bus_valid || give) && !bus_write && !read_given_up;

    // since: clocks since the strobe of the last write rose. by2: this write was to a register.
    // gone2: the last aborted access read a register.
    reg  [2:0] since = 3'd5;
    reg        by2 = 1'b0, gone2 = 1'b0;
    reg  [5:0] last = 6'd0;
    wire [2:0] since_n = wrote ? 3'd0 : clock && since != 3'd5 ? since + 3'd1 : since;
    wire       by2_n   = wrote ? was_ne2 : by2;
    wire [5:0] last_n  = wrote ? {was_beyond, was_a, was_d} : last;
    wire       gone2_n = gives_up ? was_reads : gone2 && !access;
    wire [2:0] rest_n  = wrote || gives_up ? 3'd0 : clock && rest != 3'd7 ? rest + 3'd1 : rest;
    wire [1:0] calm_n  = !access ||
        !nwait_n ? 2'd0 : was_access && clock && calm != 2'd2 ? calm + 2'd1 : calm;
    always @(posedge step)
        {since, by2, last, gone2} <= {since_n, by2_n, last_n, gone2_n};
    wire pending  = since_n < 3'd3; // fsmc_registers may not have received the write yet
    wire pending2 = pending && by2_n;
    wire last_low = !last_n[5] && !last_n[2];
    wire paired   = half_write && !last_n[5] && last_n[2] && bus_addr == {8'd0, last_n[4:3]};

    if (LATE == 0) begin : g_inductive
    always @* begin
        assert (past || rst);
        assert (rst ? resets <= 3'd2 : resets == 3'd2);
        if (rst)
            assert (!owed && !low_may && !low_sure && !half_may && !half_sure && !asked && !got &&
                    since == 3'd5 && !given_up && !gone2);
        if (rst && resets != 3'd0)
            assert (idle && !half_read && !half_write && turn == 4'd0);
        assert (!let_go || (was_access && was_nwait));
        assert (since <= 3'd5 && calm <= (let_go ? 2'd2 : 2'd0));
        assert (gone2 <= given_up);
        assert (!gone2_n || (!half_sure_n && !low_sure_n));
    end
    always @* if (up) begin
        // In each clock, the toggle of a write moves to the next flip-flop of cdc_pulse.
        case (since_n)
            3'd0:    assert (turn == 4'b1000 || turn == 4'b1001);
            3'd1:    assert (turn == 4'b0100);
            3'd2:    assert (turn == 4'b0010);
            3'd3:    assert (turn == 4'b0001);
            default: assert (turn == 4'b0000);
        endcase
        assert (since_n == 3'd5 || rest_n <= since_n);
        if (pending)
            assert ({taken[44:43], taken[40:0]} ==
                    {by2_n, !by2_n, 13'd0, last_n[5], 8'd0, last_n[4:2], 14'd0, last_n[1:0]});
        // fsmc_registers uses the copy of a write, which is stable until the next write.
        if (since_n == 3'd2 || (since_n != 3'd0 && !idle && bus_write))
            assert (copy == {taken[44:43], taken[40:0]});

        // fsmc_registers does only one of these at a time.
        assert (\u_fsmc_bridge.busy == !idle);
        assert ({2'd0, flushing} + {2'd0, bus_valid} + {2'd0, give} + {2'd0, answering} <= 3'd1);
        assert (!pending || idle);
        assert (idle || bus_addr[9:2] == 8'd0);
        assert (!(ne2_i && access && let_go) || nwait_n);

        // s0 and s1 are the two flip-flops that synchronise the strobe of a register read. s1
        // follows the pins two clocks later.
        assert (since_n != 3'd0 || (!s0 && !s1));
        assert (since_n != 3'd1 || !s1);
        assert (!done_s[0] || (s0 && s1));
        assert (!done_s[1] || s1);
        if (gone2_n)
            assert (rest_n == 3'd0 || (!s0 && (rest_n == 3'd1 || !s1)));
        else if (!reads) begin
            assert (answering || (!s0 && !s1));
            assert (!answering || (s0 == done_s[0] && s1 == |done_s));
        end else
            assert (!s1 || s0 || done_s[1]);
        assert (!seen || done_s[1] || !done_s[0]);
        assert (!read_given_up || done_s == 2'd0 || idle);
        assert (answering || (done_s == 2'd0 && !seen) || idle);
        assert (!idle || done_s == 2'd0);
        assert (!(give || answering) || !bus_write);
        assert (!done ||
                (answering && s0 && s1 && !read_given_up && done_s != 2'b10 &&
                 (!seen || done_s == 2'b11)));
        assert (!done || calm_n != 2'd2 || done_s[0]);

        // The read in progress is the read at the pins, or a read that was aborted a few clocks
        // ago.
        if (fetching && reads)
            assert (s0 && s1 && bus_addr == {8'd0, a_i[2:1]} && asked_high == a_i[0] &&
                    (give || !beyond_i));
        if (fetching && !reads) begin
            assert (gone2_n && rest_n <= 3'd2);
            if ((flushing && rest_n == 3'd0) || (bus_valid && s1))
                assert (asked_high || bus_addr != {8'd0, its} || half_may_n);
        end
        if (bus_valid && fetching && reads)
            assert (asked_n);

        if (flushing && !bus_write)
            assert (forgotten_n || (unread_n && !read_given_up));
        if (reads && !unread_n)
            assert (done || ((bus_valid || give) && fetching));
        if (gone2_n && (s0 || s1) && !forgotten_n)
            assert ((bus_valid && !bus_write) || (give && rest_n != 3'd0) ||
                    ((give || answering) && s1 && !read_given_up && (!seen || done_s[1]) &&
                     (!s0 || done_s != 2'b10)));

        // The stored high half belongs to the word that was read last.
        if (half_read) begin
            assert (!flushing && !bus_valid && !bus_write);
            assert (kept[31:16] == {14'd0, answer_n[3:2]} && bus_addr == {8'd0, answer_at_n});
            if (bus_addr == {8'd0, its} && !pending2)
                assert (half_may_n || (reads && !beyond_i && a_i == {its, 1'b0}));
        end
        if (give && fetching && reads) begin
            if (beyond_i)
                assert (kept == 32'd0);
            else begin
                assert (answer_at_n == a_i[2:1]);
                assert (a_i[0] ? kept[31:16] == {14'd0, answer_n[3:2]} :
                        kept[15:0] == {14'd0, answer_n[1:0]});
                if (a_i[2:1] == its)
                    assert ((got_n || (a_i[0] && half_may_n)) &&
                            (!got_n || !a_i[0] || !half_sure_n));
            end
        end
        if (((give && fetching) || done) && reads)
            assert (half_read == (!beyond_i && !a_i[0]) && bus_addr == {8'd0, a_i[2:1]});
        if (half_sure_n) begin
            assert (!flushing && !bus_valid && !pending2 && !(reads && got_n));
            assert ((half_read && bus_addr == {8'd0, its} && (idle || answering)) ||
                    (reads && !beyond_i && a_i == {its, 1'b1} &&
                     ((give && !read_given_up) || done)));
        end

        // The low half that was written last is stored until its high half is written. The write of
        // the high half transfers the word.
        assert (!half_write || idle);
        if (!pending2) begin
            assert (!half_write ||
                    (low_may_n && bus_wdata[15:0] == {14'd0, low_n} &&
                     bus_addr == {8'd0, low_at_n}));
            assert (!low_sure_n || half_write);
        end else if (last_low)
            assert (low_may_n && low_n == last_n[1:0] && low_at_n == last_n[4:3]);
        else begin
            assert (word_at_n == last_n[4:3] && word_n[3:2] == last_n[1:0] && !low_may_n);
            assert (!low_sure_n && (may_n || !sure_n));
            assert (!paired || (may_n && bus_wdata[15:0] == {14'd0, word_n[1:0]}));
            assert (!sure_n || paired);
        end
        assert (owed_n == ((pending2 && !last_low) || (flushing && bus_write)));
        if (writing)
            assert (bus_addr == {8'd0, word_at_n} &&
                    bus_wdata == {14'd0, word_n[3:2], 14'd0, word_n[1:0]} && (bus_valid || may_n));
    end
    end
