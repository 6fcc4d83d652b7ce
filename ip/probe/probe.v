// SPDX-License-Identifier: MIT
//
// probe: records changes of the chip's signals in a ring in DDR3, around a trigger
// (ip/probe/README.md).
//
// An entry of the ring consists of the values of all signals and the clock in which they changed.
// Nothing is stored while no signal changes. An entry has WORDS words of 64 bits:
//   word 0, bits 31..0    low bits of cycles_i, as they are two clocks after the change
//   word 0, bit 32        1: changes before this one were lost
//   word 0, bits 63..33   the first bits of signals_i; word 1 and the following contain the others
// Signals may change in every clock, so a FIFO of 512 entries precedes the memory.

`default_nettype none

module probe #(
    // number of 64-bit words per change: 1, 2 or 4, for 31, 95 or 223 signals
    parameter        WORDS  = 2,
    parameter        CLK_HZ = 100000000, // Hz
    parameter [31:0] NAMES  = 32'd0      // hash of the signals' names and widths
) (
    `include "slot_ports.vh"
    `include "memory_ports.vh"
    output wire                 irq_o,
    // recorded signals
    input  wire [31:0]          cycles_i,  // low 32 bits of the chip's cycle counter
    input  wire [64*WORDS-34:0] signals_i
);
    `include "probe_regs.vh"

    localparam WIDTH = 64 * WORDS - 33;
    localparam LOG2_WORDS = WORDS == 1 ? 0 : WORDS == 2 ? 1 : 2;
    localparam LOG2_RING = PROBE_LOG2_BYTES - 3 - LOG2_WORDS; // log2 of the number of changes in
                                                              // the ring

    wire [30:0] mask, wanted;
    wire [31:0] base;
    wire [14:0] after;
    wire        edge_only, set_arm, stop;

    // ---- signals: the probe samples each signal with a flip-flop, so the signal gets one
    // additional load and no logic ----
    reg [WIDTH-1:0] now, last;
    reg             changed;      // `last` differs from its value one clock earlier
    // fits: `last` meets the trigger condition; fitted: `fits` one clock earlier
    reg             fits, fitted;
    always @(posedge clk_i) begin
        now     <= signals_i;
        last    <= now;
        changed <= now != last;
        fits    <= ((now[30:0] ^ wanted) & mask) == 31'd0;
        fitted  <= fits;
    end

    // ---- capture ----
    reg                 running, draining, done, triggered, wrapped;
    // the next entry is written even if no signal has changed, because it is the first entry or
    // follows a loss
    reg                 owed;
    reg                 lost;
    // cycles_i[31] at the last entry; when it changes, an entry is written even without a change
    reg                 half;
    reg [LOG2_RING-1:0] next, trigger, left;

    wire full, empty, pop, room, stream_idle;
    // Number of clocks, up to 7, for which the FIFO has been empty at the end of a capture. A word
    // needs two clocks to pass the FIFO, and write_idle_o is valid two clocks after a flush.
    reg  [2:0] settled;
    wire arm    = set_arm && !running && !draining;
    wire ended  = triggered && left == {LOG2_RING{1'b0}};
    wire entry  = running && !ended && (changed || owed || half != cycles_i[31]);
    wire push   = entry && !full;
    wire hit    = running && !triggered && fits && !(edge_only && fitted);

    wire [64*WORDS-1:0] oldest;
    npi_fifo #(.WIDTH(64 * WORDS), .LOG2(9), .BLOCK(1)) u_fifo (
        .clk_i(clk_i), .rst_i(rst_i), .push_i(push), .store_i(1'b0),
        .data_i({last, lost, cycles_i}), .pop_i(pop), .data_o(oldest), .empty_o(empty),
        .full_o(full));

    always @(posedge clk_i) begin
        if (arm) begin
            running   <= 1'b1;
            owed      <= 1'b1;
            done      <= 1'b0;
            triggered <= 1'b0;
            wrapped   <= 1'b0;
            lost      <= 1'b0;
            next      <= {LOG2_RING{1'b0}};
        end
        if (entry) begin
            owed <= full;
            lost <= full;
        end
        if (push) begin
            half    <= cycles_i[31];
            next    <= next + 1'b1;
            wrapped <= wrapped || &next;
            if (triggered)
                left <= left - 1'b1;
        end
        if (hit) begin
            triggered <= 1'b1;
            // index of the entry that is written in this clock; if it is lost, index of the next
            // entry
            trigger   <= next;
            left      <= after[LOG2_RING-1:0];
        end
        if (running && (ended || stop)) begin
            running  <= 1'b0;
            draining <= 1'b1;
        end
        if (&settled && stream_idle) begin
            draining <= 1'b0;
            done     <= 1'b1;
        end
        if (rst_i) begin
            running  <= 1'b0;
            draining <= 1'b0;
            done     <= 1'b0;
        end
    end

    // ---- to memory ----
    wire [63:0] word;
    generate
        if (WORDS == 1) begin : g_one
            assign word = oldest;
            assign pop  = !empty && room;
        end else begin : g_several
            reg [LOG2_WORDS-1:0] place;
            assign word = oldest[64*place +: 64];
            assign pop  = !empty && room && &place;
            always @(posedge clk_i)
                if (rst_i)
                    place <= {LOG2_WORDS{1'b0}};
                else if (!empty && room)
                    place <= place + 1'b1;
        end
    endgenerate
    always @(posedge clk_i)
        if (!draining || !empty)
            settled <= 3'd0;
        else if (!(&settled))
            settled <= settled + 3'd1;

    wire [31:0] unused_addr;
    wire        unused_valid, unused_read_idle;
    wire [63:0] unused_data;
    // At the end of the ring, the address of the stream returns to the beginning.
    npi_stream #(.ADDR_BITS(PROBE_LOG2_BYTES), .WORD_BITS(4)) u_stream (
        .clk_i(clk_i), .rst_i(rst_i),
        .read_start_i(1'b0), .read_base_i({(PROBE_LOG2_BYTES - 6){1'b0}}), .read_words_i(4'd0),
        .read_stop_i(1'b0), .read_valid_o(unused_valid), .read_data_o(unused_data),
        .read_take_i(1'b0), .read_idle_o(unused_read_idle),
        .write_start_i(arm), .write_base_i({(PROBE_LOG2_BYTES - 6){1'b0}}),
        .write_valid_i(!empty), .write_data_i(word), .write_be_i(8'hFF), .write_ready_o(room),
        .write_flush_i(settled == 3'd4), .write_idle_o(stream_idle),
        .npi_addr_o(unused_addr), .npi_addr_req_o(npi_addr_req_o), .npi_addr_ack_i(npi_addr_ack_i),
        .npi_rnw_o(npi_rnw_o), .npi_size_o(npi_size_o), .npi_rmw_o(npi_rmw_o),
        .npi_wr_data_o(npi_wr_data_o), .npi_wr_be_o(npi_wr_be_o), .npi_wr_push_o(npi_wr_push_o),
        .npi_wr_empty_i(npi_wr_empty_i), .npi_wr_almost_full_i(npi_wr_almost_full_i),
        .npi_wr_flush_o(npi_wr_flush_o), .npi_rd_data_i(npi_rd_data_i),
        .npi_rd_word_i(npi_rd_word_i), .npi_rd_pop_o(npi_rd_pop_o),
        .npi_rd_empty_i(npi_rd_empty_i), .npi_rd_flush_o(npi_rd_flush_o),
        .npi_init_done_i(npi_init_done_i)
    );
    assign npi_addr_o     = {base[31:PROBE_LOG2_BYTES], unused_addr[PROBE_LOG2_BYTES-1:0]};

    // ---- registers ----
    reg done_before;
    always @(posedge clk_i)
        done_before <= done;
    probe_regs u_registers (
        `include "slot_connect.vh"
        .irq_o(irq_o), .done_event_i(done && !done_before),
        .control_arm_o(set_arm), .control_stop_o(stop),
        .status_running_i(running), .status_draining_i(draining), .status_triggered_i(triggered),
        .status_done_i(done), .status_wrapped_i(wrapped), .status_words_i(WORDS[2:0]),
        .names_i(NAMES), .clk_hz_i(CLK_HZ),
        .trigger_bits_o(mask), .trigger_value_o(wanted),
        .after_count_o(after), .after_edge_o(edge_only),
        .base_o(base), .capturing_i(running || draining),
        .next_i({{(32 - LOG2_RING){1'b0}}, next}),
        .trigger_at_i({{(32 - LOG2_RING){1'b0}}, trigger}));

    wire unused = &{1'b0, after, base, unused_addr, unused_valid, unused_data, unused_read_idle,
                    1'b0};
`ifdef COVER_POINTS
    loses_changes: cover property (@(posedge clk_i) entry && full);
    turns_round: cover property (@(posedge clk_i) push && &next);
    stopped_untriggered: cover property (@(posedge clk_i) draining && !triggered);
`endif
endmodule
