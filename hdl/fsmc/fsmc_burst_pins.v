// SPDX-License-Identifier: MIT
//
// fsmc_burst_pins: serves the pins of synchronous bursts (NE1) in FSMC_CLK: writes go into one FIFO, reads come from another.
//
// FSMC_CLK runs only during a burst; NE1 high ends it and resets what belongs to it. The edge with NADV low takes the
// address, and NWE low makes it a write; data follows LATENCY edges later (BTR.DATLAT + 2) and on every edge
// from there. NWAIT is one edge ahead (BCR.WAITCFG = 0): where it is low at an edge, the next edge has no data.

`default_nettype none

module fsmc_burst_pins #(
    parameter MUXED   = 0, // 1: address bits 15..0 come on the data pins
    parameter LATENCY = 5  // edges from the address to the first data, 4..17
) (
    // FSMC pins
    input  wire        fsmc_clk_i,
    input  wire [24:0] fsmc_a_i,    // halfword address
    input  wire [15:0] fsmc_d_i,
    output reg  [15:0] fsmc_d_o,
    input  wire        fsmc_ne_n_i,
    input  wire        fsmc_nwe_n_i,
    input  wire        fsmc_nadv_n_i,
    input  wire [1:0]  fsmc_nbl_n_i,
    output reg         fsmc_nwait_n_o,
    // order: no write is accepted while accesses that must come first are under way (another clock)
    input  wire        busy_async_i,
    // burst: the address of a read stays until the next burst
    output reg         begun_o,
    output reg  [24:0] addr_o,      // in a write: address of its next halfword
    // FIFO of writes
    output wire        push_o,
    output wire [42:0] push_data_o, // address, byte lanes, data
    input  wire        full_i,      // at most two more fit
    // FIFO of a burst's reads
    output wire        restart_o,
    output wire        pop_o,
    input  wire [15:0] pop_data_i,
    input  wire        empty_i
);
    localparam [4:0] FIRST = LATENCY[4:0];
    reg        write, nwait_was;
    wire       busy_sync;
    cdc_bit u_busy (.clk_i(fsmc_clk_i), .bit_async_i(busy_async_i), .bit_sync_o(busy_sync));
    reg [4:0]  edges;  // edges since the address; stays at FIRST
    reg [15:0] stage;  // halfword read, on its way to the pins
    wire       takes_address = !fsmc_ne_n_i && !begun_o && !fsmc_nadv_n_i;
    wire       ahead = begun_o && !write && edges >= FIRST - 5'd2; // the edge after next has data
    wire [24:0] pin_addr;
    generate
        if (MUXED != 0) begin : g_muxed
            wire unused = &{1'b0, fsmc_a_i[15:0], 1'b0};
            assign pin_addr = {fsmc_a_i[24:16], fsmc_d_i};
        end else begin : g_plain
            assign pin_addr = fsmc_a_i;
        end
    endgenerate

    assign push_o      = begun_o && write && edges == FIRST && nwait_was;
    assign push_data_o = {addr_o, ~fsmc_nbl_n_i, fsmc_d_i};
    assign restart_o   = takes_address && fsmc_nwe_n_i;
    assign pop_o       = ahead && !empty_i;

    always @(posedge fsmc_clk_i or posedge fsmc_ne_n_i)
        if (fsmc_ne_n_i) begin
            begun_o   <= 1'b0;
            write     <= 1'b0;
            edges     <= 5'd0;
            nwait_was <= 1'b0;
            fsmc_nwait_n_o <= 1'b0;
        end else begin
            nwait_was <= fsmc_nwait_n_o;
            if (takes_address) begin
                begun_o <= 1'b1;
                write   <= !fsmc_nwe_n_i;
                edges   <= 5'd1;
            end else if (begun_o && edges != FIRST) begin
                edges <= edges + 5'd1;
            end
            // The edge that sees full_i may bring a halfword, and so may the next one.
            fsmc_nwait_n_o <= begun_o && (write ? !full_i && !busy_sync : pop_o);
        end

    always @(posedge fsmc_clk_i) begin
                stage    <= pop_data_i;
        fsmc_d_o <= stage;
        if (takes_address)
            addr_o <= pin_addr;
        else if (push_o)
            addr_o <= addr_o + 25'd1;
    end

`ifdef FORMAL
`include "fsmc_burst_pins_proof.vh"
`endif
`ifdef COVER_POINTS
    write_held_up: cover property (@(posedge fsmc_clk_i) begun_o && write && edges == FIRST && !nwait_was);
    held_up_by_registers: cover property (@(posedge fsmc_clk_i) begun_o && write && edges == FIRST && busy_sync);
    read_held_up: cover property (@(posedge fsmc_clk_i) ahead && empty_i);
`endif
endmodule
