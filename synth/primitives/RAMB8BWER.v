// SPDX-License-Identifier: MIT
//
// RAMB8BWER: the 8-Kbit block RAM of Spartan-6 (Xilinx UG383, Block RAM) as the port FIFOs have it:
// port A writes and port B reads words of 36 bits. For simulation of netlists, with the ports that
// Yosys gives it; a netlist with another mode or with output registers does not build.
//
// Data that is read where A writes at the same edge is not valid (UG383, "Conflict Avoidance"),
// unless A is READ_FIRST: here half of its bits are not the old ones, half not the new ones.
// Collisions of ports with different clocks are not modelled.
`default_nettype none

module RAMB8BWER #(
    parameter integer DATA_WIDTH_A = 36, DATA_WIDTH_B = 36, // Yosys gives all of these
    parameter integer DOA_REG = 0, DOB_REG = 0,
    parameter EN_RSTRAM_A = "TRUE", EN_RSTRAM_B = "TRUE",
    parameter RSTTYPE = "SYNC", // "ASYNC" acts at the next edge here: Yosys ties the reset low
    parameter RST_PRIORITY_A = "CE", RST_PRIORITY_B = "CE",
    parameter WRITE_MODE_A = "WRITE_FIRST", WRITE_MODE_B = "WRITE_FIRST",
    parameter RAM_MODE = "SDP",
    parameter [17:0] INIT_A = 18'd0, INIT_B = 18'd0, SRVAL_A = 18'd0, SRVAL_B = 18'd0,
    parameter [255:0]
        INITP_00 = 256'd0, INITP_01 = 256'd0, INITP_02 = 256'd0, INITP_03 = 256'd0,
    parameter [255:0]
        INIT_00 = 256'd0, INIT_01 = 256'd0, INIT_02 = 256'd0, INIT_03 = 256'd0,
        INIT_04 = 256'd0, INIT_05 = 256'd0, INIT_06 = 256'd0, INIT_07 = 256'd0,
        INIT_08 = 256'd0, INIT_09 = 256'd0, INIT_0A = 256'd0, INIT_0B = 256'd0,
        INIT_0C = 256'd0, INIT_0D = 256'd0, INIT_0E = 256'd0, INIT_0F = 256'd0,
        INIT_10 = 256'd0, INIT_11 = 256'd0, INIT_12 = 256'd0, INIT_13 = 256'd0,
        INIT_14 = 256'd0, INIT_15 = 256'd0, INIT_16 = 256'd0, INIT_17 = 256'd0,
        INIT_18 = 256'd0, INIT_19 = 256'd0, INIT_1A = 256'd0, INIT_1B = 256'd0,
        INIT_1C = 256'd0, INIT_1D = 256'd0, INIT_1E = 256'd0, INIT_1F = 256'd0
) (
    input  wire        CLKAWRCLK, ENAWREN, REGCEA, RSTA,
    input  wire [1:0]  WEAWEL,
    input  wire [12:0] ADDRAWRADDR,
    input  wire [15:0] DIADI,
    input  wire [1:0]  DIPADIP,
    output wire [15:0] DOADO,
    output wire [1:0]  DOPADOP,
    input  wire        CLKBRDCLK, ENBRDEN, REGCEBREGCE, RSTBRST,
    input  wire [1:0]  WEBWEU,
    input  wire [12:0] ADDRBRDADDR,
    input  wire [15:0] DIBDI,
    input  wire [1:0]  DIPBDIP,
    output wire [15:0] DOBDO,
    output wire [1:0]  DOPBDOP
);
    generate
        if (RAM_MODE != "SDP" || DATA_WIDTH_A != 36 || DATA_WIDTH_B != 36 || DOA_REG != 0 ||
            DOB_REG != 0 || EN_RSTRAM_A != "TRUE" || EN_RSTRAM_B != "TRUE")
            block_ram_has_no_model_of_this_mode u_none();
    endgenerate

    localparam [1023:0] INIT_P = {INITP_03, INITP_02, INITP_01, INITP_00};
    localparam [8191:0] INIT = {
        INIT_1F, INIT_1E, INIT_1D, INIT_1C, INIT_1B, INIT_1A, INIT_19, INIT_18,
        INIT_17, INIT_16, INIT_15, INIT_14, INIT_13, INIT_12, INIT_11, INIT_10,
        INIT_0F, INIT_0E, INIT_0D, INIT_0C, INIT_0B, INIT_0A, INIT_09, INIT_08,
        INIT_07, INIT_06, INIT_05, INIT_04, INIT_03, INIT_02, INIT_01, INIT_00};
    reg [35:0] rows [0:255]; // {parity, data}
    reg [35:0] out;
    integer i;
    initial begin
        for (i = 0; i < 256; i = i + 1)
            rows[i] = {INIT_P[4*i +: 4], INIT[32*i +: 32]};
        out = {INIT_B[17:16], INIT_A[17:16], INIT_B[15:0], INIT_A[15:0]};
    end

    wire [7:0]  to = ADDRAWRADDR[12:5], from = ADDRBRDADDR[12:5];
    wire [3:0]  bytes_written = {WEBWEU, WEAWEL} & {4{ENAWREN}};
    wire [35:0] mask = {bytes_written, {8{bytes_written[3]}}, {8{bytes_written[2]}},
                        {8{bytes_written[1]}}, {8{bytes_written[0]}}};
    wire [35:0] written = (rows[to] & ~mask) | ({DIPBDIP, DIPADIP, DIBDI, DIADI} & mask);
    wire [35:0] lost    = to == from && WRITE_MODE_A != "READ_FIRST" ? mask : 36'd0;
    wire [35:0] wrong   = (~rows[from] & 36'h555555555) | (~written & 36'haaaaaaaaa);
    assign {DOPBDOP, DOPADOP, DOBDO, DOADO} = out;
    wire unused = &{1'b0, REGCEA, REGCEBREGCE, RSTA};

    always @(posedge CLKAWRCLK)
        if (mask != 0)
            rows[to] <= written;
    always @(posedge CLKBRDCLK)
        if (RSTBRST && (ENBRDEN || RST_PRIORITY_B == "SR"))
            out <= {SRVAL_B[17:16], SRVAL_A[17:16], SRVAL_B[15:0], SRVAL_A[15:0]};
        else if (ENBRDEN)
            out <= (rows[from] & ~lost) | (wrong & lost);
endmodule

`default_nettype wire
