// SPDX-License-Identifier: MIT
//
// fsmc_registers: transfers 32-bit words of the register bus in two 16-bit halves, low half first.
// Each word is atomic.
//
// A read of the low half transfers the word, and stores its high half for the next read. A write of
// the low half is only stored; the write of the high half that follows transfers the word. If a
// high half is read without its low half, the word is transferred again. A high half that is
// written without its low half is an error. Writes are posted: busy_o is high from the cycle after
// wr_i until the word has been written, and every other access waits until busy_o is low. All
// memory writes are flushed before a transfer. expired_i ends the wait for a slave, and the access
// then ends with an error. If the memory does not accept the writes in time, an error is reported,
// and the transfer continues.

`default_nettype none

module fsmc_registers (
    input  wire        clk_i,
    input  wire        rst_i,
    // writes: wr_i is high for one cycle; address and data are stable until the next write
    input  wire        wr_i,
    input  wire [24:0] wr_addr_i, // halfword address
    input  wire [15:0] wr_data_i,
    // reads: reading_i is high until the access ends at the pins
    input  wire        reading_i,
    input  wire [24:0] rd_addr_i,
    input  wire        rd_high_async_i, // pin: the processor reads the high half
    input  wire        ne_n_async_i,    // pins: the access ends when one of them is high
    input  wire        noe_n_async_i,
    // goes high when rd_data_o is the data of this access, and stays high until the access ends
    output wire        rd_done_o,
    output wire [15:0] rd_data_o,
    // time-out: the bridge counts clocks while busy_o is high, and starts from zero when restart_o
    // is high
    output wire        restart_o,
    input  wire        expired_i,
    // order of registers and memory: flush_o requests that all memory writes are completed; idle_i
    // is high when all of them are completed
    output wire        busy_o,
    output wire        flush_o,
    input  wire        idle_i,
    // errors: high for one cycle
    output reg         error_o,
    output reg         error_memory_o,
    output wire        error_write_o,
    // register bus
    output reg         bus_valid_o,
    output reg         bus_write_o,
    output reg  [9:0]  bus_addr_o,
    output wire [31:0] bus_wdata_o,
    input  wire        bus_ready_i,
    input  wire [31:0] bus_rdata_i,
    input  wire        bus_error_i
);
    // At most one of these four flags is high. flushing: the memory has not yet taken all posted
    // writes. bus_valid_o: the slave has not answered yet. give: for one clock, the answer is
    // ready. answering: the processor has not ended its read yet. busy is the OR of the four; it is
    // a separate flip-flop, because NWAIT depends on it.
    reg        flushing, answering, busy;
    reg [31:0] word;       // word that was read last
    reg [15:0] low;        // low half that was written last
    // half_read: `word` contains the high half of the word at bus_addr_o, for the next read.
    // half_write: `low` contains the low half of this word, for the next write.
    reg        half_read, half_write;
    // the current transfer was requested by a read of the high half; the pins may have changed
    // since
    reg        asked_high;
    reg        given_up;   // the processor has ended the read early, so the answer is discarded
    reg        give, seen, done_ne, done_noe;
    wire       done_sync;

    wire idle     = !busy;
    wire begins   = idle && (wr_i || reading_i);
    wire high     = wr_i ? wr_addr_i[0] : rd_addr_i[0];
    wire in_range = wr_i ? wr_addr_i[24:11] == 14'd0 : rd_addr_i[24:11] == 14'd0;
    wire [9:0] addr = wr_i ? wr_addr_i[10:1] : rd_addr_i[10:1];
    wire same     = in_range && addr == bus_addr_o;
    // this access writes a low half, which is only stored
    wire keep     = wr_i && !high && in_range;
    // this access reads the high half, which `word` already contains
    wire kept     = !wr_i && high && half_read && same;
    wire wrong    = !in_range || (wr_i && !(half_write && same));
    wire transfer = begins && !keep && !kept && !wrong;
    wire at_once  = begins && !wr_i && (kept || wrong);  // this read is answered without a transfer
    wire flushed  = flushing && (idle_i || expired_i);
    wire ends     = bus_valid_o && (bus_ready_i || expired_i);
    wire forgets  = answering && (given_up || (seen && !done_sync));

    assign rd_data_o     = rd_high_async_i ? word[31:16] : word[15:0];
    assign busy_o        = busy;
    assign restart_o     = idle || flushed;
    assign flush_o       = flushing;
    assign bus_wdata_o   = {wr_data_i, low};
    assign error_write_o = bus_write_o;

    // The clock sets these flip-flops. The pins clear them asynchronously, because the next read
    // may begin a few nanoseconds later.
    always @(posedge clk_i or posedge ne_n_async_i)
        if (ne_n_async_i)
            done_ne <= 1'b0;
        else if (give && !given_up)
            done_ne <= 1'b1;
    always @(posedge clk_i or posedge noe_n_async_i)
        if (noe_n_async_i)
            done_noe <= 1'b0;
        else if (give && !given_up)
            done_noe <= 1'b1;
    wire done = done_ne && done_noe;
    assign rd_done_o = done;
    cdc_bit u_done (.clk_i(clk_i), .bit_async_i(done), .bit_sync_o(done_sync));

    always @(posedge clk_i) begin
        seen   <= !idle && (seen || done_sync);
        give   <= at_once || (ends && !bus_write_o);

        if (begins) begin
            bus_addr_o  <= addr;
            bus_write_o <= wr_i;
            half_write  <= keep;
            asked_high  <= high;
        end
        if (begins || ends)
            half_read <= ends && !bus_write_o && !asked_high && !given_up && reading_i;
        given_up <= !begins && (given_up || !reading_i);

        if (begins && keep)
            low <= wr_data_i;
        if (ends && !bus_write_o)
            word <= bus_rdata_i;
        // Repeats a part of `wrong`, because the path to the resets of 32 flip-flops must be short.
        if (idle && reading_i && |rd_addr_i[24:11])
            word <= 32'd0;

        if (begins || flushed)
            flushing <= transfer;
        if (flushed || ends)
            bus_valid_o <= flushed;
        if (give || forgets)
            answering <= give;
        if (begins || forgets || (ends && bus_write_o))
            busy <= transfer || at_once;

        // If the processor ignores NWAIT and writes while busy_o is high, the write is lost, and an
        // error is reported. The data of this write may then be part of the word in progress.
        error_o <= (begins && !keep && !kept && wrong) || (ends && (bus_error_i || !bus_ready_i)) ||
                   (wr_i && !idle);
        error_memory_o <= flushing && expired_i && !idle_i;

        if (rst_i) begin
            flushing    <= 1'b0;
            busy        <= 1'b0;
            bus_valid_o <= 1'b0;
            answering   <= 1'b0;
            give        <= 1'b0;
            half_read   <= 1'b0;
            half_write  <= 1'b0;
            error_o     <= 1'b0;
            error_memory_o <= 1'b0;
        end
    end

`ifdef FORMAL
    // Proves that an access makes at most one transfer, of a whole word. A slave that does not
    // answer is abandoned as soon as expired_i is high, which bus_rules allows if PATIENCE is 1.
    bus_rules #(.MASTER(1), .PATIENCE(1)) u_bus_rules (
        .clk_i(clk_i), .rst_i(rst_i), .valid_i(bus_valid_o), .write_i(bus_write_o),
        .addr_i(bus_addr_o), .wdata_i(bus_wdata_o), .ready_i(bus_ready_i), .rdata_i(bus_rdata_i),
        .error_i(bus_error_i)
    );
    reg        past = 1'b0;
    reg [3:0]  patience;  // count of the time-out, which is shorter than in the bridge
    reg [4:0]  stuck;     // clocks for which the current access has waited for an answer
    reg [31:0] last_read; // word that the bus returned last
    reg [15:0] last_low;  // low half that was written last
    reg        low_word;  // the last access was a write of the low half of the word at bus_addr_o
    reg        low_read;  // the last access that began was a read of a low half
    reg        beyond;    // the last access that began was a read beyond the slots
    reg        held;      // since the last access began, reading_i has been high
    reg        was_busy = 1'b0;
    reg [40:0] write_was;
    always @* begin
        // NWAIT delays the next write until the previous write is finished. Until then, address and
        // data of the previous write do not change.
        assume (!(busy_o && wr_i));
        assume (!(was_busy && busy_o) || write_was == {wr_addr_i, wr_data_i});
        // The time-out is counted as in the bridge.
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
        low_word <= !rst_i &&
            (begins ? wr_i && !wr_addr_i[0] && wr_addr_i[24:11] == 14'd0 : low_word);
        if (begins) begin
            low_read <= !wr_i && !rd_addr_i[0];
            beyond   <= !wr_i && rd_addr_i[24:11] != 14'd0;
        end
        held <= begins || (held && reading_i);

        if (past && !rst_i) begin
            // An access makes at most one transfer at a time. A transfer happens only for an
            // access.
            assert ({2'd0, flushing} + {2'd0, bus_valid_o} + {2'd0, give} +
                    {2'd0, answering} == {2'd0, busy});
            if (bus_valid_o && !$past(bus_valid_o))
                assert ($past(flushing));
            if (flushing && !$past(flushing))
                assert ($past(idle && (wr_i || reading_i)));
            // The answer is the word that the bus has returned. A read beyond the slots returns 0.
            if (give || answering)
                assert (word == (beyond ? 32'd0 : last_read));
            // Words are atomic. A stored high half belongs to the word that was read last. A
            // written word consists of the low half that was written just before, and of the high
            // half that is written now.
            assert (!half_read || (word == last_read && low_read));
            assert (!half_read || $past(half_read) || $past(reading_i));
            assert (half_write == low_word);
            assert (idle || !half_write);
            assert (!flushing && !bus_valid_o || !half_read);
            assert (!half_write || low == last_low);
            if ((flushing || bus_valid_o) && bus_write_o)
                assert (low == last_low);
            // An access waits for at most two time-outs, plus the clocks between them.
            assert (!flushing || stuck <= patience);
            assert (!bus_valid_o || stuck <= patience + 5'd9);
            assert (stuck <= 5'd18);
            // Memory writes are flushed before a transfer, unless the memory does not answer.
            if (bus_valid_o && !$past(bus_valid_o))
                assert ($past(idle_i) || $past(expired_i));
            // An answer is given only to the access that requested it, and ends when one of the two
            // pins rises.
            assert (!done || !(ne_n_async_i || noe_n_async_i));
            assert (!$past(given_up && !begins) || !(done && !$past(done)));
            assert ($past(held || rst_i) || !(done && !$past(done)));
            // Errors: an access beyond the slots, a high half written without its low half, and a
            // transfer that the slave ends with an error or does not answer.
            assert (error_o == $past(!rst_i &&
                ((begins && (!in_range || (wr_i && high && !(low_word && same)))) ||
                 (ends && (bus_error_i || !bus_ready_i)))));
            assert (error_memory_o == $past(!rst_i && flushing && expired_i && !idle_i));
        end
        cover (past && bus_valid_o && bus_write_o && bus_ready_i);
        cover (past && done && rd_addr_i[0] && $past(half_read, 3));
        cover (past && error_o && $past(expired_i));
        cover (past && error_memory_o);
    end
`endif
`ifdef COVER_POINTS
    word_read: cover property (@(posedge clk_i) ends && !bus_write_o && bus_ready_i);
    word_written: cover property (@(posedge clk_i) ends && bus_write_o && bus_ready_i);
    high_half_kept: cover property (@(posedge clk_i) begins && kept);
    high_half_written_alone: cover property (@(posedge clk_i) begins && wr_i && high && in_range &&
                                             !(half_write && same));
    beyond_the_slots: cover property (@(posedge clk_i) begins && !in_range);
    slave_hangs: cover property (@(posedge clk_i) bus_valid_o && expired_i && !bus_ready_i);
    memory_hangs_before_transfer: cover property (@(posedge clk_i) flushing && expired_i &&
            !idle_i);
    read_given_up: cover property (@(posedge clk_i) ends && !bus_write_o && given_up);
    write_while_busy: cover property (@(posedge clk_i) wr_i && !idle);
`endif
endmodule
