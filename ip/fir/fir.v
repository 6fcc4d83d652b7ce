// SPDX-License-Identifier: MIT
//
// fir: applies the FIR filter (fir_filter.vhd) to a buffer in DDR3. Its registers are in the
// generated module fir_wrapper.

`default_nettype none

module fir (
    `include "slot_ports.vh"
    `include "memory_ports.vh"
    output wire        irq_o,
    output wire        idle_o // high while no call is in progress
);
    wire        core_rst, set_coefficient, clear, start, unused_shift_start;
    wire [7:0]  index, shift;
    wire [31:0] coefficient, source, target;
    wire [8:0]  count;

    reg         busy, refused;
    // requests, delayed by one clock; forget: clears the history; put: writes a coefficient
    reg         forget, put;
    reg         begun, flushed;    // begun: the streams have started; flushed: the last word has
                                   // been flushed
    // to_send: number of samples not yet sent to the filter; to_take: number of results not yet
    // received
    reg  [8:0]  to_send, to_take;
    reg  [1:0]  place;             // index of the next sample in its word
    reg  [63:0] packed_results;
    reg  [2:0]  filled;            // number of results in the current word, 0..4
    reg  [31:0] saturations;

    wire        bad = count == 9'd0;
    wire        read_valid, read_idle, write_ready, write_idle;
    wire [63:0] read_data;
    wire        sample_ready, result_valid, saturated;
    wire [15:0] result;
    wire        idle    = read_idle && write_idle;
    // an earlier call may have left transfers in progress, so the start waits until the streams are
    // idle
    wire        go      = busy && !begun && idle;
    wire        ended   = begun && to_take == 9'd0;
    wire        flush   = ended && filled == 3'd0 && !flushed;
    wire        sending = to_send != 9'd0 && read_valid;
    wire        sent    = sending && sample_ready;
    wire        offer   = (filled[2] || (ended && filled != 3'd0)) && !core_rst;
    wire        written = offer && write_ready;
    wire        room    = !filled[2] || write_ready;
    wire        taken   = result_valid && room;
    // one-hot position of this result in its word
    wire [3:0]  here    = written ? 4'd1 : 4'd1 << filled[1:0];

    fir_wrapper u_wrapper (
        `include "slot_connect.vh"
        .irq_o(irq_o), .core_rst_o(core_rst),
        .set_coefficient_start_o(set_coefficient), .set_coefficient_index_o(index),
        .set_coefficient_value_o(coefficient),
        .set_shift_start_o(unused_shift_start), .set_shift_bits_o(shift), .clear_start_o(clear),
        .filter_start_o(start), .filter_list_base_o(source), .filter_list_count_o(count),
        .filter_filtered_base_o(target), .filter_filtered_count_i(count),
        .filter_result_i(saturations),
        .filter_done_i(refused || (flushed && idle)), .filter_refused_i(refused));

    fir_filter u_filter (
        .clk_i(clk_i), .rst_i(core_rst),
        .coefficient_write_i(put), .coefficient_index_i(index[3:0]),
        .coefficient_i(coefficient[17:0]), .shift_i(shift[4:0]), .clear_i(forget),
        .sample_valid_i(sending), .sample_ready_o(sample_ready),
        .sample_i(read_data[16*place +: 16]),
        .result_valid_o(result_valid), .result_ready_i(room),
        .result_o(result), .saturated_o(saturated));

    npi_stream #(.ADDR_BITS(32), .WORD_BITS(7)) u_stream (
        `include "memory_connect.vh"
        // rst_i instead of core_rst: words that were requested must be received even after core_rst
        .clk_i(clk_i), .rst_i(rst_i),
        .read_start_i(go && !core_rst), .read_base_i(source[31:6]),
        .read_words_i(to_send[8:2] + {6'd0, |to_send[1:0]}), .read_stop_i(core_rst),
        .read_valid_o(read_valid), .read_data_o(read_data),
        .read_take_i(sent && (place == 2'd3 || to_send == 9'd1)), .read_idle_o(read_idle),
        .write_start_i(go && !core_rst), .write_base_i(target[31:6]),
        .write_valid_i(offer), .write_data_i(packed_results),
        .write_be_i({{2{filled[2]}}, {2{filled[2] || &filled[1:0]}}, {2{filled[2] || filled[1]}},
                     2'b11}),
        .write_ready_o(write_ready), .write_flush_i(flush || core_rst), .write_idle_o(write_idle));
    assign idle_o         = !busy && idle;

    integer r;
    always @(posedge clk_i) begin
        refused <= start && bad;
        forget  <= clear && !busy;
        put     <= set_coefficient && index[7:4] == 4'd0;
        if (start && !bad) begin
            busy        <= 1'b1;
            to_send     <= count;
            to_take     <= count;
        end
        // These registers are loaded at `go` instead of `start`, because the path of `start` is
        // long.
        if (go) begin
            begun       <= 1'b1;
            saturations <= 32'd0;
            place       <= 2'd0;
        end
        if (sent) begin
            to_send <= to_send - 9'd1;
            place   <= place + 2'd1;
        end
        if (taken) begin
            to_take     <= to_take - 9'd1;
            saturations <= saturations + {31'd0, saturated};
            for (r = 0; r < 4; r = r + 1)
                if (here[r])
                    packed_results[16*r +: 16] <= result;
        end
        filled <= (written ? 3'd0 : filled) + {2'd0, taken};
        if (flush)
            flushed <= 1'b1;
        if (flushed && idle) begin
            busy    <= 1'b0;
            begun   <= 1'b0;
            flushed <= 1'b0;
        end
        if (core_rst) begin
            busy    <= 1'b0;
            refused <= 1'b0;
            begun   <= 1'b0;
            flushed <= 1'b0;
            filled  <= 3'd0;
            to_send <= 9'd0;
            to_take <= 9'd0;
        end
    end

    wire unused =
        &{1'b0, unused_shift_start, shift[7:5], coefficient[31:18], source[5:0], target[5:0], 1'b0};
`ifdef FORMAL
    // For formal.idle_fir: while no call is in progress, the core contains no samples and no
    // results.
    (* hierconn *) wire [4:0] \u_filter.full ; // signals of the submodules
    (* hierconn *) wire [3:0] \u_wrapper.busy ;
    (* hierconn *) wire [6:0] \u_stream.to_give ;
    reg        past = 1'b0;
    reg  [3:0] in_filter;
    integer    f;
    always @(posedge clk_i)
        past <= !rst_i;
    always @* begin
        in_filter = 4'd0;
        for (f = 0; f < 5; f = f + 1)
            in_filter = in_filter + {3'd0, \u_filter.full [f]};
        if (past && !rst_i) begin
            assert (\u_wrapper.busy == {busy || refused, 3'd0} && !(busy && refused));
            assert ({1'b0, to_take} == {1'b0, to_send} + {6'd0, in_filter});
            assert (busy || (to_take == 9'd0 && !begun));
            assert (begun || (filled == 3'd0 && !flushed && \u_stream.to_give == 7'd0));
            assert (!flushed || (to_take == 9'd0 && filled == 3'd0));
        end
    end
`endif
`ifdef COVER_POINTS
    saturates: cover property (@(posedge clk_i) taken && saturated);
    reset_under_way: cover property (@(posedge clk_i) core_rst && busy);
    memory_holds_up: cover property (@(posedge clk_i) result_valid && !room);
`endif
endmodule
