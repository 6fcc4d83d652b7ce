// SPDX-License-Identifier: MIT
//
// core_gate: gates the clock of a core: with GATED, the clock stops 16 clocks after the core became
// idle.
//
// The 16 clocks let the pipelines of an idle core drain. On Xilinx FPGAs the gate is a BUFGCE. Its
// enable comes from flip-flops of clk_i and a few LUTs.

`default_nettype none

module core_gate #(
    parameter GATED = 0 // 1: gate the clock; 0: pass it on without logic
) (
    input  wire clk_i,
    input  wire rst_i,
    input  wire access_i, // high while the core's slot is accessed
    input  wire idle_i,   // promise of the core: without an access, no register changes later than
                          // 16 clocks from now
    output wire clk_o
);
    generate
        if (GATED == 0) begin : g_none
            assign clk_o = clk_i;
            wire unused = &{1'b0, rst_i, access_i, idle_i, 1'b0};
        end else begin : g_gate
            reg  [4:0] rest; // clocks since the core became idle, at most 16
            wire       active = rst_i || access_i || !idle_i;
            (* keep *) wire run; // kept, because core_pins.ucf refers to this net by its name
            assign     run    = active || !rest[4];
            always @(posedge clk_i)
                rest <= active ? 5'd0 : rest + {4'd0, !rest[4]};
`ifdef VERILATOR
            reg open; // sampled before the rising edge of the clock, as in the BUFGCE
            reg ungated;
            initial ungated = $test$plusargs("ungated") != 0; // for comparisons
            always_latch
                if (!clk_i)
                    open = run;
            assign clk_o = clk_i && (open || ungated);
`elsif FORMAL
            // In proofs the gated clock has a single edge, when the gate has closed.
            reg closed;
            always @(posedge clk_i)
                closed <= !run;
            assign clk_o = !run && !closed;
            // The gate is open while the core is active and for 16 clocks after that, then closed.
            reg [4:0] since = 5'd16; // clocks since the core was active
            wire f_active = rst_i || access_i || !idle_i;
            reg past = 1'b0;
            initial assume (rst_i);
            always @(posedge clk_i) begin
                past <= 1'b1;
                since <= f_active ? 5'd0 : since + {4'd0, since != 5'd16};
                if (past) begin
                    assert (run == (f_active || since != 5'd16));
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
