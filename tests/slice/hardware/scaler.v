// SPDX-License-Identifier: MIT
//
// scaler: a core for tests that adds an offset to the samples in a buffer in DDR3 and writes the
// sums to another buffer, one sample per clock. The offset 0x7777 makes it hang.

`default_nettype none

module scaler (
    `include "slot_ports.vh"
    `include "memory_ports.vh"
    // interrupt
    output wire        irq_o
);
    localparam [2:0] IDLE = 3'd0, RUN = 3'd1, FLUSH = 3'd2, DRAIN = 3'd3, HANG = 3'd4;

    wire        core_rst, start, limit_start, peak_taken, finished_taken;
    wire [31:0] list_base, shifted_base;
    wire [6:0]  count;
    wire [15:0] offset, limit;
    reg  [2:0]  state;
    reg  [6:0]  index;
    reg  [47:0] earlier; // samples for the next word to be written
    reg  [31:0] total;
    reg  [15:0] largest, largest_index, over_index;
    reg         over;

    wire        read_valid, read_idle, write_ready, write_idle;
    wire [63:0] read_data;

    wire [1:0]  lane     = index[1:0];
    wire [15:0] sample   = read_data[16*lane +: 16];
    wire [16:0] sum      = {sample[15], sample} + {offset[15], offset};
    wire        last     = index + 7'd1 == count;
    wire        word_end = lane == 2'd3 || last;
    wire        step     = state == RUN && read_valid && (!word_end || write_ready);
    wire [63:0] word     = {16'd0, earlier} & ~(64'hFFFFFFFFFFFFFFFF << {lane, 4'd0}) |
        {48'd0, sum[15:0]} << {lane, 4'd0};
    wire        done     = state == DRAIN && write_idle && read_idle;
    wire        refused  = count == 7'd0;

    scaler_wrapper u_wrapper (
        `include "slot_connect.vh"
        .irq_o(irq_o), .core_rst_o(core_rst),
        .set_limit_start_o(limit_start), .set_limit_limit_o(limit),
        .peak_event_i(done && !refused && $signed(largest) > $signed(limit)),
        .peak_largest_index_i(largest_index), .peak_largest_value_i(largest),
        .peak_taken_o(peak_taken),
        .finished_event_i(done), .finished_taken_o(finished_taken),
        .shift_start_o(start), .shift_list_base_o(list_base), .shift_list_count_o(count),
        .shift_offset_o(offset), .shift_exception_i(over), .shift_shifted_base_o(shifted_base),
        .shift_shifted_count_i(count), .shift_result_i(total), .shift_overflow_index_i(over_index),
        .shift_overflow_code_i(8'd42), .shift_done_i(done), .shift_refused_i(refused)
    );

    npi_stream u_stream (
        `include "memory_connect.vh"
        .clk_i(clk_i), .rst_i(rst_i),
        .read_start_i(start && !refused && offset != 16'h7777), .read_base_i(list_base[31:6]),
        .read_words_i({19'd0, count[6:2]} + {23'd0, count[1:0] != 2'd0}), .read_stop_i(core_rst),
        .read_valid_o(read_valid), .read_data_o(read_data), .read_take_i(step && word_end),
        .read_idle_o(read_idle),
        .write_start_i(start), .write_base_i(shifted_base[31:6]), .write_valid_i(step && word_end),
        .write_data_i(word), .write_be_i(~(8'hFC << {lane, 1'b0})), .write_ready_o(write_ready),
        .write_flush_i(state == FLUSH), .write_idle_o(write_idle));

    always @(posedge clk_i) begin
        case (state)
            IDLE: if (start) begin
                state   <= offset == 16'h7777 ? HANG : refused ? DRAIN : RUN;
                index   <= 7'd0;
                total   <= 32'd0;
                over    <= 1'b0;
                largest <= 16'h8000;
            end
            RUN: if (step) begin
                index <= index + 7'd1;
                total <= total + {{16{sum[15]}}, sum[15:0]};
                if (lane != 2'd3)
                    earlier[16*lane +: 16] <= sum[15:0];
                if ($signed(sum[15:0]) > $signed(largest)) begin
                    largest       <= sum[15:0];
                    largest_index <= {9'd0, index};
                end
                if (sum[16] != sum[15] && !over) begin
                    over       <= 1'b1;
                    over_index <= {9'd0, index};
                end
                if (last)
                    state <= FLUSH;
            end
            FLUSH: state <= DRAIN;
            DRAIN: if (done)
                state <= IDLE;
            default: ; // hangs
        endcase
        if (core_rst)
            state <= IDLE;
    end

    wire unused =
        &{1'b0, limit_start, peak_taken, finished_taken, list_base[5:0], shifted_base[5:0], 1'b0};
endmodule
