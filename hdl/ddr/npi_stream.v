// SPDX-License-Identifier: MIT
//
// npi_stream: converts a memory port (docs/memory.md) to two streams of 64-bit words. One stream
// reads a buffer in order; the other writes a buffer in order, in bursts of 64 bytes. The module
// reads ahead as far as the port's FIFO allows.
//
// read_start_i starts to read a buffer; it is allowed only while read_idle_o is high. valid/take
// delivers read_words_i words. The remaining words of the last burst, and all words after
// read_stop_i, are discarded. write_start_i starts to write a buffer; it is allowed only while
// write_idle_o is high. valid/ready accepts the words. write_flush_i, high for one clock without
// valid, fills the current burst with words that have no byte enables. write_idle_o is high when
// all accepted words are acknowledged; every later request of any port then sees them in memory.

`default_nettype none

module npi_stream #(
    parameter ADDR_BITS = 32, // width of a byte address, 7..32
    parameter WORD_BITS = 24  // width of the word count of a read, 4..32
) (
    `include "memory_ports.vh"
    input  wire                 clk_i,
    input  wire                 rst_i,
    // read stream
    input  wire                 read_start_i,
    input  wire [ADDR_BITS-1:6] read_base_i,
    input  wire [WORD_BITS-1:0] read_words_i,
    input  wire                 read_stop_i,
    output wire                 read_valid_o,
    output wire [63:0]          read_data_o,
    input  wire                 read_take_i,
    output reg                  read_idle_o,
    // write stream
    input  wire                 write_start_i,
    input  wire [ADDR_BITS-1:6] write_base_i,
    input  wire                 write_valid_i,
    input  wire [63:0]          write_data_i,
    input  wire [7:0]           write_be_i,
    output wire                 write_ready_o,
    input  wire                 write_flush_i,
    output reg                  write_idle_o
);
    assign npi_rmw_o      = 1'b0;
    assign npi_wr_flush_o = 1'b0;
    assign npi_rd_flush_o = 1'b0;

    localparam [5:0] BURST = 6'd8, FIFO = 6'd32; // words
    localparam [3:0] SIZE_64_BYTES = 4'd3;

    reg                 request, request_read; // a request is waiting for its acknowledgement
    reg [ADDR_BITS-1:6] read_addr, write_addr; // addresses of the next bursts
    reg [WORD_BITS-3:0] to_ask;                // number of bursts to request
    reg [WORD_BITS-1:0] to_give;               // number of words to deliver to the core
    // number of words that were requested and have not been popped
    reg [5:0]           outstanding;
    reg [2:0]           filled;                // number of words in the current burst
    // number of bursts that were pushed and have not been acknowledged, at most 4
    reg [2:0]           bursts;
    reg                 padding;

    wire acked_read  = npi_addr_ack_i && request_read;
    wire acked_write = npi_addr_ack_i && !request_read;

    // ---- read ----
    wire asks = to_ask != {(WORD_BITS - 2){1'b0}};
    wire ask  = asks && outstanding <= FIFO - BURST;

    assign read_valid_o = !npi_rd_empty_i && to_give != {WORD_BITS{1'b0}};
    assign read_data_o  = npi_rd_data_i;
    assign npi_rd_pop_o = !npi_rd_empty_i && (read_take_i || to_give == {WORD_BITS{1'b0}});
    wire popped_burst   = npi_rd_pop_o && outstanding[2:0] == 3'd0;

    // Both counters either load their value or count down. The multiplexer is in front of the carry
    // chain, so that a bit takes only one LUT. The sums are written as m - ~n, which is m + n + 1,
    // because Yosys connects the minuend to the chain without a LUT. `partial` is the carry for a
    // last burst of fewer than eight words.
    wire down    = !read_start_i;
    wire partial = !down && read_words_i[2:0] != 3'd0;
    wire [WORD_BITS-2:0] ask_next = {{(WORD_BITS - 2){down}}, partial} -
        ~{down ? to_ask : {1'b0, read_words_i[WORD_BITS-1:3]}, 1'b0};
    wire [WORD_BITS-1:0] give_next = {{(WORD_BITS - 1){1'b1}}, !down} -
        ~(down ? to_give : read_words_i);
    wire unused = &{1'b0, npi_wr_empty_i, npi_rd_word_i, ask_next[0], 1'b0};

    // ---- write ----
    wire push = !npi_wr_almost_full_i && !bursts[2] && (padding || write_valid_i);
    wire full = push && filled == 3'd7;

    assign write_ready_o = !npi_wr_almost_full_i && !bursts[2] && !padding;
    assign npi_wr_push_o = push;
    assign npi_wr_data_o = write_data_i;
    assign npi_wr_be_o   = padding ? 8'd0 : write_be_i;

    // ---- requests ----
    wire [ADDR_BITS-1:6] addr = request_read ? read_addr : write_addr;
    generate
        if (ADDR_BITS < 32) begin : g_narrow
            assign npi_addr_o = {{(32 - ADDR_BITS){1'b0}}, addr, 6'd0};
        end else begin : g_wide
            assign npi_addr_o = {addr, 6'd0};
        end
    endgenerate
    assign npi_addr_req_o = request;
    assign npi_rnw_o      = request_read;
    assign npi_size_o     = SIZE_64_BYTES;

    always @(posedge clk_i) begin
        if (request) begin
            request <= !npi_addr_ack_i;
        end else if (npi_init_done_i && !read_stop_i) begin
            request      <= bursts != 3'd0 || ask;
            request_read <= bursts == 3'd0;
        end else if (npi_init_done_i) begin
            request      <= bursts != 3'd0;
            request_read <= 1'b0;
        end

        // The start of a core depends on the idle signals, so they come from flip-flops to shorten
        // the paths. Therefore they are one clock late.
        read_idle_o  <= to_give == {WORD_BITS{1'b0}} && outstanding == 6'd0 &&
            !(request && request_read) && !read_start_i;
        write_idle_o <= filled == 3'd0 && bursts == 3'd0 && !push;
        // Words and bursts are counted separately, so that the path from read_take_i contains no
        // carry chain.
        outstanding[2:0] <= outstanding[2:0] - {2'd0, npi_rd_pop_o};
        if (acked_read != popped_burst)
            outstanding[5:3] <= acked_read ? outstanding[5:3] + 3'd1 : outstanding[5:3] - 3'd1;
        if (acked_read)
            read_addr <= read_addr + 1'b1;
        if (read_start_i)
            read_addr <= read_base_i;
        // after read_stop_i, a request that is still waiting no longer counts
        if (read_start_i || (acked_read && asks))
            to_ask <= ask_next[WORD_BITS-2:1];
        if (read_start_i || (read_valid_o && read_take_i))
            to_give <= give_next;
        if (read_stop_i && !read_start_i) begin
            to_ask  <= {(WORD_BITS - 2){1'b0}};
            to_give <= {WORD_BITS{1'b0}};
        end

        if (push)
            filled <= filled + 3'd1;
        padding <= padding ? !full : write_flush_i && filled != 3'd0;
        if (full != acked_write)
            bursts <= acked_write ? bursts - 3'd1 : bursts + 3'd1;
        if (acked_write)
            write_addr <= write_addr + 1'b1;
        if (write_start_i)
            write_addr <= write_base_i;

        if (rst_i) begin
            request     <= 1'b0;
            // an idle stream holds this value, also before npi_init_done_i
            request_read <= 1'b1;
            to_ask      <= {(WORD_BITS - 2){1'b0}};
            to_give     <= {WORD_BITS{1'b0}};
            outstanding <= 6'd0;
            filled      <= 3'd0;
            bursts      <= 3'd0;
            padding     <= 1'b0;
            read_idle_o  <= 1'b0;
            write_idle_o <= 1'b0;
        end
    end

`ifdef FORMAL
    // Proves that requests follow the rules of docs/memory.md, and that the core receives exactly
    // its words. In this proof the port has two FIFOs of 32 words, and a controller that may
    // acknowledge at any time.
    reg       past = 1'b0;
    reg [5:0] f_pushed;         // number of words in the write FIFO
    reg [5:0] promised;         // number of words of acknowledged reads that have not been popped
    reg [5:0] there;            // number of these words that are in the read FIFO
    // number of words of acknowledged writes that are still in the write FIFO
    reg [6:0] f_owed;
    (* anyseq *) wire may_move, may_come;
    wire      moved = may_move && f_owed != 7'd0;
    wire      came  = may_come && there != promised;
    // Assumptions: the core takes a word only when it is offered, starts only when the stream is
    // idle, and does not flush together with a word.
    reg [WORD_BITS-1:0] f_left; // number of words that the core may still take
    reg [2:0] f_rest;           // number of words of the last burst that the core does not take
    reg [2:0] f_begun;          // number of words that were sent since the burst began
    reg [ADDR_BITS-1:6] f_read, f_write; // addresses of the next bursts since the start
    reg       f_reads, f_writes;
    reg       f_ready;          // high if the port has been ready since the reset
    initial assume (rst_i);
    always @* begin
        assume (!npi_addr_ack_i || npi_addr_req_o);
        assume (npi_rd_empty_i == (there == 6'd0));
        assume (npi_wr_almost_full_i == (f_pushed == 6'd32));
        assume (npi_init_done_i || !f_ready);
    end
    // For the streams of the cores, idle_proof proves these assumptions.
    always @* if (!rst_i) begin
        core_takes:   assume (!read_take_i || read_valid_o);
        core_reads:   assume (!read_start_i || (read_idle_o && !read_stop_i));
        core_writes:  assume (!write_start_i || (write_idle_o && !write_valid_i && !write_flush_i));
        core_flushes: assume (!write_flush_i || !write_valid_i);
    end
    always @(posedge clk_i) begin
        past     <= !rst_i;
        f_pushed <= f_pushed + {5'd0, npi_wr_push_o} - {5'd0, moved};
        f_owed   <= f_owed + (npi_addr_ack_i && !npi_rnw_o ? 7'd8 : 7'd0) - {6'd0, moved};
        promised <= promised + (npi_addr_ack_i && npi_rnw_o ? 6'd8 : 6'd0) - {5'd0, npi_rd_pop_o};
        there    <= there + {5'd0, came} - {5'd0, npi_rd_pop_o};
        f_left   <= read_stop_i ? {WORD_BITS{1'b0}} : read_start_i ? read_words_i
                    : f_left - {{(WORD_BITS - 1){1'b0}}, read_take_i};
        if (read_start_i)
            f_rest <= -read_words_i[2:0];
        if (write_valid_i && write_ready_o)
            f_begun <= f_begun + 3'd1;
        else if (padding && full)
            f_begun <= 3'd0;
        f_read   <= read_start_i ? read_base_i :
            f_read + {{(ADDR_BITS - 7){1'b0}}, npi_addr_ack_i && npi_rnw_o};
        f_write  <= write_start_i ? write_base_i :
            f_write + {{(ADDR_BITS - 7){1'b0}}, npi_addr_ack_i && !npi_rnw_o};
        f_reads  <= !rst_i && (f_reads || read_start_i);
        f_writes <= !rst_i && (f_writes || write_start_i);
        f_ready  <= !rst_i && (f_ready || npi_init_done_i);
        if (rst_i) begin
            f_pushed <= 6'd0;
            f_owed   <= 7'd0;
            promised <= 6'd0;
            there    <= 6'd0;
            f_left   <= {WORD_BITS{1'b0}};
            f_begun  <= 3'd0;
        end
    end
    always @* if (!rst_i && past) begin
        // As the rules of docs/memory.md demand, no FIFO overflows or is popped when empty, and the
        // words of a write are pushed before its request.
        assert (!npi_wr_push_o || f_pushed != 6'd32);
        assert (!npi_rd_pop_o || there != 6'd0);
        assert (promised <= 6'd32 && !(npi_addr_req_o && npi_rnw_o && promised > 6'd24));
        assert (!(npi_addr_req_o && !npi_rnw_o) || {1'b0, f_pushed} >= f_owed + 7'd8);
        assert (outstanding == promised && there <= promised);
        assert (!read_idle_o ||
                (f_left == {WORD_BITS{1'b0}} && promised == 6'd0 &&
                 !(npi_addr_req_o && npi_rnw_o)));
        assert ({1'b0, f_pushed} == f_owed + {1'b0, bursts, 3'd0} + {4'd0, filled});
        assert (bursts <= 3'd4 && f_owed <= 7'd32);
        assert (!write_idle_o || (filled == 3'd0 && bursts == 3'd0));
        // The core receives exactly the number of words that it requested, and all requested words
        // arrive.
        assert (to_give == f_left);
        assert (read_valid_o == (there != 6'd0 && f_left != {WORD_BITS{1'b0}}));
        // Until the last burst is requested, the core receives every outstanding word.
        assert (!asks || {2'd0, to_give} + {{(WORD_BITS - 1){1'b0}}, f_rest} ==
                         {1'b0, to_ask, 3'd0} + {{(WORD_BITS - 4){1'b0}}, outstanding});
        assert (asks || to_give <= outstanding);
        assert (f_pushed <= 6'd32);
        assert (!padding || filled != 3'd0);
        assert (!npi_addr_req_o || npi_rnw_o || bursts != 3'd0);
        assert (request_read || f_ready);
        // The bursts follow each other, beginning at the base address of the buffer.
        assert (!f_reads || read_addr == f_read);
        assert (!f_writes || write_addr == f_write);
        // A padding word has no byte enables, so it writes nothing.
        assert (!npi_wr_push_o || npi_wr_be_o == 8'd0 || (write_valid_i && write_ready_o));
        cover (read_take_i && f_left == {{(WORD_BITS - 1){1'b0}}, 1'b1} && npi_addr_req_o &&
               !npi_rnw_o);
        cover (npi_rd_pop_o && !read_valid_o);
        cover (padding && full);
        cover (acked_write && bursts == 3'd1 && filled == 3'd0);
        cover (promised == 6'd32);
    end
    always @(posedge clk_i)
        if (past && !rst_i && !$past(rst_i) && $past(npi_addr_req_o && !npi_addr_ack_i)) begin
        assert (npi_addr_req_o && $stable(npi_rnw_o) && $stable(npi_size_o));
        assert ($stable(npi_addr_o));
    end
    // A port that is ready gets requests until all words are requested, unless the read FIFO has no
    // room for a burst.
    always @(posedge clk_i) if (past && !rst_i && !$past(rst_i))
        assert (npi_addr_req_o ||
                !$past(npi_init_done_i && !npi_addr_req_o && !read_stop_i && f_left > promised &&
                       promised <= 6'd24));
    // The idle signals rise at most one clock late.
    always @(posedge clk_i) if (past && !rst_i && !$past(rst_i)) begin
        assert (write_idle_o || $past(filled != 3'd0 || bursts != 3'd0 || npi_wr_push_o));
        assert (read_idle_o ||
                $past(to_give != {WORD_BITS{1'b0}} || promised != 6'd0 || read_start_i ||
                      (npi_addr_req_o && npi_rnw_o)));
    end
`endif
`ifdef COVER_POINTS
    as_far_ahead_as_allowed: cover property (@(posedge clk_i) outstanding == FIFO);
    stopped_with_words_on_their_way: cover property (@(posedge clk_i) read_stop_i &&
            outstanding != 6'd0);
    pads_a_burst: cover property (@(posedge clk_i) padding && full);
    write_held_up: cover property (@(posedge clk_i) write_valid_i && !write_ready_o);
    reads_and_writes: cover property (@(posedge clk_i) outstanding != 6'd0 && bursts != 3'd0);
`endif
endmodule
