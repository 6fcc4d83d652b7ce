// SPDX-License-Identifier: MIT
//
// fsmc_async: the pins of an asynchronous access: what NWE's rising edge writes, and who reads.
//
// As in an SRAM, a write happens when NWE rises while NE is low: address, data and byte lanes are
// registered by that very edge (the STM32 holds them for one HCLK after it). So an access that is
// given up, NE rising first, writes nothing, and there is no minimum for the time that NWE rests. The
// next edge must come later than three clocks (30 ns at 100 MHz): until then the write is handed on.
// wr_full_o is high at once; wr_o follows for one cycle, two to three clocks later, and clears it.

`default_nettype none

module fsmc_async (
    input  wire        clk_i,
    input  wire        rst_i,
    // FSMC pins
    input  wire [24:0] fsmc_a_i,     // halfword address, latched where multiplexed
    input  wire [15:0] fsmc_d_i,
    input  wire [1:0]  fsmc_ne_n_i,
    input  wire        fsmc_noe_n_i,
    input  wire        fsmc_nwe_n_i,
    input  wire [1:0]  fsmc_nbl_n_i,
    // a write: the rest is stable from wr_full_o until NWE rises again
    output wire        wr_full_o,    // asynchronous to clk_i
    output wire        wr_o,         // one cycle
    output reg  [1:0]  wr_ne_o,      // one of them: NE2, NE1
    output reg  [24:0] wr_addr_o,
    output reg  [15:0] wr_data_o,
    output reg  [1:0]  wr_be_o,
    // accesses under way
    input  wire        hit_i,        // what the address on the pins asks for is there
    input  wire        safe_i,       // and has been for a while
    output wire [1:0]  reading_o,    // NE2, NE1
    output wire        hit_o,        // hit_i and safe_i as they were in the same moment as reading_o
    output wire        safe_o,
`ifdef FORMAL
    output wire [4:0]  inside_o,     // full_s; NE2's read_s0, read_s1
`endif
    output wire        writing_o     // NE1
);
    wire [1:0] ne = ~fsmc_ne_n_i;

    always @(posedge fsmc_nwe_n_i)
        if (|ne) begin
            wr_ne_o   <= ne;
            wr_addr_o <= fsmc_a_i;
            wr_data_o <= fsmc_d_i;
            wr_be_o   <= ~fsmc_nbl_n_i;
        end

    // The flag is set by the pin and cleared by the clock: a second edge out of ringing does no harm.
    reg       full;
    reg [2:0] full_s;
    wire      taken = full_s[1] && !full_s[2];
    wire      clear = taken || rst_i;
    always @(posedge fsmc_nwe_n_i or posedge clear)
        if (clear)
            full <= 1'b0;
        else if (|ne)
            full <= 1'b1;
    assign wr_full_o = full;
    assign wr_o      = taken;

    reg [1:0] read_s0, read_s1;
    reg       write_s0, write_s1, hit_s0, hit_s1, safe_s0, safe_s1;
    assign reading_o = read_s1;
    assign hit_o     = hit_s1;
    assign safe_o    = safe_s1;
    assign writing_o = write_s1;

    always @(posedge clk_i) begin
        full_s   <= {full_s[1:0], full};
        read_s0  <= ne & {2{!fsmc_noe_n_i}};
        read_s1  <= read_s0;
        write_s0 <= ne[0] && !fsmc_nwe_n_i;
        write_s1 <= write_s0;
        hit_s0   <= hit_i;
        hit_s1   <= hit_s0;
        safe_s0  <= safe_i;
        safe_s1  <= safe_s0;
        if (rst_i) begin
            full_s   <= 3'd0;
            read_s1  <= 2'd0;
            write_s1 <= 1'b0;
        end
    end

`ifdef FORMAL
    assign inside_o = {full_s, read_s0[1], read_s1[1]};

    // Time goes in steps; in each the clock and the pins may change as they like: no ratio, no phase.
    // What changes together with an edge is seen as it was before it.
    (* gclk *) wire step;
    reg        past = 1'b0, was_nwe = 1'b1, was_clk = 1'b1, waiting = 1'b0, was_taken = 1'b0, begun = 1'b0;
    reg [1:0]  was_ne = 2'b00;
    reg [42:0] pins = 43'd0, was_pins = 43'd0;
    reg [1:0]  pins_ne = 2'b00;
    reg [2:0]  clocks = 3'd7; // edges of clk_i since the write's edge
    wire rise = past && fsmc_nwe_n_i && !was_nwe;
    wire edge_of_clk = past && clk_i && !was_clk;
    wire writes = rise && |was_ne;
    wire handed = edge_of_clk && was_taken; // the user has seen wr_o
    wire open = waiting && !handed;
    wire rings = writes && clocks == 3'd0 && open && was_pins == pins && was_ne == pins_ne;
    always @(posedge step) begin
        past     <= 1'b1;
        was_nwe  <= fsmc_nwe_n_i;
        was_clk  <= clk_i;
        was_ne   <= ne;
        was_pins <= {fsmc_a_i, fsmc_d_i, ~fsmc_nbl_n_i};
        // Reset: long enough, and no access meanwhile.
        begun <= begun || clocks == 3'd6;
        assume (rst_i == !begun);
        assume (begun || fsmc_nwe_n_i);
        assume (past || (fsmc_nwe_n_i && clk_i));
        if (handed)
            waiting <= 1'b0;
        if (writes && !rings) begin
            pins    <= was_pins;
            pins_ne <= was_ne;
            waiting <= 1'b1;
            clocks  <= 3'd0;
        end else if (edge_of_clk && clocks != 3'd7) begin
            clocks <= clocks + 3'd1;
        end
        if (!past)
            clocks <= 3'd0;
        // Three clocks and a little between two edges: as many edges of the clock. Ringing is shorter.
        assume (!writes || rings || clocks >= 3'd3);

        if (begun && past) begin
            // Each write is noted at once, handed over once, as it was on the pins, and before the next.
            assert (!open || full || taken);
            assert (!(writes && !rings) || !open);
            assert (!open || clocks < 3'd3);
            assert (!open || {wr_addr_o, wr_data_o, wr_be_o, wr_ne_o} == {pins, pins_ne});
            assert (open || !wr_o);
        end
        was_taken <= taken;
        cover (begun && rings);
        cover (begun && writes && clocks == 3'd3);
        cover (begun && wr_o && rise && !writes);
    end
`endif
`ifdef COVER_POINTS
    memory_write: cover property (@(posedge clk_i) taken && wr_ne_o[0]);
    register_write: cover property (@(posedge clk_i) taken && wr_ne_o[1]);
    next_access_while_write_is_handed_on: cover property (@(posedge clk_i) full_s[0] && |ne && !fsmc_noe_n_i);
    half_a_halfword: cover property (@(posedge clk_i) taken && wr_be_o != 2'b11);
`endif
endmodule
