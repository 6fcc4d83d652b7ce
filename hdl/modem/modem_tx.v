// SPDX-License-Identifier: MIT
//
// modem_tx: takes packets out of the transmit ring and sends them, each as one RF packet.
//
// After a packet of fewer than 100 bytes (95 where the modem encrypts) the line rests for four characters.
// That exceeds the modem's RO of 3, so the modem sends the packet off. One of 100 (95) leaves by itself.

`default_nettype none

module modem_tx #(
    parameter API = 0 // 1: frames end by themselves
) (
    input  wire       clk_i,
    input  wire       rst_i,        // also drops the packet under way
    input  wire       enable_i,     // the modem is set up
    input  wire       encrypt_i,    // the modem encrypts
    // oldest packet of the ring
    input  wire       packet_valid_i,
    input  wire [6:0] packet_bytes_i,
    output reg        sent_o,       // one cycle: it has left and its buffer is free
    // memory
    output wire       rd_valid_o,
    output reg  [6:0] rd_index_o,   // byte of the packet
    input  wire       rd_done_i,
    input  wire [7:0] rd_data_i,
    // bytes out
    output wire       tx_valid_o,
    output reg  [7:0] tx_data_o,    // 0 while not enabled
    input  wire       tx_ready_i,   // one cycle a tick, eight a bit, while the line is idle
    output wire       tx_last_o,    // the last byte of the packet
    input  wire       cts_i         // 1: the modem takes bytes
);
    localparam [1:0] FETCH = 2'd0, SEND = 2'd1, REST = 2'd2;
    wire [6:0] longest = encrypt_i ? 7'd95 : 7'd100;

    reg [1:0] state;
    reg [8:0] rest; // ticks of silence

    wire last   = rd_index_o == packet_bytes_i;                // all its bytes are out
    wire rested = (rest[8] && rest[6]) || packet_bytes_i == longest ||
                  API != 0; // 320 ticks

    wire ends   = state == REST && (tx_ready_i || API != 0) && rested;

    // The set-up restarts the transmitter: a packet that it interrupts is sent again, whole.
    wire begin_anew = rst_i || !enable_i;

    assign rd_valid_o = state == FETCH && packet_valid_i && enable_i && !sent_o;
    assign tx_last_o  = last;
    assign tx_valid_o = state == SEND && cts_i;

    always @(posedge clk_i) begin
        sent_o <= 1'b0;
        rest   <= 9'd0;
        case (state)
            FETCH: if (rd_done_i) begin
                tx_data_o <= rd_data_i;
                state     <= SEND;
            end
            SEND: if (tx_valid_o && tx_ready_i)
                state <= last ? REST : FETCH;
            default: begin
                rest <= rest + {8'd0, tx_ready_i};
                if (ends) begin
                    sent_o <= 1'b1;
                    state  <= FETCH;
                end
            end
        endcase
        if (rd_done_i) // only in FETCH
            rd_index_o <= rd_index_o + 7'd1;
        if (begin_anew || ends)
            rd_index_o <= 7'd0;
        if (begin_anew) begin
            state     <= FETCH;
            sent_o    <= 1'b0;
            tx_data_o <= 8'd0;
        end
    end

`ifdef FORMAL
`include "modem_tx_proof.vh"
`endif
`ifdef COVER_POINTS
    modem_takes_none: cover property (@(posedge clk_i) state == SEND && !cts_i);
    needs_no_rest: cover property (@(posedge clk_i) API == 0 && ends && packet_bytes_i == longest);
    rests: cover property (@(posedge clk_i) API == 0 && ends && packet_bytes_i != longest);
    set_up_interrupts: cover property (@(posedge clk_i) begin_anew && rd_index_o != 7'd0);
`endif
endmodule
