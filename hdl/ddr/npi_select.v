// SPDX-License-Identifier: MIT
//
// npi_select: round-robin arbiter for PORTS requesters, with an optional urgent class.
//
// Ports with a 1 in URGENT are urgent, and are served before the other ports; within each of
// these two classes, ports are served round-robin. While a port that is not urgent waits, there are
// at most URGENT_RUN urgent grants in a row. With N ports, U of them urgent, a request waits for at
// most this number of grants to other ports:
//   no port urgent:     N - 1
//   a port not urgent:  (N - U) * (URGENT_RUN + 1) - 1
//   an urgent port:     U + (U - 1) / URGENT_RUN, with U < N; U - 1, with U = N
// npi_select_proof proves these bounds.

`default_nettype none

module npi_select #(
    parameter             PORTS      = 2, // number of ports, 2..8
    parameter [PORTS-1:0] URGENT     = 0,
    // maximum number of urgent grants in a row while other ports wait, 1..7
    parameter [2:0]       URGENT_RUN = 3'd3
) (
    input  wire             clk_i,
    input  wire             rst_i,
    input  wire [PORTS-1:0] req_i,    // requests; a request is held until the cycle of its ack_o
    input  wire             enable_i, // high if a grant can be given in this cycle
    output wire [PORTS-1:0] choice_o, // port that gets the grant while any_o is high: one-hot, or 0
    output wire             any_o,    // high if a grant is given
    output reg  [PORTS-1:0] ack_o     // grant of the previous cycle
);
    // Round-robin mask: in each class, the ports with a higher number than the port that was served
    // last.
    reg [PORTS-1:0] later;
    reg [2:0]       run;
    // ack_o has a high fan-out, and with many ports the paths from it are long. Therefore these
    // paths begin at a copy of ack_o. The copy has no reset; with a reset, synthesis would merge it
    // with ack_o.
    reg [PORTS-1:0] copy;
    wire [PORTS-1:0] served = PORTS > 2 ? copy : ack_o;

    wire [PORTS-1:0] asking  = req_i & ~served;
    wire [PORTS-1:0] urgent  = asking & URGENT;
    wire [PORTS-1:0] normal  = asking & ~URGENT;
    wire             overdue = run == URGENT_RUN;
    wire [PORTS-1:0] members = |urgent && !(overdue && |normal) ? URGENT : ~URGENT;
    // `later` excludes the port that was served last. Therefore this line can use req_i instead of
    // `asking`, which saves one input per port.
    wire [PORTS-1:0] first   = req_i & later & members;
    wire [PORTS-1:0] turn    = asking & members;

    // first_low and turn_low: the lowest bit that is set in `first` and in `turn`; above: the ports
    // with a higher number than the chosen port. This is written without a carry chain, because
    // there are few ports.
    reg [PORTS-1:0] first_low, turn_low, above;
    integer i;
    always @* begin
        first_low[0] = first[0];
        turn_low[0]  = turn[0];
        above[0]     = 1'b0;
        for (i = 1; i < PORTS; i = i + 1) begin
            first_low[i] = first[i] && !(|(first << (PORTS - i)));
            turn_low[i]  = turn[i] && !(|(turn << (PORTS - i)));
            above[i]     = |(chosen << (PORTS - i));
        end
    end
    wire [PORTS-1:0] chosen = |first ? first_low : turn_low;

    wire [PORTS-1:0] grant  = enable_i ? chosen : {PORTS{1'b0}};

    assign choice_o = chosen;
    assign any_o    = enable_i && |asking;

    always @(posedge clk_i) begin
        ack_o <= grant;
        copy  <= grant;
        if (any_o) begin
            later <= (later & ~members) | (above & members);
            if (!(|(chosen & URGENT)))
                run <= 3'd0;
            else if (|normal && !overdue)
                run <= run + 3'd1;
        end
        if (rst_i) begin
            ack_o <= {PORTS{1'b0}};
            later <= {PORTS{1'b0}};
            run   <= 3'd0;
        end
    end

`ifdef FORMAL
    // Proves that there is at most one grant per clock, that only requesters get grants, and that
    // each requester gets its grant within the bounds above.
    wire [PORTS-1:0] f_later = later, f_served = served; // for npi_arbiter_proof
    reg past = 1'b0;
    initial assume (rst_i);

    (* anyconst *) reg [PORTS-1:0] me; // one port, one-hot, chosen by the prover
    localparam [5:0] N = PORTS;
    reg  [5:0] waited = 0;             // number of grants to other ports since this request began
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
        // A request is held until it is granted.
        if (past && !rst_i && !$past(rst_i))
            assume ((asking | ~$past(asking) | $past(grant)) == {PORTS{1'b1}});
        if (rst_i || !me_asks || |(grant & me))
            waited <= 6'd0;
        else if (|grant)
            waited <= waited + 6'd1;
        if (past && !rst_i) begin
            assert ((grant & (grant - 1'b1)) == 0);   // at most one grant
            assert ((grant & ~req_i) == 0);           // only a requester gets a grant
            assert ((grant & ack_o) == 0);            // each request gets one grant
            assert ((grant & ~asking) == 0);
            assert (ack_o == ($past(rst_i) ? {PORTS{1'b0}} : $past(grant)));
            // if a port requests, no cycle passes without a grant
            assert (|grant == (enable_i && |asking));
            assert (!any_o || grant == choice_o);
            assert (any_o == |grant);
            assert ((later & served) == 0 && (ack_o & ~served) == 0);
            assert (run <= URGENT_RUN);
            assert (waited <= bound);
            cover (waited == bound);
            cover (&asking && |(grant & me));
        end
    end
`endif
`ifdef COVER_POINTS
    all_ask: cover property (@(posedge clk_i) &asking && enable_i);
    none_is_granted: cover property (@(posedge clk_i) |asking && !enable_i);
    urgent_have_had_their_run: cover property (@(posedge clk_i) any_o && overdue && |urgent &&
                                               |normal);
`endif
endmodule
