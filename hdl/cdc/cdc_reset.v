// SPDX-License-Identifier: MIT
//
// cdc_reset: makes a reset that begins at once, clock or no clock, and ends with clk_i, two to
// three clocks after rst_async_i.
//
// rst_o is active from configuration on until the clock has run. Constraint: rst_async_i is no
// timing path; rst_o is one.

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
