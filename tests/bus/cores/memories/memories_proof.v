// SPDX-License-Identifier: MIT
//
// memories_proof: proves that the buffers of two generated wrappers never overlap, if they are
// allocated as for ip/cores.list: separate, and aligned to their sizes.

`default_nettype none

module memories_proof (
    input wire        clk_i,
    input wire        rst_i,
    input wire [1:0]  valid_i,
    input wire        write_i,
    input wire [3:0]  addr_i,
    input wire [31:0] wdata_i,
    input wire [6:0]  little_byte_i, // an offset in the buffer of each core, chosen by the prover
    input wire [11:0] middle_byte_i
);
    localparam LITTLE = 7, MIDDLE = 12; // log2 of the size of each buffer
    localparam MEMORY = 4'd5;

    wire [31:0] little_base, middle_base;
    little_wrapper u_little (
        .clk_i(clk_i), .rst_i(rst_i), .bus_valid_i(valid_i[0]), .bus_write_i(write_i),
        .bus_addr_i(addr_i), .bus_wdata_i(wdata_i), .fill_result_base_o(little_base),
        .fill_result_count_i(8'd128), .fill_done_i(1'b0), .fill_refused_i(1'b0));
    middle_wrapper u_middle (
        .clk_i(clk_i), .rst_i(rst_i), .bus_valid_i(valid_i[1]), .bus_write_i(write_i),
        .bus_addr_i(addr_i), .bus_wdata_i(wdata_i), .fill_result_base_o(middle_base),
        .fill_result_count_i(13'd4096), .fill_done_i(1'b0), .fill_refused_i(1'b0));

    (* anyconst *) reg [31:0] little, middle; // base addresses, as allocated by coremap
    always @* begin
        assume (little[LITTLE-1:0] == 0 && middle[MIDDLE-1:0] == 0);
        assume (little + 33'd128 <= middle || middle + 33'd4096 <= little);
        assume (!(valid_i[0] && write_i && addr_i == MEMORY) || wdata_i == little >> LITTLE);
        assume (!(valid_i[1] && write_i && addr_i == MEMORY) || wdata_i == middle >> MIDDLE);
    end

    reg [1:0] placed = 2'd0; // one bit per core: its servant has written the register MEMORY
    always @(posedge clk_i)
        placed <= rst_i ? 2'd0 : placed | valid_i & {2{write_i && addr_i == MEMORY}};
    always @* if (placed[0])
        assert (little_base == little);
    always @* if (placed[1])
        assert (middle_base == middle);
    always @* if (placed == 2'd3)
        assert (little_base + {25'd0, little_byte_i} != middle_base + {20'd0, middle_byte_i});
endmodule
