// SPDX-License-Identifier: MIT
//
// idle_proof: proves that gating the clock of the core CORE in a slot (core_gate.v) changes
// nothing; only for the prover.
//
// The proof shows that at the time at which the gate closes, no register of the core would take
// another value at the next clock, whatever the inputs are. Therefore the core behaves the same
// with and without gating. In this proof the signal `closes` clocks the core; idle_registers.v
// adds an assertion for each flip-flop with this clock: the flip-flop keeps its value.

`default_nettype none

`ifdef CORE
module idle_proof (
    `include "slot_ports.vh"
`ifdef MEMORY
    `include "memory_ports.vh"
`endif
    output wire idle_o
);
    wire closes;
    core_gate #(.GATED(1)) u_gate (
        .clk_i(clk_i), .rst_i(rst_i), .access_i(bus_valid_i), .idle_i(idle_o), .clk_o(closes));
    initial assume (rst_i);
    always @(posedge clk_i)
        cover (closes);

    `CORE u_core ( // all other pins of the core are unconstrained
        .clk_i(closes), .rst_i(rst_i),
        .bus_valid_i(bus_valid_i), .bus_write_i(bus_write_i), .bus_addr_i(bus_addr_i),
        .bus_wdata_i(bus_wdata_i), .bus_ready_o(bus_ready_o), .bus_rdata_o(bus_rdata_o),
        .bus_error_o(bus_error_o),
`ifdef MEMORY
        `include "memory_connect.vh"
`endif
        .idle_o(idle_o));

`ifdef MEMORY
    // Assumptions: the port acknowledges only requests and returns only requested words. Its
    // outputs do not change while no word is on its way. Once it is ready, it stays ready.
    reg        ready = 1'b0;
    reg [6:0]  promised; // words
    reg [63:0] word;
    wire [6:0] size = 7'd1 << npi_size_o;
    always @* begin
        assume (npi_init_done_i || !ready);
        assume (!npi_addr_ack_i || npi_addr_req_o);
        assume (npi_rd_empty_i || promised != 7'd0);
        assume (npi_rd_data_i == word || promised != 7'd0);
    end
    always @(posedge clk_i) begin
        ready    <= npi_init_done_i;
        word     <= npi_rd_data_i;
        promised <= promised + (npi_addr_ack_i && npi_rnw_o ? size : 7'd0) - {6'd0, npi_rd_pop_o};
        if (rst_i)
            promised <= 7'd0;
    end
`endif
`ifdef IDLE_RULES
    `include `IDLE_RULES
`endif
endmodule
`endif
