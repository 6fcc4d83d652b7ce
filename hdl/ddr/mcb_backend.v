// SPDX-License-Identifier: MIT
//
// mcb_backend: connects the command stream of the arbiter to a 64-bit user port of the Spartan-6
// memory controller block, MCB (UG388).
//
// The read FIFO of the MCB holds 64 words, and the MCB loses words that do not fit. Therefore a
// read waits until earlier reads occupy at most half of this FIFO; the other half has room for the
// longest burst.

`default_nettype none

`include "wrong_parameter.vh"

module mcb_backend #(
    parameter ADDR_WIDTH = 27 // width of a byte address, 9..30; the MCB supports up to 1 GiB
) (
    input  wire        clk_i,
    input  wire        rst_i,
    `include "mcb_ports.vh"
    // commands from the arbiter
    input  wire        cmd_valid_i,
    input  wire        cmd_read_i,
    input  wire [ADDR_WIDTH-1:0] cmd_addr_i,
    input  wire [4:0]  cmd_last_i, // number of words minus 1
    output wire        cmd_ready_o,
    input  wire        wr_valid_i,
    input  wire [63:0] wr_data_i,
    input  wire [7:0]  wr_be_i,
    output wire        wr_ready_o,
    output wire        rd_valid_o,
    output wire [63:0] rd_data_o,
    input  wire        rd_ready_i
);
    generate
        if (ADDR_WIDTH < 9 || ADDR_WIDTH > 30) begin : g_refused
            `WRONG_PARAMETER("mcb_backend: ADDR_WIDTH is 9..30")
        end
    endgenerate

    wire room;
    assign cmd_ready_o         = mcb_calib_done_i && !mcb_cmd_full_i && (room || !cmd_read_i);
    assign mcb_cmd_en_o        = cmd_valid_i && cmd_ready_o;
    assign mcb_cmd_instr_o     = {2'b00, cmd_read_i};
    assign mcb_cmd_bl_o        = {1'b0, cmd_last_i};
    assign mcb_cmd_byte_addr_o = {{30-ADDR_WIDTH{1'b0}}, cmd_addr_i};

    assign wr_ready_o    = !mcb_wr_full_i;
    assign mcb_wr_en_o   = wr_valid_i && wr_ready_o;
    assign mcb_wr_mask_o = ~wr_be_i;
    assign mcb_wr_data_o = wr_data_i;

    assign rd_valid_o  = !mcb_rd_empty_i;
    assign rd_data_o   = mcb_rd_data_i;
    assign mcb_rd_en_o = rd_valid_o && rd_ready_i;

    // `free` is the number of places in the read FIFO that are not reserved by a read, 0..64. To
    // subtract n, the code adds ~(n - 1), which is -n.
    reg  [6:0] free;
    wire       take = mcb_cmd_en_o && cmd_read_i;
    wire [7:0] next = {free, 1'b1} + {take ? {2'b11, ~cmd_last_i} : 7'd0, mcb_rd_en_o};
    assign room = |free[6:5];
    always @(posedge clk_i)
        free <= rst_i ? 7'd64 : next[7:1];

    wire unused = &{1'b0, next[0], 1'b0};

`ifdef FORMAL
    // Proves that the MCB never gets a command that it would refuse, and that no word is lost.
    reg past = 1'b0;
    initial assume (rst_i);
    reg [7:0] asked = 0; // number of words that were requested by reads and have not been taken
    always @(posedge clk_i) begin
        past <= 1'b1;
        asked <= rst_i ? 8'd0
                       : asked +
                           (mcb_cmd_en_o && mcb_cmd_instr_o[0] ? {2'd0, mcb_cmd_bl_o} + 8'd1 : 8'd0)
                               - {7'd0, mcb_rd_en_o};
        // The MCB delivers only words that were requested.
        assume (mcb_rd_empty_i || asked != 0);
        if (past && !rst_i) begin
            // The MCB never gets a command that it would refuse, and the number of reserved words
            // stays within 0..64.
            assert (asked == 8'd64 - {1'b0, free} && free <= 7'd64);
            assert (!(mcb_cmd_en_o && (mcb_cmd_full_i || !mcb_calib_done_i)));
            assert (!(mcb_wr_en_o && mcb_wr_full_i));
            assert (!(mcb_rd_en_o && mcb_rd_empty_i));
            // Nothing is lost between the arbiter and the MCB.
            assert (mcb_cmd_en_o == (cmd_valid_i && cmd_ready_o));
            assert (mcb_wr_en_o == (wr_valid_i && wr_ready_o));
            assert (mcb_rd_en_o == (rd_valid_o && rd_ready_i));
            if (mcb_cmd_en_o)
                assert (mcb_cmd_instr_o == {2'b00, cmd_read_i} &&
                        mcb_cmd_bl_o == {1'b0, cmd_last_i});
            // Writes never wait because of reads. Reads wait only while more than half of the FIFO
            // is reserved.
            if (mcb_calib_done_i && !mcb_cmd_full_i && (!cmd_read_i || asked <= 8'd32))
                assert (cmd_ready_o);
            cover (asked == 8'd64);
            cover (cmd_valid_i && !cmd_ready_o && mcb_calib_done_i && !mcb_cmd_full_i);
            cover (mcb_cmd_en_o && mcb_wr_en_o && mcb_rd_en_o);
        end
    end
`endif
`ifdef COVER_POINTS
    read_waits_for_room: cover property (@(posedge clk_i) cmd_valid_i && cmd_read_i && !room);
    commands_full: cover property (@(posedge clk_i) cmd_valid_i && mcb_cmd_full_i);
    words_full: cover property (@(posedge clk_i) wr_valid_i && mcb_wr_full_i);
    not_calibrated: cover property (@(posedge clk_i) cmd_valid_i && !mcb_calib_done_i);
`endif
endmodule
