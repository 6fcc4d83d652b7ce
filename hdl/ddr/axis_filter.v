// SPDX-License-Identifier: MIT
//
// axis_filter: sends a buffer through a core with an AXI-Stream in and one out, of 8, 16, 32 or 64
// bits, and writes the core's output into another buffer (`make new-foreign BUS=axis`).
//
// It ends with the core's tlast. Without tlast (LAST 0) it ends when as many beats came out as went
// in. It refuses no bytes, and an output longer than the buffer.

`default_nettype none

module axis_filter #(
    parameter WIDTH     = 8,   // the core's data in both directions: 8, 16, 32, 64
    parameter BYTE_BITS = 11,  // of the number of bytes, 7..32
    parameter ROOM      = 1024, // bytes of the target
    parameter LAST      = 1    // 0: the core's output has no tlast
) (
    `include "memory_ports.vh"
    input  wire                 clk_i,
    input  wire                 rst_i,
    // the operation
    input  wire                 core_rst_i, // the operation is given up
    input  wire                 start_i,
    input  wire [31:0]          source_i,   // byte address, a multiple of 8; so is the target's
    input  wire [BYTE_BITS-1:0] bytes_i,    // a multiple of WIDTH / 8, or the core looks at tkeep
    input  wire [31:0]          target_i,
    output wire                 done_o,     // high for a clock
    output wire                 refused_o,  // with done
    output wire [BYTE_BITS-1:0] bytes_o,    // that came out, from done on
    // to the core
    output wire                 m_axis_tvalid_o,
    input  wire                 m_axis_tready_i,
    output wire [WIDTH-1:0]     m_axis_tdata_o,
    output wire [WIDTH/8-1:0]   m_axis_tkeep_o,
    output wire                 m_axis_tlast_o,
    // from it
    input  wire                 s_axis_tvalid_i,
    output wire                 s_axis_tready_o,
    input  wire [WIDTH-1:0]     s_axis_tdata_i,
    input  wire [WIDTH/8-1:0]   s_axis_tkeep_i,
    input  wire                 s_axis_tlast_i
);
    localparam KEEP = WIDTH / 8, BEATS = 64 / WIDTH; // bytes of a beat, beats of a word
    localparam [31:0] BYTES_OF_BEAT = KEEP, BEATS_OF_WORD = BEATS;
    localparam [3:0]  LAST_BEAT = BEATS_OF_WORD[3:0] - 4'd1;
    localparam [BYTE_BITS-1:0] STEP = BYTES_OF_BEAT[BYTE_BITS-1:0];

    reg         reading, writing; // a descriptor is offered
    reg         empty;            // refused
    wire        read_ready, write_ready, idle, tag, no_tag, ended, over;
    wire        word_valid, word_last, word_ready;
    wire [63:0] word;
    wire [7:0]  word_keep;

    // ---- a word from memory, beat by beat ----
    reg  [3:0]  beat;
    wire [7:0]  rest    = word_keep >> KEEP * beat >> KEEP; // bytes of the beats behind this one
    wire        is_last = beat == LAST_BEAT || rest == 8'd0;
    wire        sent    = m_axis_tvalid_o && m_axis_tready_i;
    wire [63:0] shifted = word >> WIDTH * beat;
    wire [7:0]  kept    = word_keep >> KEEP * beat;
    assign m_axis_tvalid_o = word_valid;
    assign m_axis_tdata_o  = shifted[WIDTH-1:0];
    assign m_axis_tkeep_o  = kept[KEEP-1:0];
    assign m_axis_tlast_o  = word_last && is_last;
    assign word_ready      = m_axis_tready_i && is_last;

    // ---- beats into a word ----
    reg  [3:0]  place;
    reg         full;      // the word is whole
    reg         ends;      // and the packet's last
    reg  [63:0] out;
    reg  [7:0]  out_keep;
    reg  [BYTE_BITS-1:0] awaited; // bytes that went in and have not come out
    wire        out_ready;
    wire        came = s_axis_tvalid_i && s_axis_tready_o;
    wire        last = LAST != 0 ? s_axis_tlast_i : awaited <= STEP;
    assign s_axis_tready_o = !full || out_ready;

    integer b;
    always @(posedge clk_i) begin
        if (sent)
            beat <= is_last ? 4'd0 : beat + 4'd1;
        if (full && out_ready) begin
            full     <= 1'b0;
            out_keep <= 8'd0;
        end
        if (came) begin
            for (b = 0; b < BEATS; b = b + 1)
                if ({28'd0, place} == b) begin
                    out[WIDTH*b +: WIDTH]   <= s_axis_tdata_i;
                    out_keep[KEEP*b +: KEEP] <= s_axis_tkeep_i;
                end
            place   <= last || place == LAST_BEAT ? 4'd0 : place + 4'd1;
            full    <= last || place == LAST_BEAT;
            ends    <= last;
            awaited <= awaited - STEP;
        end
        empty <= start_i && bytes_i == {BYTE_BITS{1'b0}};
        if (start_i) begin
            reading <= bytes_i != {BYTE_BITS{1'b0}};
            writing <= bytes_i != {BYTE_BITS{1'b0}};
            awaited <= bytes_i;
        end
        if (reading && read_ready)
            reading <= 1'b0;
        if (writing && write_ready)
            writing <= 1'b0;
        if (core_rst_i || rst_i) begin
            reading  <= 1'b0;
            writing  <= 1'b0;
            empty    <= 1'b0;
            beat     <= 4'd0;
            place    <= 4'd0;
            full     <= 1'b0;
            out_keep <= 8'd0;
        end
    end
    assign done_o    = empty || ended;
    assign refused_o = empty || over;

    axis_memory #(.BYTE_BITS(BYTE_BITS), .ROWS(0)) u_memory (
        `include "memory_connect.vh"
        .clk_i(clk_i), .rst_i(rst_i), .stop_i(core_rst_i), .idle_o(idle), // not by core_rst_i: requested words must be taken
        .read_valid_i(reading), .read_ready_o(read_ready), .read_base_i(source_i), .read_bytes_i(bytes_i),
        .read_rows_i(16'd1), .read_stride_i(32'd0), .read_tag_i(1'b0),
        .m_axis_tvalid_o(word_valid), .m_axis_tready_i(word_ready), .m_axis_tdata_o(word), .m_axis_tkeep_o(word_keep),
        .m_axis_tlast_o(word_last), .m_axis_tid_o(no_tag),
        .write_valid_i(writing), .write_ready_o(write_ready), .write_base_i(target_i), .write_bytes_i(ROOM[BYTE_BITS-1:0]),
        .write_rows_i(16'd1), .write_stride_i(32'd0), .write_tag_i(1'b0),
        .s_axis_tvalid_i(full), .s_axis_tready_o(out_ready), .s_axis_tdata_i(out), .s_axis_tkeep_i(out_keep),
        .s_axis_tlast_i(ends),
        .done_valid_o(ended), .done_ready_i(1'b1), .done_bytes_o(bytes_o), .done_over_o(over), .done_tag_o(tag)
    );

    wire unused = &{1'b0, idle, tag, no_tag, shifted, kept, 1'b0};

`ifdef FORMAL
`include "axis_filter_proof.vh"
`endif
`ifdef COVER_POINTS
    filter_is_given_up: cover property (@(posedge clk_i) core_rst_i && word_valid);
    filter_core_holds_up: cover property (@(posedge clk_i) m_axis_tvalid_o && !m_axis_tready_i);
`endif
endmodule
