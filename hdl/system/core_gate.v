// SPDX-License-Identifier: MIT
//
// core_gate: gates the clock of a core. With GATED, the clock stops 2**LOG2 clocks after the core
// has become idle.
//
// During these clocks the pipelines of an idle core become empty. On Xilinx FPGAs the gate is a
// BUFGCE, and its enable comes from flip-flops of clk_i and a few LUTs.

`default_nettype none

module core_gate #(
    parameter GATED = 0, // 1: the clock is gated; 0: it is passed on without any logic
    parameter LOG2  = 4  // log2 of the number of clocks; every core relies on at least 16
) (
    input  wire clk_i,
    input  wire rst_i,
    input  wire access_i, // high during an access to the core's slot
    // high while the core is idle: unless an access follows, its registers may change for at most
    // 2**LOG2 more clocks
    input  wire idle_i,
    output wire clk_o
);
    generate
        if (GATED == 0) begin : g_none
            assign clk_o = clk_i;
            wire unused = &{1'b0, rst_i, access_i, idle_i, 1'b0};
        end else begin : g_gate
            reg  [LOG2:0] rest; // number of clocks since the core became idle, up to 2**LOG2
            wire       active = rst_i || access_i || !idle_i;
            (* keep *) wire run; // net name is kept, because core_pins.ucf uses it
            assign     run    = active || !rest[LOG2];
            always @(posedge clk_i)
                rest <= active ? {(LOG2+1){1'b0}} : rest + {{LOG2{1'b0}}, !rest[LOG2]};
`ifdef VERILATOR
            reg open; // `run` as sampled before the rising edge of clk_i, as in a BUFGCE
            reg ungated;
            initial ungated = $test$plusargs("ungated") != 0; // for comparisons
            always_latch
                if (!clk_i)
                    open = run;
            assign clk_o = clk_i && (open || ungated);
`elsif FORMAL
            // In proofs, the gated clock has a single rising edge, at the time at which the gate
            // closes.
            reg closed;
            always @(posedge clk_i)
                closed <= !run;
            assign clk_o = !run && !closed;
            // The gate is open while the core is active and for 2**LOG2 clocks after that; then it
            // is closed.
            localparam [LOG2:0] LAST = 1 << LOG2;
            reg [LOG2:0] since = LAST; // number of clocks since the core was last active
            wire f_active = rst_i || access_i || !idle_i;
            reg past = 1'b0;
            initial assume (rst_i);
            always @(posedge clk_i) begin
                past <= 1'b1;
                since <= f_active ? {(LOG2+1){1'b0}} : since + {{LOG2{1'b0}}, since != LAST};
                if (past) begin
                    assert (run == (f_active || since != LAST));
                    assert (rest == since);
                end
                cover (past && !run);
                cover (past && run && $past(!run));
            end
`else
            BUFGCE u_buffer (.I(clk_i), .CE(run), .O(clk_o));
`endif
        end
    endgenerate
endmodule
