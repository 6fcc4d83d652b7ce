// SPDX-License-Identifier: MIT
//
// idle_rules: invariants for formal.idle_vision: while no frame is being processed, the core makes
// no memory requests, and its count of outstanding words is correct.

    (* hierconn *) wire [1:0] \u_core.state ;
    (* hierconn *) wire \u_core.u_memory.request , \u_core.u_memory.writes ,
        \u_core.u_memory.slot_full ;
    (* hierconn *) wire [5:0] \u_core.u_memory.outstanding ;
    (* hierconn *) wire \u_core.u_memory.active , \u_core.stop , \u_core.streaming ;
    localparam [1:0] WAIT_FOR_START = 2'd0, STREAM = 2'd1, DRAIN = 2'd2;
    reg past = 1'b0;
    always @(posedge clk_i)
        past <= !rst_i;
    always @* if (past && !rst_i) begin
        assert ({1'b0, \u_core.u_memory.outstanding } == promised && promised <= 7'd32);
        assert (!\u_core.u_memory.request || \u_core.u_memory.writes || promised <= 7'd16);
        assert (!\u_core.u_memory.writes || \u_core.u_memory.slot_full );
        assert (\u_core.state != WAIT_FOR_START || !\u_core.u_memory.active );
        assert (\u_core.state == STREAM || !\u_core.streaming );
        assert (\u_core.state != DRAIN || \u_core.stop );
        assert (\u_core.state != 2'd3); // GHDL's netlist would treat this value like DRAIN
    end
