// SPDX-License-Identifier: MIT
// Replacement for a flip-flop that must keep its value when the gate of its clock closes (techmap
// of idle_proof). In rest_proof, the flip-flop must also have kept its value in the previous clock
// (REST), or its clock is stopped (HELD).
module \$dff (input CLK, input [WIDTH-1:0] D, output [WIDTH-1:0] Q);
    parameter WIDTH = 1;
    parameter CLK_POLARITY = 1'b1;
`ifdef HELD
    \$anyconst #(.WIDTH(WIDTH)) _TECHMAP_REPLACE_ (.Y(Q));
`else
`ifdef REST
    \$assume u_before (.A(D == Q), .EN(!CLK));
`endif
    \$assert _TECHMAP_REPLACE_ (.A(D == Q), .EN(CLK));
    genvar b;
    generate
        for (b = 0; b < WIDTH; b = b + 1) begin : g_bit
            \$_DFF_P_ u_bit (.C(CLK), .D(D[b]), .Q(Q[b]));
        end
    endgenerate
`endif
endmodule

// Replacement for a memory, which must not be written while the gate is closed; its output is
// unconstrained.
module \$mem_v2 (input [RD_PORTS-1:0] RD_CLK, RD_EN, RD_ARST, RD_SRST,
                 input [RD_PORTS*ABITS-1:0] RD_ADDR, output [RD_PORTS*WIDTH-1:0] RD_DATA,
                 input [WR_PORTS-1:0] WR_CLK, input [WR_PORTS*WIDTH-1:0] WR_EN, WR_DATA,
                 input [WR_PORTS*ABITS-1:0] WR_ADDR);
    parameter MEMID = "", SIZE = 0, OFFSET = 0, ABITS = 0, WIDTH = 0, INIT = 0, RD_PORTS = 0,
              RD_CLK_ENABLE = 0, RD_CLK_POLARITY = 0, RD_TRANSPARENCY_MASK = 0,
              RD_COLLISION_X_MASK = 0, RD_WIDE_CONTINUATION = 0, RD_CE_OVER_SRST = 0,
              RD_ARST_VALUE = 0, RD_SRST_VALUE = 0, RD_INIT_VALUE = 0, WR_PORTS = 0,
              WR_CLK_ENABLE = 0, WR_CLK_POLARITY = 0, WR_PRIORITY_MASK = 0,
              WR_WIDE_CONTINUATION = 0;
    \$assert _TECHMAP_REPLACE_ (.A(WR_EN == 0), .EN(WR_CLK[0]));
endmodule
