// SPDX-License-Identifier: MIT
//
// fsmc_burst: turns synchronous bursts of PSRAM (NE1, FSMC_CLK) into halfword writes and reads in clk_i.
//
// fsmc_burst_pins serves the pins, in FSMC_CLK. Data crosses to clk_i through two FIFOs (async_fifo): one of writes, and
// one of a burst's reads, which each read burst restarts; the restart brings the address with it. This module asks for
// as many reads as the FIFO takes, as long as the burst lasts.

`default_nettype none

module fsmc_burst #(
    parameter MUXED   = 0, // 1: address bits 15..0 come on the data pins
    parameter LATENCY = 5  // edges from the address to the first data, 4..17
) (
    input  wire        clk_i,
    input  wire        rst_i,
    // FSMC pins
    input  wire        fsmc_clk_i,
    input  wire [24:0] fsmc_a_i,   // halfword address
    input  wire [15:0] fsmc_d_i,
    output wire [15:0] fsmc_d_o,
    input  wire        fsmc_ne_n_i, // NE1
    input  wire        fsmc_nwe_n_i,
    input  wire        fsmc_nadv_n_i,
    input  wire [1:0]  fsmc_nbl_n_i,
    output wire        fsmc_nwait_n_o,
    // order: no write is accepted while accesses that must come first are under way
    input  wire        busy_i,
    // oldest write, in clk_i
    output wire        wr_valid_o,
    output wire [24:0] wr_addr_o,
    output wire [15:0] wr_data_o,
    output wire [1:0]  wr_be_o,
    input  wire        wr_ready_i,
    // halfword to be read next, in clk_i
    output wire        rd_valid_o,
    output reg  [24:0] rd_addr_o,
    input  wire [15:0] rd_data_i,
    input  wire        rd_ready_i
);
    wire        begun, push, full, restart, pop, empty;
    wire [24:0] addr;
    wire [42:0] push_data;
    wire [15:0] pop_data;
    fsmc_burst_pins #(.MUXED(MUXED), .LATENCY(LATENCY)) u_pins (
        .fsmc_clk_i(fsmc_clk_i), .fsmc_a_i(fsmc_a_i), .fsmc_d_i(fsmc_d_i), .fsmc_d_o(fsmc_d_o),
        .fsmc_ne_n_i(fsmc_ne_n_i), .fsmc_nwe_n_i(fsmc_nwe_n_i), .fsmc_nadv_n_i(fsmc_nadv_n_i),
        .fsmc_nbl_n_i(fsmc_nbl_n_i), .fsmc_nwait_n_o(fsmc_nwait_n_o), .busy_async_i(busy_i),
        .begun_o(begun), .addr_o(addr), .push_o(push), .push_data_o(push_data), .full_i(full),
        .restart_o(restart), .pop_o(pop), .pop_data_i(pop_data), .empty_i(empty));

    wire none, never_begins;
    async_fifo #(.WIDTH(43), .LOG2(4), .SPARE(2)) u_writes (
        .write_clk_i(fsmc_clk_i), .push_i(push), .data_i(push_data), .full_o(full), .begins_o(never_begins),
        .read_clk_i(clk_i), .restart_i(1'b0), .pop_i(!none && (wr_ready_i || rst_i)),
        .data_o({wr_addr_o, wr_be_o, wr_data_o}), .empty_o(none));
    assign wr_valid_o = !none;

    wire begins, no_room;
    async_fifo #(.WIDTH(16), .LOG2(3), .RESTARTS(1)) u_reads (
        .write_clk_i(clk_i), .push_i(rd_valid_o && rd_ready_i), .data_i(rd_data_i), .full_o(no_room), .begins_o(begins),
        .read_clk_i(fsmc_clk_i), .restart_i(restart), .pop_i(pop), .data_o(pop_data), .empty_o(empty));

    // ---- Reads have no reset: a burst that outlasts a reset gets its data after it.
    wire        begun_sync;
    wire [24:0] addr_sync; // stable, when a session begins, for longer than the FIFO's own synchronisers take
    reg         reading;
    initial reading = 1'b0;
    assign rd_valid_o = reading && begun_sync && !no_room;
    cdc_bit u_begun (.clk_i(clk_i), .bit_async_i(begun), .bit_sync_o(begun_sync));
    cdc_copy #(.WIDTH(25)) u_addr (.clk_i(clk_i), .bus_async_i(addr), .bus_sync_o(addr_sync));

    always @(posedge clk_i) begin
        if (rd_valid_o && rd_ready_i)
            rd_addr_o <= rd_addr_o + 25'd1;
        if (!begun_sync)
            reading <= 1'b0;
        if (begins) begin
            reading   <= 1'b1;
            rd_addr_o <= addr_sync;
        end
    end

    wire unused = &{1'b0, never_begins, 1'b0};

`ifdef FORMAL
`include "fsmc_burst_proof.vh"
`endif
`ifdef COVER_POINTS
    asks_for_what_does_not_fit: cover property (@(posedge clk_i) reading && begun_sync && no_room);
    write_waits: cover property (@(posedge clk_i) wr_valid_o && !wr_ready_i);
    read_behind_writes: cover property (@(posedge clk_i) wr_valid_o && rd_valid_o);
`endif
endmodule
