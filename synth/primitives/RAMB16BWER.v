// SPDX-License-Identifier: MIT
//
// RAMB16BWER: the 16-Kbit block RAM of Spartan-6 (UG383), with the ports that Yosys gives it.
`default_nettype none

module RAMB16BWER #(
    parameter integer DATA_WIDTH_A = 0, // bits of a word with its parity; 0: the port is not used
    parameter integer DATA_WIDTH_B = 0,
    parameter integer DOA_REG = 0,      // output registers: not modelled
    parameter integer DOB_REG = 0,
    parameter EN_RSTRAM_A = "TRUE", EN_RSTRAM_B = "TRUE",
    parameter RSTTYPE = "SYNC",
    parameter RST_PRIORITY_A = "CE", RST_PRIORITY_B = "CE",
    parameter WRITE_MODE_A = "WRITE_FIRST", WRITE_MODE_B = "WRITE_FIRST",
    parameter SIM_DEVICE = "SPARTAN6",
    parameter [35:0] INIT_A = 36'd0, INIT_B = 36'd0, SRVAL_A = 36'd0, SRVAL_B = 36'd0,
    parameter [255:0]
        INITP_00 = 256'd0, INITP_01 = 256'd0, INITP_02 = 256'd0, INITP_03 = 256'd0,
        INITP_04 = 256'd0, INITP_05 = 256'd0, INITP_06 = 256'd0, INITP_07 = 256'd0,
    parameter [255:0]
        INIT_00 = 256'd0, INIT_01 = 256'd0, INIT_02 = 256'd0, INIT_03 = 256'd0,
        INIT_04 = 256'd0, INIT_05 = 256'd0, INIT_06 = 256'd0, INIT_07 = 256'd0,
        INIT_08 = 256'd0, INIT_09 = 256'd0, INIT_0A = 256'd0, INIT_0B = 256'd0,
        INIT_0C = 256'd0, INIT_0D = 256'd0, INIT_0E = 256'd0, INIT_0F = 256'd0,
        INIT_10 = 256'd0, INIT_11 = 256'd0, INIT_12 = 256'd0, INIT_13 = 256'd0,
        INIT_14 = 256'd0, INIT_15 = 256'd0, INIT_16 = 256'd0, INIT_17 = 256'd0,
        INIT_18 = 256'd0, INIT_19 = 256'd0, INIT_1A = 256'd0, INIT_1B = 256'd0,
        INIT_1C = 256'd0, INIT_1D = 256'd0, INIT_1E = 256'd0, INIT_1F = 256'd0,
        INIT_20 = 256'd0, INIT_21 = 256'd0, INIT_22 = 256'd0, INIT_23 = 256'd0,
        INIT_24 = 256'd0, INIT_25 = 256'd0, INIT_26 = 256'd0, INIT_27 = 256'd0,
        INIT_28 = 256'd0, INIT_29 = 256'd0, INIT_2A = 256'd0, INIT_2B = 256'd0,
        INIT_2C = 256'd0, INIT_2D = 256'd0, INIT_2E = 256'd0, INIT_2F = 256'd0,
        INIT_30 = 256'd0, INIT_31 = 256'd0, INIT_32 = 256'd0, INIT_33 = 256'd0,
        INIT_34 = 256'd0, INIT_35 = 256'd0, INIT_36 = 256'd0, INIT_37 = 256'd0,
        INIT_38 = 256'd0, INIT_39 = 256'd0, INIT_3A = 256'd0, INIT_3B = 256'd0,
        INIT_3C = 256'd0, INIT_3D = 256'd0, INIT_3E = 256'd0, INIT_3F = 256'd0
) (
    input  wire        CLKA, ENA, REGCEA, RSTA,
    input  wire [3:0]  WEA,
    input  wire [13:0] ADDRA,
    input  wire [31:0] DIA,
    input  wire [3:0]  DIPA,
    output wire [31:0] DOA,
    output wire [3:0]  DOPA,
    input  wire        CLKB, ENB, REGCEB, RSTB,
    input  wire [3:0]  WEB,
    input  wire [13:0] ADDRB,
    input  wire [31:0] DIB,
    input  wire [3:0]  DIPB,
    output wire [31:0] DOB,
    output wire [3:0]  DOPB
);
    generate
        if (DOA_REG != 0 || DOB_REG != 0 || EN_RSTRAM_A != "TRUE" || EN_RSTRAM_B != "TRUE")
            block_ram_has_no_model_of_this_mode u_none();
    endgenerate
    // A reset of RSTTYPE "ASYNC" acts at the next edge here: Yosys ties it low.
    wire unused = &{1'b0, REGCEA, REGCEB};

    block_ram #(
        .ADDR_BITS(14), .WIDTH_A(DATA_WIDTH_A), .WIDTH_B(DATA_WIDTH_B), .MODE_A(WRITE_MODE_A),
        .MODE_B(WRITE_MODE_B), .START_A(INIT_A), .START_B(INIT_B), .RESET_A(SRVAL_A),
        .RESET_B(SRVAL_B), .PRIORITY_A(RST_PRIORITY_A), .PRIORITY_B(RST_PRIORITY_B),
        .INIT_P({INITP_07, INITP_06, INITP_05, INITP_04, INITP_03, INITP_02, INITP_01, INITP_00}),
        .INIT({INIT_3F, INIT_3E, INIT_3D, INIT_3C, INIT_3B, INIT_3A, INIT_39, INIT_38,
               INIT_37, INIT_36, INIT_35, INIT_34, INIT_33, INIT_32, INIT_31, INIT_30,
               INIT_2F, INIT_2E, INIT_2D, INIT_2C, INIT_2B, INIT_2A, INIT_29, INIT_28,
               INIT_27, INIT_26, INIT_25, INIT_24, INIT_23, INIT_22, INIT_21, INIT_20,
               INIT_1F, INIT_1E, INIT_1D, INIT_1C, INIT_1B, INIT_1A, INIT_19, INIT_18,
               INIT_17, INIT_16, INIT_15, INIT_14, INIT_13, INIT_12, INIT_11, INIT_10,
               INIT_0F, INIT_0E, INIT_0D, INIT_0C, INIT_0B, INIT_0A, INIT_09, INIT_08,
               INIT_07, INIT_06, INIT_05, INIT_04, INIT_03, INIT_02, INIT_01, INIT_00})
    ) u_ram (
        .clk_a_i(CLKA), .en_a_i(ENA), .rst_a_i(RSTA), .we_a_i(WEA), .addr_a_i(ADDRA),
        .data_a_i({DIPA, DIA}), .data_a_o({DOPA, DOA}),
        .clk_b_i(CLKB), .en_b_i(ENB), .rst_b_i(RSTB), .we_b_i(WEB), .addr_b_i(ADDRB),
        .data_b_i({DIPB, DIB}), .data_b_o({DOPB, DOB}));
endmodule

`default_nettype wire
