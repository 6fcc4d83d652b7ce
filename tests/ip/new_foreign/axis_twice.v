// SPDX-License-Identifier: MIT
//
// axis_twice: gives each word of 64 bits twice, bytes as they are kept: packets become longer.

`default_nettype none

module axis_twice (
    input  wire        clk,
    input  wire        rst,
    input  wire [63:0] in_tdata,
    input  wire [7:0]  in_tkeep,
    input  wire        in_tlast,
    input  wire        in_tvalid,
    output wire        in_tready,
    output wire [63:0] out_tdata,
    output wire [7:0]  out_tkeep,
    output wire        out_tlast,
    output wire        out_tvalid,
    input  wire        out_tready
);
    reg second;
    assign out_tdata  = in_tdata;
    assign out_tkeep  = second ? in_tkeep : 8'hFF;
    assign out_tlast  = in_tlast && second;
    assign out_tvalid = in_tvalid;
    assign in_tready  = out_tready && second;
    always @(posedge clk)
        if (rst)
            second <= 1'b0;
        else if (out_tvalid && out_tready)
            second <= !second;
endmodule
