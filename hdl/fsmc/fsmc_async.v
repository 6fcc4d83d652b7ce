// SPDX-License-Identifier: MIT
//
// fsmc_async: takes the pins of an asynchronous access into clk_i: each write once, and which bank is being read.
//
// A write happens when NWE rises while NE is low, as in an SRAM: that very edge registers address, data and byte
// lanes (the STM32 holds them for one HCLK after it). An access that is given up, NE rising first, therefore
// writes nothing, and NWE has no minimum high time.
// wr_o follows two to three clocks later, for one cycle. The next edge may come when cdc_bus has copied the write,
// which is two clocks and the paths' skew later, so 33.3 ns leave 13 ns for delays.

`default_nettype none

module fsmc_async (
    input  wire        clk_i,
    // FSMC pins
    input  wire [24:0] fsmc_a_i,     // halfword address; a multiplexed one comes latched
    input  wire [15:0] fsmc_d_i,
    input  wire [1:0]  fsmc_ne_n_i,
    input  wire        fsmc_noe_n_i,
    input  wire        fsmc_nwe_n_i,
    input  wire [1:0]  fsmc_nbl_n_i,
    // writes: the fields of one are stable from wr_o until NWE rises again
    output wire        wr_o,         // a write arrives, one cycle
    output wire [1:0]  wr_ne_o,      // one bit is set: bit 1 NE2, bit 0 NE1
    output wire [24:0] wr_addr_o,
    output wire [15:0] wr_data_o,
    output wire [1:0]  wr_be_o,
    output wire        wr_sync_o,    // high from two clocks after NWE's edge until a clock after wr_o
    // pending write, for NWAIT, asynchronous to clk_i: high from NWE's edge until a clock after wr_o
    output wire        wr_async_o,
    output wire        wr_ne2_async_o, // the pending write is one of NE2
    // accesses under way
    input  wire        hit_async_i,  // the data for the address on the pins is there
    input  wire        safe_async_i, // it was there a clock ago, too
    output wire [1:0]  reading_o,    // a read is under way: bit 1 NE2, once no write is pending; bit 0 NE1
    output wire        hit_o,        // hit_async_i and safe_async_i, sampled together with reading_o
    output wire        safe_o,
    output wire        writing_o,    // a write to NE1 is under way
    output wire [24:0] at_o          // the address a clock later than reading_o; arbitrary while the pins change
);
    wire [1:0] ne = ~fsmc_ne_n_i;

    wire [44:0] taken;
    cdc_bus #(.WIDTH(45)) u_write (
        .src_clk_i(fsmc_nwe_n_i), .src_valid_i(|ne), .src_data_i({ne, ~fsmc_nbl_n_i, fsmc_a_i, fsmc_d_i}),
        .src_data_o(taken), .pending_sync_o(wr_sync_o), .pending_async_o(wr_async_o),
        .dst_clk_i(clk_i), .dst_valid_o(wr_o), .dst_data_o({wr_ne_o, wr_be_o, wr_addr_o, wr_data_o})
    );
    assign wr_ne2_async_o = wr_async_o && taken[44];

    // A read of a register is hidden until the write before it has been handed over; else a late
    // synchroniser would let it go first. A read of memory is not, since a write drops the read
    // buffer.
    wire [1:0] reads = ne & {!fsmc_noe_n_i && !wr_async_o, !fsmc_noe_n_i};
    cdc_bit #(.WIDTH(5), .TOGETHER(3)) u_access (
        .clk_i(clk_i),
        .bit_async_i({reads, ne[0] && !fsmc_nwe_n_i, hit_async_i, safe_async_i}),
        .bit_sync_o({reading_o, writing_o, hit_o, safe_o})
    );
    cdc_copy #(.WIDTH(25)) u_at (.clk_i(clk_i), .bus_async_i(fsmc_a_i), .bus_sync_o(at_o));

    wire unused = &{1'b0, taken[43:0], 1'b0};

`ifdef COVER_POINTS
    memory_write: cover property (@(posedge clk_i) wr_o && wr_ne_o[0]);
    register_write: cover property (@(posedge clk_i) wr_o && wr_ne_o[1]);
    next_access_while_write_is_handed_on: cover property (@(posedge clk_i) wr_async_o && |ne && !fsmc_noe_n_i);
    half_a_halfword: cover property (@(posedge clk_i) wr_o && wr_be_o != 2'b11);
`endif
endmodule
