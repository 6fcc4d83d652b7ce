// SPDX-License-Identifier: MIT
//
// variants: compares the variants of cdc_bit, or of cdc_copy (COPY), for the simulation, for proofs
// and for the chip (variants.sh).

`default_nettype none

module same (
    input wire              clk_i,
    input wire [`WIDTH-1:0] bits_i,
    input wire [`WIDTH-1:0] mask_i  // bits that the simulation's random choice makes late
);
`ifdef COPY
    wire [`WIDTH-1:0] plain, chip;
    simulated u_plain (.clk_i(clk_i), .bus_async_i(bits_i), .bus_sync_o(plain),
                       .mask({`WIDTH{1'b0}}));
    chip      u_chip (.clk_i(clk_i), .bus_async_i(bits_i), .bus_sync_o(chip));
    // before the first clock, the contents are arbitrary
    reg started = 1'b0;
    always @(posedge clk_i)
        started <= 1'b1;
    always @*
        assert (!started || plain == chip);
    wire unused = &{1'b0, mask_i, 1'b0};
`else
    wire [`WIDTH-1:0] simulated, proven, plain, never, chip;
    reg  [`WIDTH-1:0] was = 1;
    always @(posedge clk_i)
        was <= bits_i;
    // With TOGETHER, the simulation delays bits only in a clock in which one of the upper TOGETHER
    // bits changes.
    wire [`WIDTH-1:0] moved = bits_i ^ was;
    wire [`WIDTH-1:0] late  =
        `TOGETHER != 0 && moved >> (`WIDTH - `TOGETHER) == 0 ? {`WIDTH{1'b0}} : mask_i;

    simulated u_simulated (.clk_i(clk_i), .bit_async_i(bits_i), .bit_sync_o(simulated),
                           .mask(mask_i));
    proven    u_proven (.clk_i(clk_i), .bit_async_i(bits_i), .bit_sync_o(proven), .late(late));
    simulated u_plain (.clk_i(clk_i), .bit_async_i(bits_i), .bit_sync_o(plain),
                       .mask({`WIDTH{1'b0}}));
    proven    u_never (.clk_i(clk_i), .bit_async_i(bits_i), .bit_sync_o(never),
                       .late({`WIDTH{1'b0}}));
    chip      u_chip (.clk_i(clk_i), .bit_async_i(bits_i), .bit_sync_o(chip));

    always @* begin
        assert (simulated == proven);
        assert (plain == chip && never == chip);
    end
`endif
endmodule
