// SPDX-License-Identifier: MIT
//
// camera_buffers: keeps track of the three buffers, 1..3: one is being written, one contains the
// newest complete frame, and one belongs to another core.

`default_nettype none

module camera_buffers (
    input  wire       clk_i,
    input  wire       rst_i,
    input  wire       active_i,  // capture is on; otherwise no frame is offered
    // the frame being written is complete in memory; it becomes the newest and is offered
    input  wire       kept_i,
    output reg  [1:0] writing_o,
    output reg  [1:0] newest_o,
    output reg        offered_o,
    input  wire       take_i     // the other core takes the newest buffer and returns the one it
                                 // had
);
    reg [1:0] used; // buffer of the other core

    wire       taken    = offered_o && take_i;
    wire [1:0] reserved = taken ? newest_o : used;

    always @(posedge clk_i) begin
        if (kept_i) begin
            newest_o  <= writing_o;
            writing_o <= writing_o ^ reserved; // the remaining one of the buffers 1, 2 and 3
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
    // whole: one bit per buffer: it contains a complete frame. The bit is set by kept_i, and
    // cleared when the next frame begins in the buffer.
    reg       past = 1'b0;
    reg [3:1] whole = 3'b000;
    reg       has = 1'b0;  // the other core has taken a buffer
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
            // The other core's buffer and the offered buffer are never written, and both are
            // complete.
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
