// SPDX-License-Identifier: MIT
//
// modem_rx: writes what comes from the modem into the receive ring, a packet a buffer.
//
// A packet ends after the length that its first byte announces ((byte & 127) + 5, if that is at most
// 100), at 100 bytes, after three characters of silence, or at a framing error. It is in memory before
// it is published. With no buffer free, or a memory more than a word behind, the whole packet is
// dropped, and nothing else is touched.

`default_nettype none

module modem_rx (
    input  wire        clk_i,
    input  wire        rst_i,      // also drops the ring
    input  wire        bit_tick_i, // once a bit time
    input  wire [31:0] base_i,     // of the ring: 16 buffers of 128 bytes
    // bytes in
    input  wire        rx_valid_i,
    input  wire [7:0]  rx_data_i,
    input  wire        rx_error_i,
    input  wire        rx_idle_i,
    // memory
    output reg         wr_req_o,
    output reg  [31:0] wr_addr_o,
    output reg  [63:0] wr_data_o,
    output reg  [7:0]  wr_be_o,
    input  wire        wr_done_i,
    // packets out
    output wire        packet_valid_o,
    output wire [6:0]  packet_bytes_o,
    output wire [3:0]  packet_buffer_o,
    input  wire        release_i,
    output reg         packet_o,       // one cycle: published
    output reg         overrun_o,      // one cycle: dropped
    output wire        almost_full_o   // the modem should hold back
);
    localparam [6:0] LONGEST = 7'd100;
    localparam [5:0] SILENCE_BITS = 6'd31; // three characters and a bit

    reg [6:0]  count, expected;
    reg [3:0]  buffer;
    reg [4:0]  used;
    reg [5:0]  silence;
    reg [63:0] word;
    reg        dropping;
    reg        publish;       // the last word is on its way
    reg [6:0]  publish_bytes;

    wire [6:0] announced = rx_data_i[6:0] > 7'd95 ? LONGEST : rx_data_i[6:0] + 7'd5;
    wire [6:0] limit     = count == 7'd0 ? announced : expected;
    wire [6:0] count_now = count + {6'd0, rx_valid_i};
    wire       open      = count_now != 7'd0;
    wire       full_length = rx_valid_i && count_now == limit;
    wire       ends      = open && (full_length || rx_error_i || (silence == 6'd0 && !rx_valid_i));
    wire       word_full = rx_valid_i && count[2:0] == 3'd7;
    wire [5:0] shift     = {count[2:0], 3'd0};
    wire [63:0] word_now = rx_valid_i ? (word & ~(64'hFF << shift)) | ({56'd0, rx_data_i} << shift)
                                      : word;
    wire       starts    = rx_valid_i && count == 7'd0;
    wire       no_room   = used == 5'd16;
    wire       stuck     = wr_req_o || packet_o; // memory is a word behind
    wire       drop_now  = dropping || (starts && no_room);
    wire       keeps     = ends && !drop_now && !stuck;
    wire [6:0] last_index = count_now - 7'd1;

    wire fifo_empty, fifo_full;
    npi_fifo #(.WIDTH(7), .LOG2(4)) u_lengths (
        .clk_i(clk_i), .rst_i(rst_i), .push_i(packet_o), .data_i(publish_bytes),
        .pop_i(release_i), .data_o(packet_bytes_o), .empty_o(fifo_empty),
        .full_o(fifo_full)
    );
    wire unused = &{1'b0, fifo_full, 1'b0};

    reg [3:0] oldest;
    assign packet_valid_o  = !fifo_empty;
    assign packet_buffer_o = oldest;
    assign almost_full_o   = used >= 5'd14;

    always @(posedge clk_i) begin
        packet_o  <= 1'b0;
        overrun_o <= 1'b0;
        used <= used + {4'd0, keeps} - {4'd0, release_i}; // a packet on its way counts
        if (release_i)
            oldest <= oldest + 4'd1;

        if (!rx_idle_i || rx_valid_i)
            silence <= SILENCE_BITS;
        else if (bit_tick_i && silence != 6'd0)
            silence <= silence - 6'd1;

        if (wr_done_i) begin
            wr_req_o <= 1'b0;
            if (publish) begin
                publish  <= 1'b0;
                packet_o <= 1'b1;
                buffer   <= buffer + 4'd1;
            end
        end

        if (rx_valid_i) begin
            word  <= word_now;
            count <= count_now;
            if (starts) begin
                expected <= announced;
                dropping <= no_room;
            end
        end
        if ((word_full || ends) && !drop_now && !stuck) begin
            // The word goes out: its address and which bytes of it are new.
            wr_data_o <= word_now;
            wr_addr_o <= base_i + {21'd0, buffer, 7'd0} + {25'd0, last_index[6:3], 3'd0};
            wr_be_o   <= 8'hFF >> (3'd7 - last_index[2:0]);
            wr_req_o  <= 1'b1;
            publish   <= ends;
            publish_bytes <= count_now;
        end
        // The word before, maybe another packet's last, still waits: it is kept, this packet is not.
        if (word_full && stuck)
            dropping <= 1'b1;
        if (ends) begin
            count     <= 7'd0;
            dropping  <= 1'b0;
            overrun_o <= !keeps;
        end
        if (rst_i) begin
            count    <= 7'd0;
            buffer   <= 4'd0;
            used     <= 5'd0;
            oldest   <= 4'd0;
            dropping <= 1'b0;
            publish  <= 1'b0;
            wr_req_o <= 1'b0;
            packet_o <= 1'b0;
            overrun_o <= 1'b0;
            silence  <= SILENCE_BITS;
        end
    end
endmodule
