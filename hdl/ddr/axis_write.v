// SPDX-License-Identifier: MIT
//
// axis_write: puts packets of an AXI-Stream of 64 bits into buffers in memory; the writing half of axis_memory.
//
// A descriptor takes one packet: rows of desc_bytes_i bytes, desc_stride_i bytes from the begin of
// a row to the next. A byte that is not kept leaves memory unchanged. Bytes beyond the last row are
// thrown away, and over_o reports them. Bursts of 64 bytes are filled up with words without byte
// enables. done_valid_o, until done_ready_i, says that a packet is in memory, where every later
// request of any port sees it: with its tag, its number of bytes, over_o. The next descriptor may
// come before that, and the next packet up to its last word.

`default_nettype none

module axis_write #(
    parameter ADDR_BITS = 32, // of a byte address, 7..32
    parameter BYTE_BITS = 24, // of a row's number of bytes, 7..32, and of a packet's
    parameter ROWS      = 1,  // 0: each packet is one row
    parameter TAG_BITS  = 1
) (
    input  wire                 clk_i,
    input  wire                 rst_i,
    input  wire                 stop_i, // everything is given up
    // descriptors: bytes and rows are 1 at least; base and stride are multiples of 8
    input  wire                 desc_valid_i,
    output wire                 desc_ready_o,
    input  wire [ADDR_BITS-1:3] desc_base_i,
    input  wire [BYTE_BITS-1:0] desc_bytes_i,
    input  wire [15:0]          desc_rows_i,
    input  wire [ADDR_BITS-1:3] desc_stride_i,
    input  wire [TAG_BITS-1:0]  desc_tag_i,
    output wire                 idle_o,
    // a packet is in memory
    output wire                 done_valid_o,
    input  wire                 done_ready_i,
    output reg  [BYTE_BITS-1:0] done_bytes_o, // bytes taken, up to the last one kept, modulo 2**BYTE_BITS
    output reg                  done_over_o,  // there were more
    output reg  [TAG_BITS-1:0]  done_tag_o,
    // stream
    input  wire                 axis_tvalid_i,
    output wire                 axis_tready_o,
    input  wire [63:0]          axis_tdata_i,
    input  wire [7:0]           axis_tkeep_i,
    input  wire                 axis_tlast_i,
    // requests of 64 bytes, whose words are in the port's write FIFO
    output wire                 ask_valid_o,
    input  wire                 ask_ready_i,
    output wire [ADDR_BITS-1:6] ask_addr_o,
    input  wire                 acked_i, // one of them is acknowledged
    // the port's write FIFO
    input  wire                 wr_full_i,
    output wire                 wr_push_o,
    output wire [63:0]          wr_data_o,
    output wire [7:0]           wr_be_o
);
    localparam WORD_BITS = BYTE_BITS - 2; // of a number of words

    reg                 busy;      // a descriptor's packet is taken
    reg                 over;      // the rest of it is thrown away
    reg                 pad;       // the burst that is begun is filled up
    reg                 leading;   // the row begins within a burst, which is filled up to there after `pad`
    reg [ADDR_BITS-1:3] at;        // where the next word goes
    reg [WORD_BITS-1:0] left;      // words of the row
    reg [ADDR_BITS-1:3] row, stride;
    reg [WORD_BITS-1:0] words;     // of a row
    reg [2:0]           rest;      // bytes in a row's last word, 0: 8
    reg [15:0]          rows;      // with this one
    reg [TAG_BITS-1:0]  tag;
    reg [BYTE_BITS-1:0] bytes;     // taken
    reg [2:0]           place;     // of the next word in its burst
    reg [ADDR_BITS-1:6] burst;     // the one that is begun
    reg [ADDR_BITS-1:6] bursts [0:3]; // full ones, not asked for yet
    reg [1:0]           in, out;
    reg [2:0]           queued, unacked; // full bursts, not asked for; not acknowledged: 0..4
    reg                 ending;    // a packet's last word is taken
    reg [2:0]           behind;    // bursts until it is acknowledged

    // ---- words ----
    wire free   = !wr_full_i && !unacked[2];
    wire may    = free && busy && !over && !pad && !leading;
    wire lead   = free && busy && !over && !pad && leading;
    wire take   = axis_tvalid_i && axis_tready_o;
    wire data   = take && !over;
    wire full   = wr_push_o && place == 3'd7;
    wire ends   = take && axis_tlast_i;
    wire row_ends = left == {{(WORD_BITS-1){1'b0}}, 1'b1};
    wire one_row  = ROWS == 0 || rows == 16'd1;
    wire [7:0] fits = row_ends && rest != 3'd0 ? 8'hFF >> (4'd8 - {1'b0, rest}) : 8'hFF;
    wire [7:0] keep = axis_tkeep_i & fits;
    wire too_much   = data && row_ends && one_row && (!axis_tlast_i || (axis_tkeep_i & ~fits) != 8'd0);
    wire [2:0] next_place = place + {2'd0, wr_push_o};

    assign axis_tready_o = (may || (busy && over)) && !(axis_tlast_i && ending) && !stop_i;
    assign wr_push_o     = free && pad || lead || data;
    assign wr_data_o     = axis_tdata_i;
    assign wr_be_o       = data ? keep : 8'd0;

    reg [3:0] kept; // bytes up to the last one that is kept
    integer k;
    always @* begin
        kept = 4'd0;
        for (k = 0; k < 8; k = k + 1)
            if (keep[k])
                kept = k[3:0] + 4'd1;
    end
    wire [BYTE_BITS-1:0] so_far = bytes + (over ? {BYTE_BITS{1'b0}} : {{(BYTE_BITS-4){1'b0}}, axis_tlast_i || row_ends ? kept : 4'd8});

    // ---- descriptors ----
    wire start = desc_valid_i && desc_ready_o;
    wire [ADDR_BITS-1:3] next_row = row + stride;
    wire [WORD_BITS-1:0] wanted   = {1'b0, desc_bytes_i[BYTE_BITS-1:3]} + {{(WORD_BITS-1){1'b0}}, |desc_bytes_i[2:0]};
    assign desc_ready_o = (!busy || ends) && !stop_i;
    assign idle_o       = !busy && !pad && unacked == 3'd0 && !ending;

    // ---- requests ----
    wire ask = ask_valid_o && ask_ready_i;
    assign ask_valid_o  = queued != 3'd0;
    assign ask_addr_o   = bursts[out];
    assign done_valid_o = ending && behind == 3'd0;

    always @(posedge clk_i) begin
        // The descriptor's inputs are sampled while idle, valid or not. So the wide choice is
        // early, and `take`, which is late, is only an enable.
        if (take || !busy) begin
            if (axis_tlast_i || !busy) begin
                at      <= desc_base_i;
                left    <= wanted;
                row     <= desc_base_i;
                stride  <= desc_stride_i;
                words   <= wanted;
                rest    <= desc_bytes_i[2:0];
                rows    <= desc_rows_i;
                tag     <= desc_tag_i;
                bytes   <= {BYTE_BITS{1'b0}};
                leading <= desc_base_i[5:3] != 3'd0;
            end else begin
                at   <= row_ends ? next_row : at + 1'b1;
                left <= row_ends ? words : left - 1'b1;
                if (row_ends) begin
                    row     <= next_row;
                    rows    <= rows - 16'd1;
                    leading <= next_row[5:3] != 3'd0;
                end
                bytes <= so_far;
            end
        end
        if (lead)
            leading <= place + 3'd1 != at[5:3];
        if (data)
            over <= too_much;
        if (ends) begin
            busy         <= 1'b0;
            over         <= 1'b0;
            done_bytes_o <= so_far;
            done_over_o  <= over || too_much;
            done_tag_o   <= tag;
        end
        if (start) begin
            busy <= 1'b1;
            over <= 1'b0;
        end

        place <= next_place;
        if (place == 3'd0)
            burst <= at[ADDR_BITS-1:6];
        if (full) begin
            bursts[in] <= burst;
            in         <= in + 2'd1;
            pad        <= 1'b0;
        end else if ((data && (row_ends || axis_tlast_i)) || (stop_i && next_place != 3'd0)) begin
            pad <= 1'b1;
        end
        if (ask)
            out <= out + 2'd1;
        queued  <= queued + {2'd0, full} - {2'd0, ask};
        unacked <= unacked + {2'd0, full} - {2'd0, acked_i};

        if (ends) begin
            ending <= 1'b1;
            behind <= unacked + {2'd0, !over || pad} - {2'd0, acked_i}; // with the burst of the last written word
        end else begin
            ending <= ending && !(done_valid_o && done_ready_i);
            behind <= behind - {2'd0, acked_i && behind != 3'd0};
        end
        if (stop_i) begin
            busy   <= 1'b0;
            over   <= 1'b0;
            ending <= 1'b0;
        end
        if (rst_i) begin
            busy    <= 1'b0;
            over    <= 1'b0;
            pad     <= 1'b0;
            ending  <= 1'b0;
            place   <= 3'd0;
            in      <= 2'd0;
            out     <= 2'd0;
            queued  <= 3'd0;
            unacked <= 3'd0;
        end
    end

`ifdef FORMAL
`include "axis_write_proof.vh"
`endif
`ifdef COVER_POINTS
    packet_is_longer_than_its_buffer: cover property (@(posedge clk_i) ends && over);
    packet_ends_while_the_one_before_is_not_in_memory: cover property (@(posedge clk_i) axis_tvalid_i && axis_tlast_i && ending);
    row_begins_in_a_burst: cover property (@(posedge clk_i) lead);
    write_stopped_in_a_burst: cover property (@(posedge clk_i) stop_i && place != 3'd0);
`endif
endmodule
