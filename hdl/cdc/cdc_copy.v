// SPDX-License-Identifier: MIT
//
// cdc_copy: a register in the clock domain clk_i that copies a bus from another clock domain or
// from pins.
//
// All logic after this register sees the same value, but while the bus changes, the value is
// arbitrary. Use the module only if a synchronised flag shows that the bus has been stable since
// the previous clock (cdc_bus), or if any value is harmless. The module has no reset. Constraint:
// one clock period from the bus to the copy.

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
