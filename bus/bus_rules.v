// SPDX-License-Identifier: MIT
//
// bus_rules: checks the rules of docs/bus.md as formal properties, for either side of the register
// bus.
//
// A module instantiates it under `ifdef FORMAL at its ports as a slave (default) or as a master.
// The rules for the other side are assumed; the rules for the module's own side are asserted.

`default_nettype none

module bus_rules #(
    parameter MASTER   = 0,   // 1: asserts the rules for a master; 0: asserts the rules for a slave
    parameter LIMIT    = 16,  // number of clocks within which a slave must answer, at least 1
    parameter PATIENCE = 256  // number of clocks after which a master may abandon an access
) (
    input wire        clk_i,
    input wire        rst_i,
    input wire        valid_i,
    input wire        write_i,
    input wire [9:0]  addr_i,
    input wire [31:0] wdata_i,
    input wire        ready_i,
    input wire [31:0] rdata_i,
    input wire        error_i
);
`ifdef FORMAL
    reg        past   = 1'b0;
    // number of clocks for which valid has been high without ready before this clock
    reg [15:0] waited = 16'd0;
    always @(posedge clk_i) begin
        past   <= 1'b1;
        waited <= valid_i && !ready_i && !rst_i ? waited + (waited != 16'hFFFF) : 16'd0;
    end

    reg waiting = 1'b0; // high if valid was high in the previous clock and ready was low
    reg ended   = 1'b0; // high if a transfer happened in the previous clock
    reg        write_was;
    reg [9:0]  addr_was;
    reg [31:0] wdata_was;
    always @(posedge clk_i) begin
        waiting   <= valid_i && !ready_i && !rst_i;
        ended     <= valid_i && ready_i && !rst_i;
        write_was <= write_i;
        addr_was  <= addr_i;
        wdata_was <= wdata_i;
    end
    // The counter and the flag agree; the prover needs this relation for induction.
    always @*
        assert (waiting == (waited != 16'd0));

    // Rule for the master: a transfer that waits does not change, and the master may abandon it
    // only after PATIENCE clocks.
    wire stable    = !waiting || !valid_i
                     || (write_i == write_was && addr_i == addr_was &&
                         (!write_i || wdata_i == wdata_was));
    // Address and direction are valid one clock before valid, because the decoder stores them in
    // registers.
    wire early     = !valid_i || !past || (addr_i == addr_was && write_i == write_was);
    // Valid is low for one clock between two transfers, because a write may take effect one clock
    // after its transfer.
    wire paused    = !valid_i || !ended;
    wire withdrawn = waiting && !valid_i && waited < PATIENCE;
    // Rules for the slave: it answers in time, and a read that fails returns 0.
    wire late      = valid_i && !ready_i && waited >= LIMIT - 1;
    wire leaking   = valid_i && ready_i && error_i && !write_i && rdata_i != 32'd0;

    generate
        if (MASTER != 0) begin : g_master
            always @* if (!rst_i) begin
                assert (stable);
                assert (early);
                assert (paused);
                assert (!withdrawn);
                assume (!leaking);
                // The slave is not assumed to answer in time, because it may hang.
            end
        end else begin : g_slave
            always @* if (!rst_i) begin
                assume (stable);
                assume (!withdrawn);
                assert (!late);
                assert (!leaking);
            end
            always @*
                cover (!rst_i && valid_i && ready_i && write_i && !error_i);
        end
    endgenerate
    wire unused = &{1'b0, past, early, paused, late, 1'b0};
`else
    wire unused =
        &{1'b0, clk_i, rst_i, valid_i, write_i, addr_i, wdata_i, ready_i, rdata_i, error_i, 1'b0};
`endif
endmodule
