// SPDX-License-Identifier: MIT
//
// modem_tx_proof: a packet's bytes leave once, in order, and its buffer is freed after the last.
// Included at the foot of modem_tx.v, only for the prover.

    reg past = 1'b0;
    initial assume (rst_i);
    reg [6:0] out  = 7'd0; // bytes of this packet that have left
    reg [7:0] read = 8'd0; // the latest byte read
    wire      left = tx_valid_o && tx_ready_i;
    always @(posedge clk_i) begin
        past <= 1'b1;
        // The ring keeps its oldest packet, of 1..100 bytes (modem.v), until it is sent.
        if (past && $past(packet_valid_i) && !$past(sent_o) && !$past(rst_i))
            assume (packet_valid_i && $stable(packet_bytes_i));
        assume (packet_bytes_i >= 7'd1 && packet_bytes_i <= 7'd100);
        assume (!rd_done_i || rd_valid_o); // modem_npi
        out <= out + left;
        if (rd_done_i)
            read <= rd_data_i;
        if (sent_o || begin_anew)
            out <= 7'd0;
        if (past && !rst_i && !$past(begin_anew)) begin
            // A byte is read from a packet of the ring, in turn, once, never beyond its end.
            assert (!rd_valid_o || (packet_valid_i && rd_index_o == out && out < packet_bytes_i));
            assert (!tx_valid_o || (rd_index_o == out + 7'd1 && tx_last_o == (rd_index_o == packet_bytes_i)));
            if (tx_valid_o)
                assert (tx_data_o == read);
            // Its buffer is released once, when all its bytes have left.
            if (sent_o)
                assert (packet_valid_i && out == packet_bytes_i && !$past(sent_o));
            // After a packet that the modem does not send at once by its length, the line rests for
            // 320 ticks.
            if (state == REST && tx_ready_i)
                assert (ends == (API != 0 || packet_bytes_i == (encrypt_i ? 7'd95 : 7'd100) || (rest[8] && rest[6])));
        end
        if (past) // each state is at a known byte; the induction rests on this
            case (state)
                FETCH:   assert (sent_o ? packet_valid_i && rd_index_o == 7'd0 && out == packet_bytes_i :
                                 rd_index_o == out && (out == 7'd0 || (packet_valid_i && out < packet_bytes_i)));
                SEND:    assert (!sent_o && packet_valid_i && rd_index_o == out + 7'd1 && out < packet_bytes_i);
                REST:    assert (!sent_o && packet_valid_i && rd_index_o == out && out == packet_bytes_i);
                default: assert (0);
            endcase
        cover (past && !rst_i && out == 7'd3 && state == REST);
        cover (past && !rst_i && tx_valid_o && !tx_last_o && rd_index_o == 7'd3);
    end
