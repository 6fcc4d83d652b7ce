// SPDX-License-Identifier: MIT
//
// npi_select_proof: one grant a clock, only to a requester, within a bound.
// Included at the foot of npi_select.v, only for the prover.

    wire [PORTS-1:0] f_later = later; // for npi_arbiter_proof
    reg past = 1'b0;
    initial assume (rst_i);

    (* anyconst *) reg [PORTS-1:0] me; // any one port, one-hot
    localparam [5:0] N = PORTS;
    reg  [5:0] waited = 0;             // grants to others since it began to wait
    reg  [5:0] urgents, bound;
    wire me_asks = |(me & asking);
    integer q;
    always @* begin
        urgents = 6'd0;
        for (q = 0; q < PORTS; q = q + 1)
            urgents = urgents + {5'd0, URGENT[q]};
        if (URGENT == 0 || &URGENT)
            bound = N - 6'd1;
        else if (!(|(me & URGENT)))
            bound = (N - urgents) * ({3'd0, URGENT_RUN} + 6'd1) - 6'd1;
        else
            bound = urgents + (urgents - 6'd1) / {3'd0, URGENT_RUN};
    end

    always @(posedge clk_i) begin
        past <= 1'b1;
        assume (me != 0 && (me & (me - 1'b1)) == 0);
        // A request stays until it is granted.
        if (past && !rst_i && !$past(rst_i))
            assume ((asking | ~$past(asking) | $past(grant_o)) == {PORTS{1'b1}});
        if (rst_i || !me_asks || |(grant_o & me))
            waited <= 6'd0;
        else if (|grant_o)
            waited <= waited + 6'd1;
        if (past && !rst_i) begin
            assert ((grant_o & (grant_o - 1'b1)) == 0);     // at most one
            assert ((grant_o & ~asking) == 0);              // only to a requester
            assert (|grant_o == (enable_i && |asking));     // no cycle is lost
            assert (any_o == |grant_o);
            assert ((later & ack_o) == 0);
            assert (run <= URGENT_RUN);
            assert (waited <= bound);
            cover (waited == bound);
            cover (&asking && |(grant_o & me));
        end
    end
