// SPDX-License-Identifier: MIT
//
// modem_tx: takes packets out of the transmit ring and sends them, each as one RF packet.
//
// After a packet of fewer than 100 bytes the line rests for four characters: more than the modem's RO
// of 3, so that it sends the packet off. One of 100 leaves by itself.

`default_nettype none

module modem_tx (
    input  wire        clk_i,
    input  wire        rst_i,      // also drops the ring
    input  wire        enable_i,   // the modem is set up
    input  wire        bit_tick_i, // once a bit time
    input  wire [31:0] base_i,     // of the ring: 16 buffers of 128 bytes
    // packets in
    input  wire        put_i,      // the next buffer holds put_bytes_i bytes
    input  wire [6:0]  put_bytes_i,
    output wire [4:0]  free_o,     // buffers
    output wire [3:0]  next_o,     // the buffer that the next put is about
    output reg         sent_o,     // one cycle: a packet has left and its buffer is free
    // memory
    output wire        rd_req_o,
    output wire [31:0] rd_addr_o,
    input  wire        rd_done_i,
    input  wire [63:0] rd_data_i,
    // bytes out
    output wire        tx_valid_o,
    output wire [7:0]  tx_data_o,
    input  wire        tx_ready_i,
    input  wire        cts_i       // 1: the modem takes bytes
);
    localparam [1:0] WAIT_PACKET = 2'd0, WAIT_WORD = 2'd1, SEND = 2'd2, REST = 2'd3;
    localparam [6:0] LONGEST = 7'd100;
    localparam [5:0] REST_BITS = 6'd41; // four characters and a bit

    reg [1:0]  state;
    reg [3:0]  head;          // buffer being sent
    reg [4:0]  used;
    reg [6:0]  sent;          // bytes of it
    reg [63:0] word;
    reg [5:0]  rest;

    wire [6:0] bytes;
    wire       empty, full;
    npi_fifo #(.WIDTH(7), .LOG2(4)) u_lengths (
        .clk_i(clk_i), .rst_i(rst_i), .push_i(put_i), .data_i(put_bytes_i),
        .pop_i(sent_o), .data_o(bytes), .empty_o(empty), .full_o(full)
    );

    wire take = tx_valid_o && tx_ready_i;
    wire last = sent + 7'd1 == bytes;

    assign free_o     = 5'd16 - used;
    assign next_o     = head + used[3:0];
    assign rd_req_o   = state == WAIT_WORD;
    assign rd_addr_o  = base_i + {21'd0, head, 7'd0} + {25'd0, sent[6:3], 3'd0};
    assign tx_valid_o = state == SEND && cts_i && enable_i;
    assign tx_data_o  = word[7:0];

    wire unused = &{1'b0, full, 1'b0};

    always @(posedge clk_i) begin
        sent_o <= 1'b0;
        head   <= head + {3'd0, sent_o};
        used   <= used + {4'd0, put_i} - {4'd0, sent_o};
        case (state)
            WAIT_PACKET: begin
                sent <= 7'd0;
                if (!empty && enable_i && !sent_o)
                    state <= WAIT_WORD;
            end
            WAIT_WORD: if (rd_done_i) begin
                word  <= rd_data_i;
                state <= SEND;
            end
            SEND: if (take) begin
                word <= {8'd0, word[63:8]};
                sent <= sent + 7'd1;
                rest <= bytes == LONGEST ? 6'd0 : REST_BITS;
                if (last)
                    state <= REST;
                else if (sent[2:0] == 3'd7)
                    state <= WAIT_WORD;
            end
            default: if (tx_ready_i) begin
                if (rest == 6'd0) begin
                    sent_o <= 1'b1;
                    state  <= WAIT_PACKET;
                end else if (bit_tick_i) begin
                    rest <= rest - 6'd1;
                end
            end
        endcase
        if (rst_i) begin
            state  <= WAIT_PACKET;
            head   <= 4'd0;
            used   <= 5'd0;
            sent_o <= 1'b0;
        end
    end
endmodule
