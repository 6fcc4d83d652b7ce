// SPDX-License-Identifier: MIT
//
// bus_crossing_proof: the slot never hangs the bus, whatever the core's clock does; only for the prover.
//
// It is included in the module's body in place of the core's side: answers come at any time after their request, or never.
// The proof of cdc_bus has that a request and an answer arrive once and whole.

    (* anyseq *) reg free_handed, free_irq, free_error;
    (* anyseq *) reg [31:0] free_rdata;
    assign {handed, irq, error, rdata} = {free_handed, free_irq, free_error, free_rdata};
    assign {core_rst_o, core_valid_o, core_write_o, core_addr_o, core_wdata_o} = 39'd0;
    wire unused = &{1'b0, core_clk_i, core_ready_i, core_rdata_i, core_error_i, core_irq_i, 1'b0};

    bus_rules #(.LIMIT(TIMEOUT + 1), .PATIENCE(TIMEOUT + 2)) u_rules (
        .clk_i(clk_i), .rst_i(rst_i), .valid_i(bus_valid_i), .write_i(bus_write_i),
        .addr_i({6'd0, bus_addr_i}), .wdata_i(bus_wdata_i), .ready_i(bus_ready_o),
        .rdata_i(bus_rdata_o), .error_i(bus_error_o));
    reg past = 1'b0;
    reg [15:0] used = 16'd0; // clocks the access has waited before this one
    initial assume (rst_i);
    always @(posedge clk_i) begin
        past <= 1'b1;
        used <= bus_valid_i && !bus_ready_o && !rst_i ? used + 16'd1 : 16'd0;
        if (past && $past(given_up) && !$past(rst_i))
            assert (!asked && !irq_o);
        cover (past && !rst_i && $past(given_up) && handed && !asked);
        cover (bus_valid_i && bus_ready_o && !bus_error_o && !rst_i);
    end
    always @* begin
        assume (!handed || owes); // an answer comes to a request only
        if (!rst_i) begin
            assert (patience + used == TIMEOUT);
            assert (!ask || !owes);                          // one request at a time
            assert (!asked || owes || answered);             // a waiting access has a request without an answer
            assert (!answered || !owes);
            // Each access that succeeds has an answer of its own, to its own request.
            assert (!(bus_valid_i && bus_ready_o && !bus_error_o) || asked);
        end
    end
