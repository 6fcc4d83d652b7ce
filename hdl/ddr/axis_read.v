// SPDX-License-Identifier: MIT
//
// axis_read: brings buffers from memory as packets of an AXI-Stream of 64 bits; the reading half of axis_memory.
//
// A descriptor is one packet: rows of desc_bytes_i bytes, desc_stride_i bytes from the begin of a
// row to the next. The next descriptor may come while words of earlier ones are on their way. The
// module requests bursts of 64 bytes, up to four at once; `tags` describes each requested burst.

`default_nettype none

module axis_read #(
    parameter ADDR_BITS = 32, // of a byte address, 7..32
    parameter BYTE_BITS = 24, // of a row's number of bytes, 7..32
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
    // stream; a row's last word keeps the row's bytes only, last is that of the packet
    output wire                 axis_tvalid_o,
    input  wire                 axis_tready_i,
    output wire [63:0]          axis_tdata_o,
    output wire [7:0]           axis_tkeep_o,
    output wire                 axis_tlast_o,
    output wire [TAG_BITS-1:0]  axis_tid_o, // the descriptor's tag
    // requests of 64 bytes
    output wire                 ask_valid_o,
    input  wire                 ask_ready_i,
    output wire [ADDR_BITS-1:6] ask_addr_o,
    // the port's read FIFO
    input  wire [63:0]          rd_data_i,
    input  wire                 rd_empty_i,
    output wire                 rd_pop_o
);
    localparam WORD_BITS = BYTE_BITS - 2; // of a number of words
    localparam ENTRY = TAG_BITS + 10;

    // ---- asking ----
    reg                 busy;   // a descriptor's rows are asked for
    reg [ADDR_BITS-1:3] at;     // the next word to ask for
    reg [WORD_BITS-1:0] left;   // words of the row not asked for
    reg [ADDR_BITS-1:3] row, stride;
    reg [WORD_BITS-1:0] words;  // of a row
    reg [2:0]           rest;   // bytes in a row's last word, 0: 8
    reg [15:0]          rows;   // with this one
    reg [TAG_BITS-1:0]  tag;
    reg [2:0]           asked;  // bursts asked for and not given yet, 0..4
    reg                 stopping;

    wire [2:0]           first    = at[5:3];
    wire [3:0]           room     = 4'd8 - {1'b0, first};
    wire                 row_ends = left <= {{(WORD_BITS-4){1'b0}}, room};
    wire                 one_row  = ROWS == 0 || rows == 16'd1;
    wire [2:0]           last     = row_ends ? first + left[2:0] - 3'd1 : 3'd7;
    wire                 ask      = ask_valid_o && ask_ready_i;
    wire                 start    = desc_valid_i && desc_ready_o;
    wire [ADDR_BITS-1:3] next_row = row + stride;
    wire [WORD_BITS-1:0] wanted   = {1'b0, desc_bytes_i[BYTE_BITS-1:3]} + {{(WORD_BITS-1){1'b0}}, |desc_bytes_i[2:0]};

    assign desc_ready_o = !busy && !stopping && !stop_i;
    assign ask_valid_o  = busy && asked != 3'd4 && !stop_i;
    assign ask_addr_o   = at[ADDR_BITS-1:6];
    assign idle_o       = !busy && asked == 3'd0;

    // ---- giving ----
    reg  [ENTRY-1:0]    tags [0:3];
    reg  [1:0]          tag_in, tag_out;
    reg  [2:0]          place; // of the port's next word in its burst
    wire [TAG_BITS-1:0] tag_of;
    wire [2:0]          first_of, last_of, rest_of;
    wire                final_of; // the packet ends with last_of
    assign {tag_of, first_of, last_of, rest_of, final_of} = tags[tag_out];

    wire shown   = !stopping && place >= first_of && place <= last_of;
    wire is_last = place == last_of;
    wire given   = rd_pop_o && place == 3'd7;
    assign axis_tvalid_o = !rd_empty_i && shown;
    assign axis_tdata_o  = rd_data_i;
    assign axis_tkeep_o  = is_last && rest_of != 3'd0 ? 8'hFF >> (4'd8 - {1'b0, rest_of}) : 8'hFF;
    assign axis_tlast_o  = is_last && final_of;
    assign axis_tid_o    = tag_of;
    assign rd_pop_o      = !rd_empty_i && (!shown || axis_tready_i);

    always @(posedge clk_i) begin
        if (ask) begin
            tags[tag_in] <= {tag, first, last, row_ends ? rest : 3'd0, row_ends && one_row};
            tag_in       <= tag_in + 2'd1;
            at           <= row_ends ? next_row : {at[ADDR_BITS-1:6] + 1'b1, 3'd0};
            left         <= row_ends ? words : left - {{(WORD_BITS-4){1'b0}}, room};
            if (row_ends) begin
                row  <= next_row;
                rows <= rows - 16'd1;
                busy <= !one_row;
            end
        end
        if (start) begin
            busy   <= 1'b1;
            at     <= desc_base_i;
            left   <= wanted;
            row    <= desc_base_i;
            stride <= desc_stride_i;
            words  <= wanted;
            rest   <= desc_bytes_i[2:0];
            rows   <= desc_rows_i;
            tag    <= desc_tag_i;
        end
        if (rd_pop_o)
            place <= place + 3'd1;
        if (given)
            tag_out <= tag_out + 2'd1;
        asked <= asked + {2'd0, ask} - {2'd0, given};
        if (asked == 3'd0)
            stopping <= 1'b0;
        if (stop_i) begin // requested words still come, and are thrown away
            busy     <= 1'b0;
            stopping <= 1'b1;
        end
        if (rst_i) begin
            busy     <= 1'b0;
            stopping <= 1'b0;
            asked    <= 3'd0;
            tag_in   <= 2'd0;
            tag_out  <= 2'd0;
            place    <= 3'd0;
        end
    end

`ifdef FORMAL
`include "axis_read_proof.vh"
`endif
`ifdef COVER_POINTS
    reads_as_far_ahead_as_allowed: cover property (@(posedge clk_i) asked == 3'd4);
    reads_two_rows_in_one_burst: cover property (@(posedge clk_i) ask && row_ends && next_row[ADDR_BITS-1:6] == at[ADDR_BITS-1:6]);
    read_stopped_under_way: cover property (@(posedge clk_i) stop_i && asked != 3'd0);
    read_held_up: cover property (@(posedge clk_i) axis_tvalid_o && !axis_tready_i);
`endif
endmodule
