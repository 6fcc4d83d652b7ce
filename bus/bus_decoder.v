// SPDX-License-Identifier: MIT
//
// bus_decoder: connects the master of the register bus to SLOTS slots of 16 words (docs/bus.md).
//
// The master presents address and direction one clock before valid, and the decoder stores them in
// registers, so no path leads from the master's address through a slot. Each slot has its own word
// address, which is 0 while the slot is not selected; a common word address would have hundreds of
// loads. An access to a slot above SLOTS-1 ends at once with an error and data 0.

`default_nettype none

module bus_decoder #(
    parameter SLOTS = 3 // number of slots, 1..64
) (
    input  wire                clk_i,
    // master
    input  wire                bus_valid_i,
    input  wire                bus_write_i,
    input  wire [9:0]          bus_addr_i, // word address: 16 * slot + word
    input  wire [31:0]         bus_wdata_i,
    output wire                bus_ready_o,
    output wire [31:0]         bus_rdata_o,
    output wire                bus_error_o,
    // slots; the vectors have 1, 4 or 32 bits per slot, with slot 0 in the lowest bits
    output wire [SLOTS-1:0]    slot_valid_o,
    output wire                slot_write_o,
    output reg  [4*SLOTS-1:0]  slot_addr_o,
    output wire [31:0]         slot_wdata_o,
    input  wire [SLOTS-1:0]    slot_ready_i,
    input  wire [32*SLOTS-1:0] slot_rdata_i,
    input  wire [SLOTS-1:0]    slot_error_i
);
    wire [5:0] slot = bus_addr_i[9:4];

    reg [SLOTS-1:0] selected;
    reg             mapped, write;
    integer s;
    always @(posedge clk_i) begin
        for (s = 0; s < SLOTS; s = s + 1) begin
            selected[s] <= {26'd0, slot} == s;
            slot_addr_o[4*s +: 4] <= {26'd0, slot} == s ? bus_addr_i[3:0] : 4'd0;
        end
        mapped <= {26'd0, slot} < SLOTS;
        write  <= bus_write_i;
    end

    // With up to three slots, AND and OR combine the answers, one LUT per bit. With more slots,
    // each group of eight slots has an 8:1 multiplexer (two LUTs and a MUXF7 per bit), and AND and
    // OR combine the groups. The last group is filled with zeros.
    generate
        if (SLOTS < 4) begin : g_few
            reg [31:0] rdata;
            integer i;
            always @* begin
                rdata = 32'd0;
                for (i = 0; i < SLOTS; i = i + 1)
                    rdata = rdata | ({32{selected[i]}} & slot_rdata_i[32*i +: 32]);
            end
            assign bus_rdata_o = rdata;
        end else begin : g_many
            localparam GROUPS = (SLOTS + 7) / 8;
            reg [2:0]            index;
            // one bit per group, high if the group is selected; not used with fewer than eight
            // slots, because an access to a missing slot then selects the last entry of the only
            // group, which is 0
            reg [GROUPS-1:0]     group;
            // read data that may still be selected, per group; each bit of the index halves the
            // number of words, until one word per group is left
            reg [256*GROUPS-1:0] left;
            reg [31:0]           rdata;
            integer g, b, i;
            always @(posedge clk_i) begin
                index <= {26'd0, slot} < SLOTS ? slot[2:0] : 3'd7;
                for (g = 0; g < GROUPS; g = g + 1)
                    group[g] <= {29'd0, slot[5:3]} == g;
            end
            always @* begin
                left = {256*GROUPS{1'b0}};
                left[32*SLOTS-1:0] = slot_rdata_i;
                rdata = 32'd0;
                for (g = 0; g < GROUPS; g = g + 1) begin
                    for (b = 2; b >= 0; b = b - 1)
                        for (i = 0; i < 1 << b; i = i + 1)
                            if (index[b])
                                left[256*g + 32*i +: 32] = left[256*g + 32*(i + (1 << b)) +: 32];
                    rdata = rdata | ({32{SLOTS < 8 || group[g]}} & left[256*g +: 32]);
                end
            end
            assign bus_rdata_o = rdata;
        end
    endgenerate

    assign slot_valid_o = selected & {SLOTS{bus_valid_i}};
    assign slot_write_o = write;
    assign slot_wdata_o = bus_wdata_i;
    assign bus_ready_o  = !mapped || |(selected & slot_ready_i);
    assign bus_error_o  = !mapped || |(selected & slot_error_i);

`ifdef FORMAL
    // The rules for the master are assumed. The registers here depend only on the inputs of the
    // previous clock, so the properties hold for all inputs.
    reg             past = 1'b0;
    reg [10:0]      shown; // address and direction that were presented one clock ago
    reg [SLOTS-1:0] one;   // one slot that the prover chooses, one-hot
    integer k;
    always @(posedge clk_i) begin
        past  <= 1'b1;
        shown <= {bus_write_i, bus_addr_i};
    end
    always @* assume (!bus_valid_i || shown == {bus_write_i, bus_addr_i});
    always @* if (past && bus_valid_i) begin
        one    = {{(SLOTS-1){1'b0}}, 1'b1} << slot;
        for (k = 0; k < SLOTS; k = k + 1)
            if (one[k])
                assert ({bus_ready_o, bus_error_o, bus_rdata_o, slot_addr_o[4*k +: 4]} ==
                        {slot_ready_i[k], slot_error_i[k], slot_rdata_i[32*k +: 32],
                         bus_addr_i[3:0]});
            else
                assert (slot_addr_o[4*k +: 4] == 4'd0);
        assert (slot_valid_o == one);
        assert (one != {SLOTS{1'b0}} || (bus_ready_o && bus_error_o && bus_rdata_o == 32'd0));
        assert ({slot_write_o, slot_wdata_o} == {bus_write_i, bus_wdata_i});
        cover (slot_valid_o[SLOTS-1] && bus_ready_o && !bus_error_o);
        cover (SLOTS == 64 || slot_valid_o == {SLOTS{1'b0}});
    end
    always @* if (!bus_valid_i)
        assert (slot_valid_o == {SLOTS{1'b0}});
`endif
`ifdef COVER_POINTS
    no_such_slot: cover property (@(posedge clk_i) bus_valid_i && !mapped);
    slot_waits: cover property (@(posedge clk_i) bus_valid_i && !bus_ready_o);
    slot_refuses: cover property (@(posedge clk_i) bus_valid_i && bus_ready_o && mapped &&
                                  bus_error_o);
`endif
endmodule
