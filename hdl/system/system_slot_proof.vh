// SPDX-License-Identifier: MIT
//
// system_slot_proof: events, errors and the cycle count's latch follow the register table; without
// an access only the cycle count moves, n in n clocks, which the simulator adds at once
// (testbench/sim/quiet_span.cpp). It is included at the foot of system_slot.v, only for the prover.

    reg past = 1'b0;
    (* anyseq *) reg begins; // a span
    reg [63:0] then;
    reg [15:0] n;
    reg        spans = 1'b0;
    (* hierconn *) wire [1:0] \u_wrapper.sticky , \u_wrapper.mask ;
    always @(posedge clk_i) begin
        n <= n + 16'd1;
        if (rst_i || &n)
            spans <= 1'b0;
        if (begins && !rst_i) begin
            spans <= 1'b1;
            then  <= cycles;
            n     <= 16'd1;
        end
        if (spans)
            assert (n != 16'd0 && cycles == then + {48'd0, n});
        if (past && !$past(rst_i || bus_valid_i || access_error_i || late_i))
            assert ({\u_wrapper.sticky , \u_wrapper.mask , cycles_high_latched, page_o, scratch, contract, error_open, error_addr, error_write} ==
                    $past({\u_wrapper.sticky , \u_wrapper.mask , cycles_high_latched, page_o, scratch, contract, error_open, error_addr, error_write}));
        cover (past && spans && n == 16'd9);
    end
    initial assume (rst_i);
    always @(posedge clk_i) begin
        past <= 1'b1;
        if (past && !rst_i && !$past(rst_i)) begin
            // The place shown is that of the oldest error since the event was last clear.
            if ($past(access_error_i && (!error_open || clearing)))
                assert ({error_addr, error_write} == $past({error_addr_i | {10{error_memory_i}}, error_write_i}));
            else
                assert ({error_addr, error_write} == $past({error_addr, error_write}));
            assert (error_open == ($past(access_error_i) || $past(error_open && !clearing)));
            // The high word stays as it was when the low word was read.
            assert (cycles_high_latched == $past(reg_read && reg_addr == SYSTEM_CYCLES_LO ? cycles[63:32] : cycles_high_latched));
        end
        cover (past && !rst_i && $past(access_error_i && clearing && error_open));
    end
    always @* begin
        assert (!past || rst_i || error_open == \u_wrapper.sticky [0]); // so that the prover need not find it
        assert (irq_o == (own_irq || |slot_irq_i));
        if (bus_valid_i && !bus_write_i && !rst_i && bus_addr_i == SYSTEM_EVENT)
            assert ({bus_rdata_o[31:2], bus_rdata_o[0]} == {30'd0, error_open}); // both of one error
    end
