// SPDX-License-Identifier: MIT
//
// modem_api_rx_proof: each packet ends once, complete or bad.
// Included at the foot of modem_api_rx.v, only for the prover.

    reg past = 1'b0;
    initial assume (rst_i);
    reg open = 1'b0; // a packet has begun and not ended
    always @(posedge clk_i) begin
        past <= 1'b1;
        open <= !rst_i && !end_o && !bad_o && (open || valid_o);
        if (past && !$past(rst_i)) begin
            assert (!(end_o && bad_o));
            // Bytes are given inside a frame only, and a frame that gave some ends good or bad.
            if (open && !end_o && !bad_o)
                assert (received && (state == DATA || state == CHECKSUM));
            assert (!(unsent_o && end_o));
            assert (state != TYPE || (left > 8'd2 && left <= LONGEST)); // no frame of another length is opened
        end
        cover (past && !rst_i && end_o && open);
        cover (past && !rst_i && unsent_o);
    end
