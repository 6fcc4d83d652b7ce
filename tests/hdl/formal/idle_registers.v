// SPDX-License-Identifier: MIT
// A flip-flop whose value stays when its clock's gate closes: techmap for idle_proof.
module \$dff (input CLK, input [WIDTH-1:0] D, output [WIDTH-1:0] Q);
    parameter WIDTH = 1;
    parameter CLK_POLARITY = 1'b1;
    \$assert _TECHMAP_REPLACE_ (.A(D == Q), .EN(CLK));
    genvar b;
    generate
        for (b = 0; b < WIDTH; b = b + 1) begin : g_bit
            \$_DFF_P_ u_bit (.C(CLK), .D(D[b]), .Q(Q[b]));
        end
    endgenerate
endmodule
