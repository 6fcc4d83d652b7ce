// SPDX-License-Identifier: MIT
//
// mover: a core for tests that has pins, and a memory port that it does not use.

`default_nettype none

module mover #(
    parameter CLK_HZ = 100000000 // Hz
) (
    `include "slot_ports.vh"
    `include "memory_ports.vh"
    // interrupt
    output wire        irq_o,
    // pins
    output wire        seen_o,
    output wire [8:0]  level_o
);

    bus_registers #(.ID_VALUE(32'h4D4F0100)) u_registers (
        `include "slot_connect.vh"
        .value_o(value), .value_i(416'd0), .strobe_o(strobe), .wdata_o(wdata),
        .event_i(npi_init_done_i), .irq_o(irq_o)
    );
    wire [415:0] value;
    wire [12:0]  strobe;
    wire [31:0]  wdata;
    assign {npi_addr_o, npi_addr_req_o, npi_rnw_o, npi_size_o, npi_rmw_o} = 39'd0;
    assign {npi_wr_data_o, npi_wr_be_o, npi_wr_push_o, npi_wr_flush_o, npi_rd_pop_o,
            npi_rd_flush_o} = 76'd0;
    assign seen_o  = npi_init_done_i;
    assign level_o = {8'd0, npi_init_done_i};
    wire unused =
        &{1'b0, CLK_HZ == 0, value, strobe, wdata, npi_addr_ack_i, npi_wr_empty_i,
          npi_wr_almost_full_i, npi_rd_data_i,
                    npi_rd_word_i, npi_rd_empty_i, 1'b0};
endmodule
