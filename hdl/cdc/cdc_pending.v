// SPDX-License-Identifier: MIT
//
// cdc_pending: reports that an event of cdc_pulse is still in transfer. Synthesis maps this
// module to one LUT and does not merge it with other logic.
//
// Only one input changes at a time, because the time between two events is longer than the transfer
// of an event. The output of a single LUT then does not glitch; the output of several LUTs might.

`default_nettype none

(* KEEP_HIERARCHY = "YES" *)
module cdc_pending (
    input  wire turned_i,      // flip-flop of cdc_pulse that toggles with each event
    // turned_i, synchronised; last_i and earlier_i are turned_sync_i one and two clocks later
    input  wire turned_sync_i,
    input  wire last_i,
    input  wire earlier_i,
    output wire pending_o
);
    assign pending_o = {turned_i, turned_sync_i, last_i} != {3{earlier_i}};
endmodule
