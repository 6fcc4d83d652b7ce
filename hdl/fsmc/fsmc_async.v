// SPDX-License-Identifier: MIT
//
// fsmc_async: the pins of an asynchronous access: what NWE's rising edge writes, and who reads.
//
// As in an SRAM, a write happens when NWE rises while NE is low: address, data and byte lanes are
// registered by that very edge (the STM32 holds them for one HCLK after it). So an access that is
// given up, NE rising first, writes nothing, and there is no minimum for the time that NWE rests. The
// next edge must not come within four clocks (40 ns at 100 MHz).
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
    output wire        writing_o     // either
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
        write_s0 <= |ne && !fsmc_nwe_n_i;
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
endmodule
