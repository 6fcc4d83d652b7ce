// SPDX-License-Identifier: MIT
//
// cdc_pulse: turns an event of src_clk_i into a pulse of one cycle in dst_clk_i, two to three
// clocks later.
//
// A flip-flop toggles with each event; two more take it across, and a change of the second is the
// event. Events come at least two dst_clk_i clocks and the paths' delays apart; one that comes
// sooner, out of ringing, is the same event still. src_clk_i needs no other edge. There is no
// reset, so neither side's can make or lose an event. Constraint: that of cdc_bit, and a dst_clk_i
// period from turned_sync to turned.

`default_nettype none

module cdc_pulse (
    input  wire src_clk_i,
    input  wire src_valid_i,
    input  wire dst_clk_i,
    output wire dst_valid_o,
    output wire pending_sync_o, // pending_async_o as dst_clk_i sees it
    // high from the event's edge until a clock after dst_valid_o; moves with either clock
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
    assign pending_async_o = {turned, turned_sync, last} != {3{earlier}};
endmodule
