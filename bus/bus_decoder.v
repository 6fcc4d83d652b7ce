// SPDX-License-Identifier: MIT
//
// bus_decoder: one master of the register bus, SLOTS slots of 16 words (docs/bus.md).
//
// Slots above SLOTS-1 answer at once with error and data 0.

`default_nettype none

module bus_decoder #(
    parameter SLOTS = 3 // 1..64
) (
    // master
    input  wire                bus_valid_i,
    input  wire                bus_write_i,
    input  wire [9:0]          bus_addr_i, // slot * 16 + word
    input  wire [31:0]         bus_wdata_i,
    output wire                bus_ready_o,
    output wire [31:0]         bus_rdata_o,
    output wire                bus_error_o,
    // slots: one bit, or 32, a slot
    output wire [SLOTS-1:0]    slot_valid_o,
    output wire                slot_write_o,
    output wire [3:0]          slot_addr_o,
    output wire [31:0]         slot_wdata_o,
    input  wire [SLOTS-1:0]    slot_ready_i,
    input  wire [32*SLOTS-1:0] slot_rdata_i,
    input  wire [SLOTS-1:0]    slot_error_i
);
    wire [5:0] slot = bus_addr_i[9:4];

    wire [31:0] slot_rdata [0:SLOTS-1];
    wire [SLOTS-1:0] selected;
    genvar s;
    generate
        for (s = 0; s < SLOTS; s = s + 1) begin : g_slot
            assign selected[s] = {26'd0, slot} == s;
            assign slot_rdata[s] = slot_rdata_i[32*s +: 32];
        end
    endgenerate

    reg [31:0] rdata;
    integer i;
    always @* begin
        rdata = 32'd0;
        for (i = 0; i < SLOTS; i = i + 1)
            if (selected[i])
                rdata = slot_rdata[i];
    end

    wire mapped = |selected;

    assign slot_valid_o = selected & {SLOTS{bus_valid_i}};
    assign slot_write_o = bus_write_i;
    assign slot_addr_o  = bus_addr_i[3:0];
    assign slot_wdata_o = bus_wdata_i;
    assign bus_ready_o  = !mapped || |(selected & slot_ready_i);
    assign bus_error_o  = !mapped || |(selected & slot_error_i);
    assign bus_rdata_o  = rdata;
endmodule
