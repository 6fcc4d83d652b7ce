// SPDX-License-Identifier: MIT
//
// rest_proof: proves that the simulator may stop the clock of the chip's platform (bridge, decoder,
// modem, system slot) while stirs_o is low, because the platform would not change its state
// (sim_soc.v, quiet_span.h). Used only by the prover.
//
// The proof begins in any state of the platform in which one clock changes only the platform's
// counters. It shows that all later clocks also change only the counters, and always by the same
// steps, whatever cores and memory do. It assumes that stirs_o is low, that the pins of the
// platform are stable, and that no counter reaches its end. The outputs of the platform to cores,
// memory and pins do not depend on the counters (tests/hdl/formal/platform_rests.ys).
//
// The signal `later` counts as the chip clock here: idle_registers.v turns each flip-flop with
// this clock into one assumption and one assertion.

`default_nettype none
`include "rests.vh"

module rest_proof (
    input wire        clk_i,
    input wire [31:0] core_pins_i,
    output reg        later // high after the first clock edge
);
    initial later = 1'b0;
    always @(posedge clk_i)
        later <= 1'b1;

    (* anyconst *) reg [24:0] a;
    (* anyconst *) reg [15:0] d;
    (* anyconst *) reg [1:0]  ne_n, nbl_n;
    (* anyconst *) reg        noe_n, nwe_n, nadv_n, rxd, cts_n;
    wire reads, txd;
    soc u_soc (
        .clk_i(later), .rst_i(1'b0), .core_pins_i(core_pins_i),
        .fsmc_a_i(a), .fsmc_d_i(d), .fsmc_ne_n_i(ne_n), .fsmc_noe_n_i(noe_n),
        .fsmc_nwe_n_i(nwe_n), .fsmc_nbl_n_i(nbl_n), .fsmc_nadv_n_i(nadv_n), .fsmc_d_oe_o(reads),
        .modem_rxd_i(rxd), .modem_cts_n_i(cts_n), .modem_txd_o(txd)
    );
    `include "map_regs.vh"
    (* hierconn *) wire \u_soc.u_platform.calib_done , \u_soc.u_platform.bus_valid ;
    (* hierconn *) wire [MAP_NPI_PORT_COUNT-1:0] \u_soc.u_platform.u_memory.npi_addr_ack_o ;
    (* hierconn *) wire [MAP_NPI_PORT_COUNT-1:0] \u_soc.u_platform.u_memory.npi_rd_empty_o ;
    wire stirs = `PLATFORM_STIRS(u_soc.u_platform);
    always @* assume (!stirs);

    // The three counters. Only `phase` and `clocks` trigger an action when they reach their end.
    (* hierconn *) wire [63:0] \u_soc.u_system_slot.cycles ;
    (* hierconn *) wire [18:0] \u_soc.u_modem.u_baud.phase ;
    (* hierconn *) wire [16:0] \u_soc.u_modem.u_timer.clocks ;
    wire [18:0] phase  = \u_soc.u_modem.u_baud.phase ;
    wire [16:0] clocks = \u_soc.u_modem.u_timer.clocks ;
    localparam [16:0] FIRST = 17'd1 - 17'd106250; // same value as in modem_timer.v at 100 MHz
    always @* assume (!phase[18] && clocks >= FIRST && !(&clocks));

    wire [98:0] now = {\u_soc.u_system_slot.cycles , phase[17:0], clocks};
    reg  [98:0] before, older;
    reg         last = 1'b0; // high after the second clock edge
    always @(posedge clk_i) begin
        {older, before} <= {before, now};
        last            <= later;
    end
    // the timer's count (`clocks`) increases by at most one in the first clock
    always @* assume (!later || last || now[16:0] - before[16:0] <= 17'd1);
    always @* if (last) begin
        assert (now[98:35] - before[98:35] == before[98:35] - older[98:35]);
        assert (now[34:17] - before[34:17] == before[34:17] - older[34:17]);
        assert (now[16:0] - before[16:0] == before[16:0] - older[16:0]);
        cover (!txd && rxd && now[16:0] != before[16:0]);
        cover (reads && !txd);
    end
endmodule
