// SPDX-License-Identifier: MIT
//
// camera_buffers_proof: the properties of camera_buffers (formal.camera_buffers); included at its
// foot, only for the prover.

    // A buffer is whole from the clock in which it is kept until the next frame is begun in it.
    reg       past = 1'b0;
    reg [3:1] whole = 3'b000;
    reg       has = 1'b0;  // the other core has taken one
    reg [1:0] held = 2'd0; // it is this one
    always @(posedge clk_i) begin
        past <= 1'b1;
        if (rst_i) begin
            whole <= 3'b000;
            has   <= 1'b0;
            held  <= 2'd0;
        end else begin
            whole <= (whole | ({2'b00, kept_i} << (writing_o - 2'd1))) & ~(3'b001 << ((kept_i ? writing_o ^ reserved : writing_o) - 2'd1));
            if (taken) begin
                has  <= 1'b1;
                held <= newest_o;
            end
        end
    end
    always @* begin
        assume (past || rst_i);
        if (past) begin
            // Three buffers, three parts.
            assert (writing_o != 2'd0 && newest_o != 2'd0 && used != 2'd0 && writing_o != newest_o);
            assert (writing_o != used && (!offered_o || newest_o != used));
            // The other core's buffer and the offered one are never written; both are whole.
            assert (!has || (held == used && held != writing_o && whole[held]));
            assert (!offered_o || whole[newest_o]);
            assert (!whole[writing_o]);
        end
        cover (past && has && offered_o && held == 2'd1);
        cover (past && has && held == newest_o && kept_i);
    end
