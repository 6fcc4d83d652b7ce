// SPDX-License-Identifier: MIT
//
// camera_buffers: assigns roles to the three buffers 1..3: one is being written, one contains the
// newest complete frame, and one is used by another core.

`default_nettype none

module camera_buffers (
    input  wire       clk_i,
    input  wire       rst_i,
    input  wire       active_i,  // capturing is on; while it is off, no frame is offered
    // the frame in buffer writing_o is completely in memory. It becomes the newest frame and is
    // offered.
    input  wire       kept_i,
    output reg  [1:0] writing_o,
    output reg  [1:0] newest_o,
    output reg        offered_o,
    // the other core takes the newest frame and gives back the buffer that it used before
    input  wire       take_i
);
    reg [1:0] used; // buffer that the other core uses

    wire       taken    = offered_o && take_i;
    wire [1:0] reserved = taken ? newest_o : used;

    always @(posedge clk_i) begin
        if (kept_i) begin
            newest_o  <= writing_o;
            // the only buffer that is neither being written nor reserved
            writing_o <= writing_o ^ reserved;
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
    // whole: one bit per buffer, high if the buffer contains a complete frame. kept_i sets the bit;
    // the start of the next frame in the buffer clears it.
    reg       past = 1'b0;
    reg [3:1] whole = 3'b000;
    reg       has = 1'b0;  // high if the other core has taken a buffer
    reg [1:0] held = 2'd0; // buffer that the other core has taken
    always @(posedge clk_i) begin
        past <= 1'b1;
        if (rst_i) begin
            whole <= 3'b000;
            has   <= 1'b0;
            held  <= 2'd0;
        end else begin
            whole <= (whole | ({2'b00, kept_i} << (writing_o - 2'd1))) &
                ~(3'b001 << ((kept_i ? writing_o ^ reserved : writing_o) - 2'd1));
            if (taken) begin
                has  <= 1'b1;
                held <= newest_o;
            end
        end
    end
    always @* begin
        assume (past || rst_i);
        if (past) begin
            // The three roles always belong to three different buffers.
            assert (writing_o != 2'd0 && newest_o != 2'd0 && used != 2'd0 && writing_o != newest_o);
            assert (writing_o != used && (!offered_o || newest_o != used));
            // The buffer of the other core and the offered buffer are never written, and both
            // contain complete frames.
            assert (!has || (held == used && held != writing_o && whole[held]));
            assert (!offered_o || whole[newest_o]);
            assert (!whole[writing_o]);
        end
        cover (past && has && offered_o && held == 2'd1);
        cover (past && has && held == newest_o && kept_i);
    end
`endif
`ifdef COVER_POINTS
    taken_while_next_is_kept: cover property (@(posedge clk_i) kept_i && taken);
`endif
endmodule
