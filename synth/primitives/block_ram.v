// SPDX-License-Identifier: MIT
//
// block_ram: models of RAMB16BWER and RAMB8BWER (Xilinx UG383, Spartan-6 Block RAM) for the
// simulation of netlists: one array with two ports, each with its own width.
//
// A port reads and writes at its clock edge while EN is high. If one port reads the address that
// the other port writes at the same edge, the read data is invalid unless the writing port is
// READ_FIRST (UG383, "Conflict Avoidance"). In this model, half of the bits of invalid data differ
// from the old data, and the other half differ from the new data. Output registers (DO_REG) and
// collisions of ports with different clocks are not modelled.
`default_nettype none

module block_ram #(
    // width of the address of a bit: 14 for 16 Kbit, 13 for 8 Kbit
    parameter integer ADDR_BITS = 14,
    // width of a word, bits: 0 (unused port), 1, 2, 4, 9, 18 or 36
    parameter integer WIDTH_A = 36,
    parameter integer WIDTH_B = 36,
    parameter MODE_A = "WRITE_FIRST", // what a port outputs during a write
    parameter MODE_B = "WRITE_FIRST",
    parameter [35:0] START_A = 36'd0, // output of each port after configuration: {parity, data}
    parameter [35:0] START_B = 36'd0,
    parameter [35:0] RESET_A = 36'd0, // output after a reset
    parameter [35:0] RESET_B = 36'd0,
    parameter PRIORITY_A = "CE",      // "CE": a reset needs EN; "SR": a reset does not need EN
    parameter PRIORITY_B = "CE",
    parameter [(1 << ADDR_BITS) - 1:0]     INIT   = 0,
    parameter [(1 << ADDR_BITS) / 8 - 1:0] INIT_P = 0 // parity bits, one bit per byte
) (
    input  wire                 clk_a_i,
    input  wire                 en_a_i,
    input  wire                 rst_a_i,
    input  wire [3:0]           we_a_i,  // byte enables of the word
    input  wire [ADDR_BITS-1:0] addr_a_i,
    input  wire [35:0]          data_a_i, // {parity, data}
    output reg  [35:0]          data_a_o,

    input  wire                 clk_b_i,
    input  wire                 en_b_i,
    input  wire                 rst_b_i,
    input  wire [3:0]           we_b_i,
    input  wire [ADDR_BITS-1:0] addr_b_i,
    input  wire [35:0]          data_b_i,
    output reg  [35:0]          data_b_o
);
    // Returns the number of data bits of a word, without parity.
    function integer data_bits(input integer width);
        data_bits = width >= 9 ? width / 9 * 8 : width;
    endfunction
    localparam integer DATA_A = data_bits(WIDTH_A), DATA_B = data_bits(WIDTH_B);

    // Each row of the memory has the size of the widest word: 32 bits and four parity bits.
    localparam integer ROWS = 1 << (ADDR_BITS - 5);
    reg [35:0] rows [0:ROWS-1];
    integer i;
    initial begin
        for (i = 0; i < ROWS; i = i + 1)
            rows[i] = {INIT_P[4*i +: 4], INIT[32*i +: 32]};
        data_a_o = START_A;
        data_b_o = START_B;
    end

    // Returns a mask of the bits of a row that a write of a word with these byte enables changes.
    function [35:0] mask(input integer width, input [4:0] place, input [3:0] we);
        reg [31:0] data;
        reg [3:0]  parity;
        begin
            data   = {{8{we[3]}}, {8{we[2]}}, {8{we[1]}}, {8{we[0]}}};
            parity = we;
            if (width < 36)
                data = data & ((32'd1 << data_bits(width)) - 1);
            if (width < 36)
                parity = parity & ((4'd1 << (width / 9)) - 4'd1);
            mask = {parity << place[4:3], data << place};
        end
    endfunction
    function [35:0] placed(input [4:0] place, input [35:0] word);
        placed = {word[35:32] << place[4:3], word[31:0] << place};
    endfunction
    function [35:0] taken(input [4:0] place, input [35:0] row);
        taken = {row[35:32] >> place[4:3], row[31:0] >> place};
    endfunction

    // The address of a port that is not used is 0.
    wire [ADDR_BITS-6:0] row_a = WIDTH_A == 0 ? 0 : addr_a_i[ADDR_BITS-1:5];
    wire [ADDR_BITS-6:0] row_b = WIDTH_B == 0 ? 0 : addr_b_i[ADDR_BITS-1:5];
    wire [4:0]  place_a = addr_a_i[4:0] & ~(DATA_A[4:0] - 5'd1);
    wire [4:0]  place_b = addr_b_i[4:0] & ~(DATA_B[4:0] - 5'd1);
    wire [35:0] mask_a  = WIDTH_A == 0 || !en_a_i ? 36'd0 : mask(WIDTH_A, place_a, we_a_i);
    wire [35:0] mask_b  = WIDTH_B == 0 || !en_b_i ? 36'd0 : mask(WIDTH_B, place_b, we_b_i);
    wire [35:0] new_a   = (rows[row_a] & ~mask_a) | (placed(place_a, data_a_i) & mask_a);
    wire [35:0] new_b   = (rows[row_b] & ~mask_b) | (placed(place_b, data_b_i) & mask_b);
    // Mask of the bits that the other port overwrites at the same edge; this port reads invalid
    // data there.
    wire [35:0] lost_a  = row_a == row_b && MODE_B != "READ_FIRST" ? mask_b : 36'd0;
    wire [35:0] lost_b  = row_a == row_b && MODE_A != "READ_FIRST" ? mask_a : 36'd0;
    wire [35:0] wrong_a = (~rows[row_a] & 36'h555555555) | (~new_b & 36'haaaaaaaaa);
    wire [35:0] wrong_b = (~rows[row_b] & 36'h555555555) | (~new_a & 36'haaaaaaaaa);
    wire [35:0] seen_a  = MODE_A == "WRITE_FIRST" ? new_a : rows[row_a];
    wire [35:0] seen_b  = MODE_B == "WRITE_FIRST" ? new_b : rows[row_b];

    always @(posedge clk_a_i) begin
        if (rst_a_i && (en_a_i || PRIORITY_A == "SR"))
            data_a_o <= RESET_A;
        else if (en_a_i && !(MODE_A == "NO_CHANGE" && we_a_i != 0))
            data_a_o <= taken(place_a, (seen_a & ~lost_a) | (wrong_a & lost_a));
        if (mask_a != 0)
            rows[row_a] <= new_a;
    end
    always @(posedge clk_b_i) begin
        if (rst_b_i && (en_b_i || PRIORITY_B == "SR"))
            data_b_o <= RESET_B;
        else if (en_b_i && !(MODE_B == "NO_CHANGE" && we_b_i != 0))
            data_b_o <= taken(place_b, (seen_b & ~lost_b) | (wrong_b & lost_b));
        if (mask_b != 0)
            rows[row_b] <= new_b;
    end
endmodule

`default_nettype wire
