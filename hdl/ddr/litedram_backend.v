// SPDX-License-Identifier: MIT
//
// litedram_backend: puts the arbiter's command stream on a 64-bit native port of LiteDRAM.
//
// A command of n words becomes n commands of one word, one a clock. LiteDRAM takes and gives data when
// the memory does, and never waits. The words of a write are therefore in a FIFO before its first
// command, and a read command goes only when the read FIFO has a place for its word.

`default_nettype none

module litedram_backend #(
    parameter ADDR_WIDTH = 27, // of a byte, 9..32: 2**27 are 128 MiB
    parameter WRITE_LOG2 = 6,  // write FIFO: words, 32 at least
    parameter READ_LOG2  = 5   // read FIFO: words; covers the latency of the memory
) (
    input  wire                  clk_i,
    input  wire                  rst_i,
    // from the arbiter
    input  wire                  cmd_valid_i,
    input  wire                  cmd_read_i,
    input  wire [ADDR_WIDTH-1:0] cmd_addr_i, // aligned to the size of the transfer
    input  wire [4:0]            cmd_last_i, // words - 1
    output wire                  cmd_ready_o,
    input  wire                  wr_valid_i,
    input  wire [63:0]           wr_data_i,
    input  wire [7:0]            wr_be_i,
    output wire                  wr_ready_o,
    output wire                  rd_valid_o,
    output wire [63:0]           rd_data_o,
    input  wire                  rd_ready_i,
    // LiteDRAM native port
    output wire                  dram_cmd_valid_o,
    input  wire                  dram_cmd_ready_i,
    output wire                  dram_cmd_we_o,
    output wire [ADDR_WIDTH-4:0] dram_cmd_addr_o, // of a word
    output wire                  dram_wdata_valid_o,
    input  wire                  dram_wdata_ready_i,
    output wire [7:0]            dram_wdata_we_o,
    output wire [63:0]           dram_wdata_data_o,
    input  wire                  dram_rdata_valid_i,
    output wire                  dram_rdata_ready_o,
    input  wire [63:0]           dram_rdata_data_i,
    input  wire                  dram_init_done_i
);
    wire write_empty, write_full, read_empty, read_full;

    npi_fifo #(.WIDTH(72), .LOG2(WRITE_LOG2)) u_write (
        .clk_i(clk_i), .rst_i(rst_i),
        .push_i(wr_valid_i && wr_ready_o), .data_i({wr_be_i, wr_data_i}),
        .pop_i(dram_wdata_ready_i), .data_o({dram_wdata_we_o, dram_wdata_data_o}),
        .empty_o(write_empty), .full_o(write_full)
    );
    assign wr_ready_o         = !write_full;
    assign dram_wdata_valid_o = !write_empty;

    npi_fifo #(.WIDTH(64), .LOG2(READ_LOG2)) u_read (
        .clk_i(clk_i), .rst_i(rst_i),
        .push_i(dram_rdata_valid_i), .data_i(dram_rdata_data_i),
        .pop_i(rd_valid_o && rd_ready_i), .data_o(rd_data_o),
        .empty_o(read_empty), .full_o(read_full)
    );
    assign rd_valid_o         = !read_empty;
    assign dram_rdata_ready_o = !read_full;

    // `promised` counts the words of reads that are under way or in the FIFO.
    reg [READ_LOG2:0] promised;
    reg [4:0]         index;
    wire room  = !promised[READ_LOG2];
    wire taken = dram_cmd_valid_o && dram_cmd_ready_i;

    // A command that has been shown stays, because `promised` grows by commands only.
    assign dram_cmd_valid_o = cmd_valid_i && dram_init_done_i && (room || !cmd_read_i);
    assign dram_cmd_we_o    = !cmd_read_i;
    assign dram_cmd_addr_o  = {cmd_addr_i[ADDR_WIDTH-1:8], cmd_addr_i[7:3] | index};
    assign cmd_ready_o      = dram_cmd_ready_i && dram_init_done_i && (room || !cmd_read_i) &&
                              index == cmd_last_i;

    always @(posedge clk_i) begin
        if (taken)
            index <= index == cmd_last_i ? 5'd0 : index + 5'd1;
        promised <= promised + {{READ_LOG2{1'b0}}, taken && cmd_read_i}
                             - {{READ_LOG2{1'b0}}, rd_valid_o && rd_ready_i};
        if (rst_i) begin
            index    <= 5'd0;
            promised <= 0;
        end
    end

    wire unused = &{1'b0, cmd_addr_i[2:0], 1'b0};

`ifdef FORMAL
`include "litedram_backend_proof.vh"
`endif
`ifdef COVER_POINTS
    read_waits_for_room: cover property (@(posedge clk_i) cmd_valid_i && cmd_read_i && !room);
    command_waits: cover property (@(posedge clk_i) dram_cmd_valid_o && !dram_cmd_ready_i);
    words_full: cover property (@(posedge clk_i) wr_valid_i && write_full);
    not_ready: cover property (@(posedge clk_i) cmd_valid_i && !dram_init_done_i);
`endif
endmodule
