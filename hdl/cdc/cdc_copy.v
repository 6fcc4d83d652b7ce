// SPDX-License-Identifier: MIT
//
// cdc_copy: a register in clk_i follows a bus of another clock, or of pins.
//
// A copy is one value for all logic behind it, but an arbitrary one while the bus moves. It is used
// only where a synchronised flag says that the bus has rested since the clock before (cdc_bus), or
// where any value does no harm.
// There is no reset. Constraint: a clock's period from the bus to the copy.

`default_nettype none

module cdc_copy #(
    parameter WIDTH = 8
) (
    input  wire             clk_i,
    input  wire [WIDTH-1:0] bus_async_i,
    output wire [WIDTH-1:0] bus_sync_o
);
    (* SHREG_EXTRACT = "NO", KEEP = "TRUE" *) reg [WIDTH-1:0] bus_copy;
    assign bus_sync_o = bus_copy;
`ifdef VERILATOR
    localparam TOGETHER = 0;
    `include "cdc_random.vh"
    reg [WIDTH-1:0] bus_was;
    always @(posedge clk_i) begin
        bus_was  <= bus_async_i;
        bus_copy <= bus_async_i ^ late(bus_async_i ^ bus_was);
    end
`else
    always @(posedge clk_i) bus_copy <= bus_async_i;
`endif
endmodule
