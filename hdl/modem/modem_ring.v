// SPDX-License-Identifier: MIT
//
// modem_ring: keeps which of sixteen buffers are in use, in turn, and how many bytes each holds.
//
// A push while full and a pop while empty are the user's errors; modem.v excludes them.

`default_nettype none

module modem_ring (
    input  wire       clk_i,
    input  wire       rst_i,   // also empties it
    input  wire       push_i,  // buffer next_o holds bytes_i bytes
    input  wire [6:0] bytes_i,
    input  wire       pop_i,   // the oldest is free again
    output wire [3:0] next_o,
    output wire [3:0] oldest_o,
    output wire [6:0] bytes_o, // bytes of the oldest
    output wire [4:0] free_o   // 0..16 buffers are not in use
);
    reg [6:0] bytes [0:15];
    reg [4:0] head; // the oldest buffer, a turn (sixteen) ahead
    reg [4:0] tail; // the next buffer to fill

    assign next_o   = tail[3:0];
    assign oldest_o = head[3:0];
    assign bytes_o  = bytes[head[3:0]];
    assign free_o   = head - tail;

    always @(posedge clk_i) begin
        if (push_i)
            bytes[tail[3:0]] <= bytes_i;
        tail <= tail + {4'd0, push_i};
        head <= head + {4'd0, pop_i};
        if (rst_i) begin
            head <= 5'd16;
            tail <= 5'd0;
        end
    end

`ifdef FORMAL
`include "modem_ring_proof.vh"
`endif
`ifdef COVER_POINTS
    is_full: cover property (@(posedge clk_i) free_o == 5'd0);
    both_at_once: cover property (@(posedge clk_i) push_i && pop_i);
`endif
endmodule
