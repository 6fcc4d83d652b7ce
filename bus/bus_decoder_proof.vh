// SPDX-License-Identifier: MIT
//
// bus_decoder_proof: the properties of bus_decoder (formal.bus_decoder); included at its foot, only
// for the prover.

    // The master's promises are assumed. The decoder's registers depend only on the clock before,
    // so they hold for all inputs.
    reg             past = 1'b0;
    reg [10:0]      shown; // address and direction, a clock ago
    reg [SLOTS-1:0] one;   // any one slot
    integer k;
    always @(posedge clk_i) begin
        past  <= 1'b1;
        shown <= {bus_write_i, bus_addr_i};
    end
    always @* assume (!bus_valid_i || shown == {bus_write_i, bus_addr_i});
    always @* if (past && bus_valid_i) begin
        one    = {{(SLOTS-1){1'b0}}, 1'b1} << slot;
        for (k = 0; k < SLOTS; k = k + 1)
            if (one[k])
                assert ({bus_ready_o, bus_error_o, bus_rdata_o, slot_addr_o[4*k +: 4]} ==
                        {slot_ready_i[k], slot_error_i[k], slot_rdata_i[32*k +: 32], bus_addr_i[3:0]});
            else
                assert (slot_addr_o[4*k +: 4] == 4'd0);
        assert (slot_valid_o == one);
        assert (one != {SLOTS{1'b0}} || (bus_ready_o && bus_error_o && bus_rdata_o == 32'd0));
        assert ({slot_write_o, slot_wdata_o} == {bus_write_i, bus_wdata_i});
        cover (slot_valid_o[SLOTS-1] && bus_ready_o && !bus_error_o);
        cover (SLOTS == 64 || slot_valid_o == {SLOTS{1'b0}});
    end
    always @* if (!bus_valid_i)
        assert (slot_valid_o == {SLOTS{1'b0}});
