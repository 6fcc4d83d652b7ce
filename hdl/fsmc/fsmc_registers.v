// SPDX-License-Identifier: MIT
//
// fsmc_registers: reads and writes 32-bit words of the register bus in two 16-bit halves, low half
// first; each word is atomic.
//
// A read of the low half reads the word and stores its high half for the next read. A write of the
// low half is stored, and a write of the high half writes the word. A high half that is read alone
// is read again; written alone it is an error. Writes are posted: busy_o is high from the cycle
// after wr_i until the word has been written, and every other access waits for that. All memory
// writes are flushed before a transfer. expired_i ends the wait for a slave with an error; a memory
// that does not take the writes in time is reported, and the transfer continues.

`default_nettype none

module fsmc_registers (
    input  wire        clk_i,
    input  wire        rst_i,
    // writes: one cycle; address and data stay until the next
    input  wire        wr_i,
    input  wire [24:0] wr_addr_i, // halfword address
    input  wire [15:0] wr_data_i,
    // reads: held until the pin ends the access
    input  wire        reading_i,
    input  wire [24:0] rd_addr_i,
    input  wire        rd_high_async_i, // pins: the high half is being read
    input  wire        ne_n_async_i,    // pins: either one high ends the access
    input  wire        noe_n_async_i,
    output wire        rd_done_o, // rd_data_o is the data of this access; falls with the access
    output wire [15:0] rd_data_o,
    // time-out: the bridge counts while busy, from zero with each cycle of restart_o
    output wire        restart_o,
    input  wire        expired_i,
    // order with memory
    output wire        busy_o,
    output wire        flush_o,
    input  wire        idle_i,
    // errors, one cycle
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
    // At most one of these is active: flushing, until memory has taken all posted writes;
    // bus_valid_o, until the slave answers; answering, until the processor ends its read. Without
    // them, and without give, the module is idle.
    reg        flushing, answering;
    reg [31:0] word;       // word read last
    reg [15:0] low;        // low half written last
    // the high half of bus_addr_o's word is stored from a read; the low half from a write
    reg        half_read, half_write;
    reg        asked_high; // this read is of the high half, whatever the pins say now
    reg        given_up;   // the read has ended early; its answer is dropped
    reg        give, seen, done_ne, done_noe;
    wire       done_sync;

    wire idle     = !flushing && !bus_valid_o && !give && !answering;
    wire begins   = idle && (wr_i || reading_i);
    wire high     = wr_i ? wr_addr_i[0] : rd_addr_i[0];
    wire in_range = wr_i ? wr_addr_i[24:11] == 14'd0 : rd_addr_i[24:11] == 14'd0;
    wire [9:0] addr = wr_i ? wr_addr_i[10:1] : rd_addr_i[10:1];
    wire same     = in_range && addr == bus_addr_o;
    wire keep     = wr_i && !high && in_range;           // a low half to be written
    wire kept     = !wr_i && high && half_read && same;  // a stored high half
    wire wrong    = !in_range || (wr_i && !(half_write && same));
    wire transfer = begins && !keep && !kept && !wrong;
    wire at_once  = begins && !wr_i && (kept || wrong);  // a read without a transfer
    wire flushed  = flushing && (idle_i || expired_i);
    wire ends     = bus_valid_o && (bus_ready_i || expired_i);

    assign rd_data_o     = rd_high_async_i ? word[31:16] : word[15:0];
    assign busy_o        = !idle;
    assign restart_o     = idle || flushed;
    assign flush_o       = flushing;
    assign bus_wdata_o   = {wr_data_i, low};
    assign error_write_o = bus_write_o;

    // The clock sets these flip-flops and the pins clear them, because the next read may begin a
    // few nanoseconds later.
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
        // directly, not through `wrong`: a short path to 32 resets
        if (idle && reading_i && |rd_addr_i[24:11])
            word <= 32'd0;

        if (begins || flushed)
            flushing <= transfer;
        if (flushed || ends)
            bus_valid_o <= flushed;
        if (give || (answering && (given_up || (seen && !done_sync))))
            answering <= give;

        // A write while busy, from a master that ignores NWAIT, is lost and reported: the word in
        // progress may get its data.
        error_o <= (begins && !keep && !kept && wrong) || (ends && (bus_error_i || !bus_ready_i)) ||
                   (wr_i && !idle);
        error_memory_o <= flushing && expired_i && !idle_i;

        if (rst_i) begin
            flushing    <= 1'b0;
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
    // An access makes at most one transfer, of a whole word.
    // A hung slave is abandoned as soon as expired_i is high, which bus_rules allows with PATIENCE
    // = 1.
    bus_rules #(.MASTER(1), .PATIENCE(1)) u_bus_rules (
        .clk_i(clk_i), .rst_i(rst_i), .valid_i(bus_valid_o), .write_i(bus_write_o),
        .addr_i(bus_addr_o), .wdata_i(bus_wdata_o), .ready_i(bus_ready_i), .rdata_i(bus_rdata_i),
        .error_i(bus_error_i)
    );
    reg        past = 1'b0;
    reg [3:0]  patience;  // time-out count, shorter than in the bridge
    reg [4:0]  stuck;     // clocks of this access without an answer
    reg [31:0] last_read; // the last word from the bus
    reg [15:0] last_low;  // low half written last
    reg        low_word;  // the low half of bus_addr_o's word was the last write
    reg        low_read;  // the access begun last reads a low half
    reg        was_busy = 1'b0;
    reg [40:0] write_was;
    always @* begin
        // NWAIT holds back the next write and its data until the previous one is done.
        assume (!(busy_o && wr_i));
        assume (!(was_busy && busy_o) || write_was == {wr_addr_i, wr_data_i});
        // Time-outs as the bridge counts them.
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
        if (begins)
            low_read <= !wr_i && !rd_addr_i[0];

        if (past && !rst_i) begin
            // An access makes at most one transfer at a time, and no transfer happens without an
            // access.
            assert ({2'd0, flushing} + {2'd0, bus_valid_o} + {2'd0, give} +
                    {2'd0, answering} <= 3'd1);
            if (bus_valid_o && !$past(bus_valid_o))
                assert ($past(flushing));
            if (flushing && !$past(flushing))
                assert ($past(idle && (wr_i || reading_i)));
            // Words are atomic: a stored high half belongs to the word read last, and a written
            // word has the low half of the previous write.
            assert (!half_read || (word == last_read && low_read));
            assert (!half_read || $past(half_read) || $past(reading_i));
            assert (half_write == low_word);
            assert (idle || !half_write);
            assert (!flushing && !bus_valid_o || !half_read);
            assert (!half_write || low == last_low);
            if ((flushing || bus_valid_o) && bus_write_o)
                assert (low == last_low);
            // Waiting ends after two time-outs and the steps between them.
            assert (!flushing || stuck <= patience);
            assert (!bus_valid_o || stuck <= patience + 5'd9);
            assert (stuck <= 5'd18);
            // Memory writes are flushed first, unless the memory hangs.
            if (bus_valid_o && !$past(bus_valid_o))
                assert ($past(idle_i) || $past(expired_i));
            // An answer goes only to the access that requested it, and is withdrawn with either
            // pin.
            assert (!done || !(ne_n_async_i || noe_n_async_i));
            assert (!$past(given_up && !begins) || !(done && !$past(done)));
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
