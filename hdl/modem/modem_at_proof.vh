// SPDX-License-Identifier: MIT
//
// modem_at_proof: each step needs the modem's OK, and the set-up ends.
// Included at the foot of modem_at.v, only for the prover.

    localparam [3:0] EE = 4'd7, RN = 4'd9, SETTLES = 4'd0;
    reg past = 1'b0;
    initial assume (rst_i);
    reg [23:0] heard = 24'd0; // the last three characters since the command
    always @(posedge clk_i) begin
        past <= 1'b1;
        if (send)
            heard <= 24'd0;
        else if (rx_valid_i)
            heard <= {heard[15:0], rx_data_i};
        if (past && !rst_i && !$past(rst_i)) begin
            // A row is carried out only while busy, and never after the step has moved on.
            assert (busy_o || !(send || rate || guard || hear || limit || settle));
            if ($past(goes || start))
                assert (!(send || rate || guard || hear || limit || settle) && fresh);
            // A step follows its predecessor, and only after "OK" and a return came.
            if (passed)
                assert (heard == {"OK", 8'h0D});
            // A return without "OK" is a refusal, except the end of an earlier answer.
            assert (refused == $past(rx_valid_i && rx_data_i == 8'h0D && !heard_k && !fresh));
            if (hear) begin
                assert (!send);
                assert (!heard_o || heard[7:0] == "O");
                assert (!heard_k || heard[15:0] == "OK");
            end
            if (step_o != $past(step_o))
                assert (($past(start) && step_o == ENTER) ||
                        ($past(passed) && (step_o == $past(step_o) + 4'd1 ||
                                           ($past(step_o) == EE && step_o == RN))));
            // The end is success after the last step, or failure, never both.
            assert (!(done_o && failed_o));
            if (done_o)
                assert ($past(settle) && step_o == SETTLES);
            if (settle)
                assert (step_o == SETTLES);
            if ($past(busy_o) && !busy_o)
                assert (done_o || failed_o);
            // Nothing is sent while silence is kept, and what is offered stays until it is taken.
            if (tx_valid_o)
                assert (send && !guard);
            if ($past(tx_valid_o) && !$past(tx_ready_i))
                assert (tx_valid_o && $stable(tx_data_o));
        end
        cover (past && !rst_i && step_o == 4'd3);
        cover (past && !rst_i && retried_o && !enters && step_o == 4'd2);
        cover (past && !rst_i && digit && taken);
    end
