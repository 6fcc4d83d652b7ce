// SPDX-License-Identifier: MIT
//
// fsmc_words_proof: 32-bit register words are atomic at the pins of fsmc_bridge; only for the prover (in fsmc_bridge_proof).
//
// These hold for any sequence of accesses, completed or given up at any moment, to registers, beyond them and to memory:
// - A word written to the bus is that of the processor's last two completed register accesses: low half, then high half of
//   the same word; so is its address. An access that was given up writes nothing.
// - A write of a high half, or beyond the slots, yields exactly one transfer or one report of an error, before the next
//   register access goes on: a transfer if its low half came just before, with not even the attempt of a read between; an
//   error if it did not. A write of a low half yields neither.
// - A read gives half of the word that the bus gave last, and that word is of the read's address. Its transfer began in this
//   access or, for a high half, in the read of its low half just before. If nothing at all was between those two it is always
//   the latter: both halves are of one transfer. Otherwise reads that were given up may lie between; one of those may have
//   been that of the low half. A read beyond the slots gives 0.
// - Each read, also one that was given up, makes one transfer at most, and no transfer comes without a read.
//
// The second half relates the harness's notes to the bridge's registers: with it all assertions together are inductive
// over two steps, so runs of any length are proven.

`default_nettype none

`ifdef FORMAL
module fsmc_words_proof #(
    parameter LATE = 0 // 1: synchronisers may be late; the second half is left out
) (
    input wire        past_i,     // this is not the first step
    input wire        rst_i,
    input wire [2:0]  resets_i,   // clocks of reset, 2 at most
    // pins in this step and in the one before, and the harness's notes on them (fsmc_bridge_proof)
    input wire        clock_i,
    input wire        ne2_i,
    input wire        nwe_n_i,
    input wire        noe_n_i,
    input wire        access_i,
    input wire        was_access_i,
    input wire        beyond_i,
    input wire [2:0]  a_i,
    input wire        was_ne2_i,
    input wire        was_noe_i,
    input wire        was_nwe_i,
    input wire        was_beyond_i,
    input wire [2:0]  was_a_i,
    input wire [1:0]  was_d_i,
    input wire        selected_i,
    input wire        wrote_i,
    input wire        gives_up_i,
    input wire        let_go_i,
    input wire [1:0]  calm_i,
    input wire [2:0]  rest_i,
    input wire        given_up_i,
    input wire        nwait_n_i,
    input wire        was_nwait_n_i,
    input wire [15:0] d_i,        // data that the processor reads
    // register bus
    input wire        valid_i,
    input wire        write_i,
    input wire [9:0]  addr_i,
    input wire [31:0] wdata_i,
    input wire [31:0] rdata_i,
    input wire        error_i,    // access_error, but not one of memory
    input wire        error_write_i,
    input wire [9:0]  error_addr_i,
    // inside the bridge
    input wire [5:0]  async_i,
    input wire [9:0]  registers_i,
    input wire [31:0] word_i,
    input wire [44:0] taken_i,    // registered by NWE's edge: NE2, NE1, byte lanes, address, data
    input wire [42:0] copy_i     // copy of taken_i in clk_i: NE2, NE1, address, data
);
    (* gclk *) wire step;
    wire up = resets_i > 3'd1;
    function [31:0] wide; // widens a word of two bits a half, as the harness drives them
        input [3:0] word;
        wide = {14'd0, word[3:2], 14'd0, word[1:0]};
    endfunction

    reg        was_valid = 1'b0, was_write = 1'b0;
    reg [1:0]  was_addr = 2'd0;
    reg [31:0] was_rdata = 32'd0;
    always @(posedge step)
        {was_valid, was_write, was_addr, was_rdata} <= {valid_i, write_i, addr_i[1:0], rdata_i};
    wire reads     = access_i && ne2_i && !noe_n_i;
    wire was_reads = was_access_i && was_ne2_i && !was_noe_i;
    wire wrote     = wrote_i && was_ne2_i;
    wire read_done = was_reads && !selected_i && !gives_up_i;
    wire begins    = valid_i && !was_valid;
    wire ends      = was_valid && !valid_i;
    wire reports   = clock_i && error_i && error_write_i && !(ends && was_write); // no transfer
    // NWE rises before NE (RM0033), or after it where the access is given up; never in the same step.
    always @* assume (!(was_access_i && !selected_i && !was_nwe_i) || !nwe_n_i);

    // ---- Writes
    reg       low_may = 1'b0, low_sure = 1'b0; // the bridge holds the low half written last: perhaps, for certain
    reg [1:0] low_at = 2'd0, low = 2'd0;
    reg       owed = 1'b0, may = 1'b0, sure = 1'b0; // a transfer or an error is due; it may be, must be a transfer
    reg [1:0] word_at = 2'd0;
    reg [3:0] word = 4'd0;
    wire keeps    = !was_beyond_i && !was_a_i[0];
    wire pair     = !was_beyond_i && was_a_i[0] && low_may && low_at == was_a_i[2:1];
    wire low_may_n  = wrote ? keeps : low_may && !read_done;
    wire low_sure_n = wrote ? keeps : low_sure && !reads;
    wire [1:0] low_at_n = wrote ? was_a_i[2:1] : low_at;
    wire [1:0] low_n    = wrote ? was_d_i : low;
    wire owed_n   = wrote ? !keeps : owed && !(begins && write_i) && !reports;
    wire may_n    = wrote ? pair : may;
    wire sure_n   = wrote ? pair && low_sure : sure;
    wire [1:0] word_at_n = wrote ? was_a_i[2:1] : word_at;
    wire [3:0] word_n    = wrote ? {was_d_i, low} : word;
    always @(posedge step) begin
        {low_may, low_sure, low_at, low} <= {low_may_n, low_sure_n, low_at_n, low_n};
        {owed, may, sure, word_at, word} <= {owed_n, may_n, sure_n, word_at_n, word_n};
    end
    always @* if (up) begin
        if (begins && write_i)
            assert (owed && may);
        if (valid_i && write_i)
            assert (addr_i == {8'd0, word_at} && wdata_i == wide(word));
        if (reports)
            assert (owed && !sure && error_addr_i == {8'd0, word_at});
        if (access_i && ne2_i && nwait_n_i)
            assert (!owed_n);
        cover (begins && write_i && sure && word == 4'b0110);
        cover (begins && write_i && !sure);
        cover (reports && may);
    end

    // ---- Reads: transfers
    reg  unread = 1'b0, forgotten = 1'b0; // a transfer has yet to begin for this access, for one that was given up
    wire fetches     = begins && !write_i;
    wire unread_n    = reads && (!was_reads || (unread && !(fetches && !forgotten)));
    wire forgotten_n = (forgotten && !fetches) || (gives_up_i && was_reads && unread && !(fetches && !forgotten));
    always @(posedge step)
        {unread, forgotten} <= {unread_n, forgotten_n};
    always @* if (up && fetches)
        assert (unread || forgotten);

    // ---- Reads: data, of any word `its`
    (* anyconst *) reg [1:0] its;
    reg       asked = 1'b0, got = 1'b0;          // a transfer has begun in this access; it has ended
    reg       half_may = 1'b0, half_sure = 1'b0; // the high half of `its` is there: perhaps, for certain
    reg [1:0] answer_at = 2'd0;
    reg [3:0] answer = 4'd0;
    wire answered = ends && !was_write;
    wire mine     = !was_beyond_i && was_a_i == {its, 1'b0}; // the access that ends is one to the low half of `its`
    wire asked_n  = access_i && (asked || (fetches && reads));
    wire got_n    = access_i && (got || (answered && was_reads && asked && was_addr == a_i[2:1]));
    wire half_may_n  = wrote ? 1'b0 : read_done ? mine : half_may || (gives_up_i && was_reads && mine);
    wire half_sure_n = wrote ? 1'b0 : read_done ? mine :
                       half_sure && !(reads && (beyond_i || a_i != {its, 1'b1})) && !(gives_up_i && was_reads);
    wire [1:0] answer_at_n = answered ? was_addr : answer_at;
    wire [3:0] answer_n = answered ? {was_rdata[17:16], was_rdata[1:0]} : answer;
    always @(posedge step) begin
        {asked, got, half_may, half_sure} <= {asked_n, got_n, half_may_n, half_sure_n};
        {answer_at, answer} <= {answer_at_n, answer_n};
    end
    always @* if (up && reads && nwait_n_i) begin
        if (beyond_i)
            assert (d_i == 16'd0);
        else begin
            assert (answer_at_n == a_i[2:1]);
            assert (d_i == {14'd0, a_i[0] ? answer_n[3:2] : answer_n[1:0]});
            if (a_i[2:1] == its) begin
                assert (got_n || (a_i[0] && half_may));
                assert (!got_n || !a_i[0] || !half_sure);
            end
        end
        cover (a_i == {its, 1'b1} && !beyond_i && half_sure && d_i == 16'd2);
        cover (a_i == {its, 1'b1} && !beyond_i && half_may && got_n && d_i == 16'd1);
        cover (a_i == {its, 1'b1} && !beyond_i && half_may && !half_sure && !got_n);
    end

    // ---- The harness's notes agree with the bridge's registers, all of this step
    wire [3:0]  turn; // a write's toggle on its way through cdc_pulse
    wire        s0, s1, flushing, give, answering, half_read, half_write, asked_high, given_up, seen;
    wire [1:0]  done_s;
    assign {turn, s0, s1} = async_i;
    assign {flushing, give, answering, half_read, half_write, asked_high, given_up, done_s, seen} = registers_i;
    wire idle     = !flushing && !valid_i && !give && !answering;
    wire done     = reads && nwait_n_i;
    wire writing  = (flushing || valid_i) && write_i;
    wire fetching = (flushing || valid_i || give) && !write_i && !given_up; // the access may still be under way

    // `since` counts clocks since a write's strobe rose, by2 is its bank; gone2: the access given up last read a register.
    reg  [2:0] since = 3'd5;
    reg        by2 = 1'b0, gone2 = 1'b0;
    reg  [5:0] last = 6'd0;
    wire [2:0] since_n = wrote_i ? 3'd0 : clock_i && since != 3'd5 ? since + 3'd1 : since;
    wire       by2_n   = wrote_i ? was_ne2_i : by2;
    wire [5:0] last_n  = wrote_i ? {was_beyond_i, was_a_i, was_d_i} : last;
    wire       gone2_n = gives_up_i ? was_reads : gone2 && !access_i;
    wire [2:0] rest    = wrote_i || gives_up_i ? 3'd0 : clock_i && rest_i != 3'd7 ? rest_i + 3'd1 : rest_i;
    wire [1:0] calm    = !access_i || !nwait_n_i ? 2'd0 : was_access_i && clock_i && calm_i != 2'd2 ? calm_i + 2'd1 : calm_i;
    always @(posedge step)
        {since, by2, last, gone2} <= {since_n, by2_n, last_n, gone2_n};
    wire pending  = since_n < 3'd3; // the write is not yet known to fsmc_registers
    wire pending2 = pending && by2_n;
    wire last_low = !last_n[5] && !last_n[2];
    wire paired   = half_write && !last_n[5] && last_n[2] && addr_i == {8'd0, last_n[4:3]};

    generate if (LATE == 0) begin : g_inductive
    always @* begin
        assert (past_i || rst_i);
        assert (rst_i ? resets_i <= 3'd2 : resets_i == 3'd2);
        if (rst_i)
            assert (!owed && !low_may && !low_sure && !half_may && !half_sure && !asked && !got && since == 3'd5 && !given_up_i && !gone2);
        if (rst_i && resets_i != 3'd0)
            assert (idle && !half_read && !half_write && turn == 4'd0);
        assert (!let_go_i || (was_access_i && was_nwait_n_i));
        assert (since <= 3'd5 && calm_i <= (let_go_i ? 2'd2 : 2'd0));
        assert (gone2 <= given_up_i);
        assert (!gone2_n || (!half_sure_n && !low_sure_n));
    end
    always @* if (up) begin
        // A write's toggle moves through fsmc_async by one flip-flop a clock.
        case (since_n)
            3'd0:    assert (turn == 4'b1000 || turn == 4'b1001);
            3'd1:    assert (turn == 4'b0100);
            3'd2:    assert (turn == 4'b0010);
            3'd3:    assert (turn == 4'b0001);
            default: assert (turn == 4'b0000);
        endcase
        assert (since_n == 3'd5 || rest <= since_n);
        if (pending)
            assert ({taken_i[44:43], taken_i[40:0]} == {by2_n, !by2_n, 13'd0, last_n[5], 8'd0, last_n[4:2], 14'd0, last_n[1:0]});
        // The copy of a write stays for fsmc_registers until the next write.
        if (since_n == 3'd2 || (since_n != 3'd0 && !idle && write_i))
            assert (copy_i == {taken_i[44:43], taken_i[40:0]});

        // fsmc_registers does one thing at a time.
        assert ({2'd0, flushing} + {2'd0, valid_i} + {2'd0, give} + {2'd0, answering} <= 3'd1);
        assert (!pending || idle);
        assert (idle || addr_i[9:2] == 8'd0);
        assert (!(ne2_i && access_i && let_go_i) || nwait_n_i);

        // The synchronised strobe of a register read, s0 and s1, follows the pins two clocks late.
        assert (since_n != 3'd0 || (!s0 && !s1));
        assert (since_n != 3'd1 || !s1);
        assert (!done_s[0] || (s0 && s1));
        assert (!done_s[1] || s1);
        if (gone2_n)
            assert (rest == 3'd0 || (!s0 && (rest == 3'd1 || !s1)));
        else if (!reads) begin
            assert (answering || (!s0 && !s1));
            assert (!answering || (s0 == done_s[0] && s1 == |done_s));
        end else
            assert (!s1 || s0 || done_s[1]);
        assert (!seen || done_s[1] || !done_s[0]);
        assert (!given_up || done_s == 2'd0 || idle);
        assert (answering || (done_s == 2'd0 && !seen) || idle);
        assert (!idle || done_s == 2'd0);
        assert (!(give || answering) || !write_i);
        assert (!done || (answering && s0 && s1 && !given_up && done_s != 2'b10 && (!seen || done_s == 2'b11)));
        assert (!done || calm != 2'd2 || done_s[0]);

        // The read in progress is that of the pins, or was given up just now.
        if (fetching && reads)
            assert (s0 && s1 && addr_i == {8'd0, a_i[2:1]} && asked_high == a_i[0] && (give || !beyond_i));
        if (fetching && !reads) begin
            assert (gone2_n && rest <= 3'd2);
            if ((flushing && rest == 3'd0) || (valid_i && s1))
                assert (asked_high || addr_i != {8'd0, its} || half_may_n);
        end
        if (valid_i && fetching && reads)
            assert (asked_n);

        if (flushing && !write_i)
            assert (forgotten_n || (unread_n && !given_up));
        if (reads && !unread_n)
            assert (done || ((valid_i || give) && fetching));
        if (gone2_n && (s0 || s1) && !forgotten_n)
            assert ((valid_i && !write_i) || (give && rest != 3'd0) ||
                    ((give || answering) && s1 && !given_up && (!seen || done_s[1]) && (!s0 || done_s != 2'b10)));

        // The word that is kept is the one read last.
        if (half_read) begin
            assert (!flushing && !valid_i && !write_i);
            assert (word_i[31:16] == {14'd0, answer_n[3:2]} && addr_i == {8'd0, answer_at_n});
            if (addr_i == {8'd0, its} && !pending2)
                assert (half_may_n || (reads && !beyond_i && a_i == {its, 1'b0}));
        end
        if (give && fetching && reads) begin
            if (beyond_i)
                assert (word_i == 32'd0);
            else begin
                assert (answer_at_n == a_i[2:1]);
                assert (a_i[0] ? word_i[31:16] == {14'd0, answer_n[3:2]} : word_i[15:0] == {14'd0, answer_n[1:0]});
                if (a_i[2:1] == its)
                    assert ((got_n || (a_i[0] && half_may_n)) && (!got_n || !a_i[0] || !half_sure_n));
            end
        end
        if (((give && fetching) || done) && reads)
            assert (half_read == (!beyond_i && !a_i[0]) && addr_i == {8'd0, a_i[2:1]});
        if (half_sure_n) begin
            assert (!flushing && !valid_i && !pending2 && !(reads && got_n));
            assert ((half_read && addr_i == {8'd0, its} && (idle || answering)) ||
                    (reads && !beyond_i && a_i == {its, 1'b1} && ((give && !given_up) || done)));
        end

        // The low half written last is kept for the write of its high half, which is a transfer only then.
        assert (!half_write || idle);
        if (!pending2) begin
            assert (!half_write || (low_may_n && wdata_i[15:0] == {14'd0, low_n} && addr_i == {8'd0, low_at_n}));
            assert (!low_sure_n || half_write);
        end else if (last_low)
            assert (low_may_n && low_n == last_n[1:0] && low_at_n == last_n[4:3]);
        else begin
            assert (word_at_n == last_n[4:3] && word_n[3:2] == last_n[1:0] && !low_may_n);
            assert (!low_sure_n && (may_n || !sure_n));
            assert (!paired || (may_n && wdata_i[15:0] == {14'd0, word_n[1:0]}));
            assert (!sure_n || paired);
        end
        assert (owed_n == ((pending2 && !last_low) || (flushing && write_i)));
        if (writing)
            assert (addr_i == {8'd0, word_at_n} && wdata_i == wide(word_n) && (valid_i || may_n));
    end
    end endgenerate
endmodule
`endif
