// SPDX-License-Identifier: MIT
//
// cdc_pulse: converts an event in src_clk_i to a pulse of one cycle in dst_clk_i, two to three
// clocks later.
//
// Each event toggles a flip-flop. A two-stage synchroniser passes its output on; each change of the
// synchroniser's output is an event. The time between two events must be at least two clocks
// of dst_clk_i plus the delays of the paths; events that are closer to each other, such as ringing,
// count as one event. src_clk_i needs an edge only for each event. The module has no reset, so a
// reset of either side neither creates nor loses an event. Constraints: as for cdc_bit, and one
// period of dst_clk_i from turned_sync to turned.

`default_nettype none

module cdc_pulse (
    input  wire src_clk_i,
    input  wire src_valid_i,
    input  wire dst_clk_i,
    output wire dst_valid_o,
    output wire pending_sync_o, // pending_async_o, synchronised to dst_clk_i
    // high from the edge of the event until one clock after dst_valid_o; it may change with either
    // clock
    output wire pending_async_o
);
    reg  turned, last, earlier;
    wire turned_sync;
    initial {turned, last, earlier} = 3'b000;
    always @(posedge src_clk_i)
        if (src_valid_i)
            turned <= !turned_sync;

    cdc_bit u_cdc_bit (.clk_i(dst_clk_i), .bit_async_i(turned), .bit_sync_o(turned_sync));
    always @(posedge dst_clk_i) begin
        last   <= turned_sync;
        earlier <= last;
    end
    assign dst_valid_o     = turned_sync != last;
    assign pending_sync_o  = {turned_sync, last} != {2{earlier}};
    cdc_pending u_cdc_pending (
        .turned_i(turned), .turned_sync_i(turned_sync), .last_i(last), .earlier_i(earlier),
        .pending_o(pending_async_o)
    );
endmodule
