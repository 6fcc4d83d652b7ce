// SPDX-License-Identifier: MIT
//
// cdc_reset: reset synchroniser. The reset begins at once, even if the clock does not run. It ends
// synchronously to clk_i, two to three clocks after the end of rst_async_i.
//
// After configuration rst_o is active until the clock has run. Constraint: paths from rst_async_i
// are ignored for timing; paths from rst_o are not ignored.

`default_nettype none

module cdc_reset (
    input  wire clk_i,
    input  wire rst_async_i,
    output wire rst_o
);
    (* ASYNC_REG = "TRUE", SHREG_EXTRACT = "NO", KEEP = "TRUE" *) reg rst_meta, rst_sync;
    initial {rst_meta, rst_sync} = 2'b11;
    assign rst_o = rst_sync;
    always @(posedge clk_i or posedge rst_async_i)
        if (rst_async_i)
            {rst_sync, rst_meta} <= 2'b11;
        else
            {rst_sync, rst_meta} <= {rst_meta, 1'b0};
endmodule
