// SPDX-License-Identifier: MIT
//
// modem_ring_proof: a length comes out as it went in, and the count of free buffers is true.
// Included at the foot of modem_ring.v, only for the prover.

    reg past = 1'b0;
    initial assume (rst_i);
    // The length of any one buffer in any one turn comes out as it went in, in its place.
    (* anyconst *) reg [4:0] place;
    reg [6:0] length;
    reg       inside = 1'b0;
    wire [4:0] used = 5'd16 - free_o;
    wire [4:0] oldest = head - 5'd16;
    always @(posedge clk_i) begin
        past <= 1'b1;
        assume (!(push_i && free_o == 5'd0));
        assume (!(pop_i && free_o == 5'd16));
        if (push_i && tail == place) begin
            length <= bytes_i;
            inside <= 1'b1;
        end
        if ((pop_i && oldest == place) || rst_i)
            inside <= 1'b0;
        if (past) begin
            assert (free_o <= 5'd16);
            if ($past(rst_i))
                assert (free_o == 5'd16);
            if (inside) begin
                assert ((place - oldest) < used);
                assert (bytes[place[3:0]] == length);
            end
            if (inside && oldest == place)
                assert (bytes_o == length && oldest_o == place[3:0]);
            cover (free_o == 5'd0);
            cover ($past(free_o) == 5'd0 && free_o == 5'd1 && inside);
        end
    end
