// SPDX-License-Identifier: MIT
//
// core_gate_proof: the gate is open while the core is active and 16 clocks longer, then closed.
// Included at the foot of core_gate.v, only for the prover.

    reg [4:0] since = 5'd16; // clocks since the core was active
    reg past = 1'b0;
    initial assume (rst_i);
    always @(posedge clk_i) begin
        past <= 1'b1;
        since <= active ? 5'd0 : since + {4'd0, since != 5'd16};
        if (past) begin
            assert (run == (active || since != 5'd16));
            assert (rest == since);
        end
        cover (past && !run);
        cover (past && run && $past(!run));
    end
