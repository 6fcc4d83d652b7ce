// SPDX-License-Identifier: MIT
//
// camera_buffers: which of the buffers 1..3 is written, holds the newest whole frame, belongs to
// another core.

`default_nettype none

module camera_buffers (
    input  wire       clk_i,
    input  wire       rst_i,
    input  wire       active_i,  // frames are captured; else none is offered
    input  wire       kept_i,    // the frame that was written is whole in memory: it is the newest, and offered
    output reg  [1:0] writing_o,
    output reg  [1:0] newest_o,
    output reg        offered_o,
    input  wire       take_i     // the other core takes the newest, and returns its old one
);
    reg [1:0] used; // of the other core

    wire       taken    = offered_o && take_i;
    wire [1:0] reserved = taken ? newest_o : used;

    always @(posedge clk_i) begin
        if (kept_i) begin
            newest_o  <= writing_o;
            writing_o <= writing_o ^ reserved; // the buffer of 1, 2, 3 that is neither
        end
        offered_o <= kept_i || (offered_o && !taken && active_i);
        used      <= reserved;
        if (rst_i) begin
            writing_o <= 2'd1;
            newest_o  <= 2'd2;
            used      <= 2'd3;
            offered_o <= 1'b0;
        end
    end

`ifdef FORMAL
`include "camera_buffers_proof.vh"
`endif
`ifdef COVER_POINTS
    taken_while_next_is_kept: cover property (@(posedge clk_i) kept_i && taken);
`endif
endmodule
