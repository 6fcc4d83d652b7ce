// SPDX-License-Identifier: MIT
//
// product: maps a multiplier to rows of adders, in an order that does not depend on the names of
// its operands. Yosys's mapping adds in the order of net names, so RTL and netlist would get
// different logic for the same product.

(* techmap_celltype = "$mul" *)
module product (A, B, Y);
    parameter A_SIGNED = 0, B_SIGNED = 0, A_WIDTH = 1, B_WIDTH = 1, Y_WIDTH = 1;
    input  [A_WIDTH-1:0] A;
    input  [B_WIDTH-1:0] B;
    output [Y_WIDTH-1:0] Y;
    wire [Y_WIDTH-1:0] factor = {{Y_WIDTH{A_SIGNED && A[A_WIDTH-1]}}, A};
    wire [(B_WIDTH+1)*Y_WIDTH-1:0] sums;
    assign sums[Y_WIDTH-1:0] = 0;
    genvar n;
    generate
        for (n = 0; n < B_WIDTH; n = n + 1) begin : g_row
            wire [Y_WIDTH-1:0] sum = sums[n*Y_WIDTH +: Y_WIDTH];
            wire [Y_WIDTH-1:0] row = {Y_WIDTH{B[n]}} & (factor << n);
            if (B_SIGNED && n == B_WIDTH - 1)
                assign sums[(n+1)*Y_WIDTH +: Y_WIDTH] = sum - row;
            else
                assign sums[(n+1)*Y_WIDTH +: Y_WIDTH] = sum + row;
        end
    endgenerate
    assign Y = sums[B_WIDTH*Y_WIDTH +: Y_WIDTH];
endmodule
