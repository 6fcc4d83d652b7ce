// SPDX-License-Identifier: MIT
//
// variants: compares the variants of cdc_bit, cdc_copy (COPY) or core_gate (GATE) for the
// simulation, for proofs and for the chip, and checks the variant of core_clock for the simulation
// (CLOCK); see variants.sh.

`default_nettype none

`ifdef GATE
module same (
    input wire clk_i,
    input wire rst_i,
    input wire access_i,
    input wire idle_i,
    input wire ungated_i // the simulation's option +ungated
);
    (* gclk *) wire step;
    wire simulated, proven, chip;
    simulated u_simulated (.clk_i(clk_i), .rst_i(rst_i), .access_i(access_i), .idle_i(idle_i),
                           .clk_o(simulated), .\g_gate.ungated (ungated_i));
    proven    u_proven (.clk_i(clk_i), .rst_i(rst_i), .access_i(access_i), .idle_i(idle_i),
                        .clk_o(proven));
    chip      u_chip (.clk_i(clk_i), .rst_i(rst_i), .access_i(access_i), .idle_i(idle_i),
                      .clk_o(chip));
    (* hierconn *) wire [4:0] \u_simulated.g_gate.rest , \u_proven.g_gate.rest ;
    (* hierconn *) wire [4:0] \u_chip.g_gate.rest ;
    (* hierconn *) wire \u_simulated.g_gate.open , \u_proven.g_gate.closed ;
    (* hierconn *) wire \u_chip.g_gate.u_buffer.passes ;

    reg  past = 1'b0, was_clk = 1'b0, was_proven = 1'b0;
    reg  reset   = 1'b0; // the first rising edge of clk_i has passed, with rst_i high
    reg  stopped = 1'b0; // the chip's gate has stopped the last edge of clk_i
    reg  [2:0] was_in = 3'd0;
    wire rises = past && clk_i && !was_clk;
    always @(posedge step) begin
        past       <= 1'b1;
        was_clk    <= clk_i;
        was_proven <= proven;
        was_in     <= {rst_i, access_i, idle_i};
        if (rises) begin
            reset   <= 1'b1;
            stopped <= !chip;
        end
    end
    always @* begin
        assume (past || !clk_i);
        // the inputs are registers of clk_i
        assume (!past || rises || {rst_i, access_i, idle_i} == was_in);
        assume (reset || rises || rst_i);
        // both gated clocks are equal; with +ungated, the clock is never stopped
        if (reset || rises)
            assert (simulated == (ungated_i ? clk_i : chip));
        // The gate passes the first edge of clk_i. From this edge on, the registers are equal.
        if (reset || rises) begin
            assert (\u_simulated.g_gate.rest == \u_proven.g_gate.rest );
            assert (\u_chip.g_gate.rest == \u_proven.g_gate.rest );
        end
        if (past)
            assert (!clk_i || \u_simulated.g_gate.open == \u_chip.g_gate.u_buffer.passes );
        if (reset && !rises)
            assert (\u_proven.g_gate.closed == stopped);
        // Before a rising edge of clk_i, the proof clock is high only if the gate stops this edge
        // and has passed the previous one.
        if (rises && reset)
            assert (was_proven == (!chip && !stopped));
        if (rises && !reset)
            assert (chip);
    end
endmodule
`elsif CLOCK
module same (
    input wire clk_i // every edge of the chip clock
);
    wire made;
    simulated u_simulated (.clk_i(clk_i), .clk_o(made));
    (* hierconn, init = 10'd0 *) wire [9:0] \u_simulated.phase ;
    // After n edges of the chip clock, core_clock has made floor(n * MULTIPLY / DIVIDE) edges.
    // The sums wrap at 2**16.
    reg [15:0]  due = 16'd0, paid = 16'd0; // n * MULTIPLY, and the number of edges * DIVIDE
    reg         was = 1'b0;
    wire [15:0] now = paid + (made != was ? 16'd`DIVIDE : 16'd0);
    always @(posedge clk_i) begin
        due  <= due + 16'd`MULTIPLY;
        paid <= now;
        was  <= made;
    end
    always @* begin
        assert (due == now + {6'd0, \u_simulated.phase });
        assert (\u_simulated.phase < `DIVIDE);
    end
endmodule
`else
module same (
    input wire              clk_i,
    input wire [`WIDTH-1:0] bits_i,
    input wire [`WIDTH-1:0] mask_i  // bits that the simulation's random choice makes late
);
`ifdef COPY
    wire [`WIDTH-1:0] plain, chip;
    simulated u_plain (.clk_i(clk_i), .bus_async_i(bits_i), .bus_sync_o(plain),
                       .mask({`WIDTH{1'b0}}));
    chip      u_chip (.clk_i(clk_i), .bus_async_i(bits_i), .bus_sync_o(chip));
    // before the first clock, the contents are arbitrary
    reg started = 1'b0;
    always @(posedge clk_i)
        started <= 1'b1;
    always @*
        assert (!started || plain == chip);
    wire unused = &{1'b0, mask_i, 1'b0};
`else
    wire [`WIDTH-1:0] simulated, proven, plain, never, chip;
    reg  [`WIDTH-1:0] was = 1;
    always @(posedge clk_i)
        was <= bits_i;
    // With TOGETHER, the simulation delays bits only in a clock in which one of the upper TOGETHER
    // bits changes.
    wire [`WIDTH-1:0] moved = bits_i ^ was;
    wire [`WIDTH-1:0] late  =
        `TOGETHER != 0 && moved >> (`WIDTH - `TOGETHER) == 0 ? {`WIDTH{1'b0}} : mask_i;

    simulated u_simulated (.clk_i(clk_i), .bit_async_i(bits_i), .bit_sync_o(simulated),
                           .mask(mask_i));
    proven    u_proven (.clk_i(clk_i), .bit_async_i(bits_i), .bit_sync_o(proven), .late(late));
    simulated u_plain (.clk_i(clk_i), .bit_async_i(bits_i), .bit_sync_o(plain),
                       .mask({`WIDTH{1'b0}}));
    proven    u_never (.clk_i(clk_i), .bit_async_i(bits_i), .bit_sync_o(never),
                       .late({`WIDTH{1'b0}}));
    chip      u_chip (.clk_i(clk_i), .bit_async_i(bits_i), .bit_sync_o(chip));

    always @* begin
        assert (simulated == proven);
        assert (plain == chip && never == chip);
    end
`endif
endmodule
`endif
