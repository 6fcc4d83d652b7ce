// SPDX-License-Identifier: MIT
//
// RAMB8BWER: the 8-Kbit block RAM of Spartan-6 (UG383), with the ports that Yosys gives it.
`default_nettype none

module RAMB8BWER #(
    parameter integer DATA_WIDTH_A = 0, // bits of a word with its parity; 0: the port is not used
    parameter integer DATA_WIDTH_B = 0,
    parameter integer DOA_REG = 0,      // output registers: not modelled
    parameter integer DOB_REG = 0,
    parameter EN_RSTRAM_A = "TRUE", EN_RSTRAM_B = "TRUE",
    parameter RSTTYPE = "SYNC",
    parameter RST_PRIORITY_A = "CE", RST_PRIORITY_B = "CE",
    parameter WRITE_MODE_A = "WRITE_FIRST", WRITE_MODE_B = "WRITE_FIRST",
    parameter RAM_MODE = "TDP", // "SDP": A writes and B reads, both 36 bits wide
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
        if (DOA_REG != 0 || DOB_REG != 0 || EN_RSTRAM_A != "TRUE" || EN_RSTRAM_B != "TRUE" ||
            (RAM_MODE == "SDP" && (DATA_WIDTH_A != 36 || DATA_WIDTH_B != 36)))
            block_ram_has_no_model_of_this_mode u_none();
    endgenerate
    // A reset of RSTTYPE "ASYNC" acts at the next edge here: Yosys ties it low.
    wire unused = &{1'b0, REGCEA, REGCEBREGCE};

    localparam SDP = RAM_MODE == "SDP";
    wire [35:0] out_a, out_b;
    assign {DOPADOP, DOADO} = SDP ? {out_b[33:32], out_b[15:0]} : {out_a[33:32], out_a[15:0]};
    assign {DOPBDOP, DOBDO} = SDP ? {out_b[35:34], out_b[31:16]} : {out_b[33:32], out_b[15:0]};

    block_ram #(
        .ADDR_BITS(13), .WIDTH_A(DATA_WIDTH_A), .WIDTH_B(DATA_WIDTH_B), .MODE_A(WRITE_MODE_A),
        .MODE_B(WRITE_MODE_B), .START_A({2'd0, INIT_A[17:16], 16'd0, INIT_A[15:0]}),
        .START_B({SDP ? INIT_B[17:16] : 2'd0, SDP ? INIT_A[17:16] : INIT_B[17:16],
                  SDP ? INIT_B[15:0] : 16'd0, SDP ? INIT_A[15:0] : INIT_B[15:0]}),
        .RESET_A({2'd0, SRVAL_A[17:16], 16'd0, SRVAL_A[15:0]}),
        .RESET_B({SDP ? SRVAL_B[17:16] : 2'd0, SDP ? SRVAL_A[17:16] : SRVAL_B[17:16],
                  SDP ? SRVAL_B[15:0] : 16'd0, SDP ? SRVAL_A[15:0] : SRVAL_B[15:0]}),
        .PRIORITY_A(RST_PRIORITY_A), .PRIORITY_B(RST_PRIORITY_B),
        .INIT_P({INITP_03, INITP_02, INITP_01, INITP_00}),
        .INIT({INIT_1F, INIT_1E, INIT_1D, INIT_1C, INIT_1B, INIT_1A, INIT_19, INIT_18,
               INIT_17, INIT_16, INIT_15, INIT_14, INIT_13, INIT_12, INIT_11, INIT_10,
               INIT_0F, INIT_0E, INIT_0D, INIT_0C, INIT_0B, INIT_0A, INIT_09, INIT_08,
               INIT_07, INIT_06, INIT_05, INIT_04, INIT_03, INIT_02, INIT_01, INIT_00})
    ) u_ram (
        .clk_a_i(CLKAWRCLK), .en_a_i(ENAWREN), .rst_a_i(RSTA),
        .we_a_i(SDP ? {WEBWEU, WEAWEL} : {2'd0, WEAWEL}), .addr_a_i(ADDRAWRADDR),
        .data_a_i(SDP ? {DIPBDIP, DIPADIP, DIBDI, DIADI} : {2'd0, DIPADIP, 16'd0, DIADI}),
        .data_a_o(out_a),
        .clk_b_i(CLKBRDCLK), .en_b_i(ENBRDEN), .rst_b_i(RSTBRST),
        .we_b_i(SDP ? 4'd0 : {2'd0, WEBWEU}), .addr_b_i(ADDRBRDADDR),
        .data_b_i({2'd0, DIPBDIP, 16'd0, DIBDI}), .data_b_o(out_b));
endmodule

`default_nettype wire
