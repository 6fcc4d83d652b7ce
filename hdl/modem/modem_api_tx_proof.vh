// SPDX-License-Identifier: MIT
//
// modem_api_tx_proof: every frame carries its length and its checksum.
// Included at the foot of modem_api_tx.v, only for the prover.

    reg past = 1'b0;
    initial assume (rst_i);
    reg [7:0] total = 8'd0; // of all from the type on, checksum included
    always @(posedge clk_i) begin
        past <= 1'b1;
        if (taken)
            total <= place < TYPE ? 8'd0 : total + data_o;
        if (past && !$past(rst_i)) begin
            assert (place <= CHECKSUM);
            // Each place follows its predecessor; that of the packet's bytes, after the last.
            assert (place == $past(!taken || (place == DATA && !last_i) ? place : place == CHECKSUM ? 4'd0 : place + 4'd1));
            // The packet's bytes are taken in their place, and in no other.
            assert (!ready_o || place == DATA);
            // The frame's sum is 0xFF.
            if ($past(taken) && $past(place) == CHECKSUM)
                assert (total == 8'hFF && place == 4'd0);
        end
        cover (past && !rst_i && taken && place == CHECKSUM);
    end
