// SPDX-License-Identifier: MIT
//
// wiring: macros that declare and connect the signals of slots and memory ports, for all modules
// that wire blocks together: the chip, its generated cores, and the synthesis of Table I
// (docs/bus.md, docs/memory.md).

// PLATFORM_CLOCK is the clock of bridge, decoder, modem and system slot. In the simulator it may
// rest while cores and memory work (quiet_span.h), and the memory's while that is idle (sim_soc.v).
`ifdef PLATFORM_RESTS
`define PLATFORM_CLOCK platform_clk
`define MEMORY_CLOCK memory_clk_i
`else
`define PLATFORM_CLOCK clk_i
`define MEMORY_CLOCK clk_i
`endif

// SLOT_WIRES declares the wires between the bus decoder and `count` slots; interrupt lines are those
// of slots 1 and up.
`define SLOT_WIRES(count) \
    wire [(count)-1:0]    slot_valid, slot_ready, slot_error; \
    wire [32*(count)-1:0] slot_rdata; \
    wire [4*(count)-1:0]  slot_addr; \
    wire [31:0]           slot_wdata; \
    wire                  slot_write; \
    wire [(count)-1:1]    slot_irq;

// SLOT connects the block in slot n.
`define SLOT(n) \
    .bus_valid_i(slot_valid[n]), .bus_write_i(slot_write), .bus_addr_i(slot_addr[4*(n) +: 4]), \
    .bus_wdata_i(slot_wdata), .bus_ready_o(slot_ready[n]), .bus_rdata_o(slot_rdata[32*(n) +: 32]), \
    .bus_error_o(slot_error[n])

// NPI_WIRES declares the wires of `count` memory ports.
`define NPI_WIRES(count) \
    wire [32*(count)-1:0] npi_addr; \
    wire [(count)-1:0]    npi_addr_req, npi_addr_ack, npi_rnw, npi_rmw, npi_wr_push, npi_wr_empty; \
    wire [(count)-1:0]    npi_wr_almost_full, npi_wr_flush, npi_rd_pop, npi_rd_empty, npi_rd_flush; \
    wire [(count)-1:0]    npi_init_done; \
    wire [4*(count)-1:0]  npi_size, npi_rd_word; \
    wire [64*(count)-1:0] npi_wr_data, npi_rd_data; \
    wire [8*(count)-1:0]  npi_wr_be;

// NPI connects the block with memory port n.
`define NPI(n) \
    .npi_addr_o(npi_addr[32*(n) +: 32]), .npi_addr_req_o(npi_addr_req[n]), \
    .npi_addr_ack_i(npi_addr_ack[n]), .npi_rnw_o(npi_rnw[n]), .npi_size_o(npi_size[4*(n) +: 4]), \
    .npi_rmw_o(npi_rmw[n]), .npi_wr_data_o(npi_wr_data[64*(n) +: 64]), \
    .npi_wr_be_o(npi_wr_be[8*(n) +: 8]), .npi_wr_push_o(npi_wr_push[n]), \
    .npi_wr_empty_i(npi_wr_empty[n]), .npi_wr_almost_full_i(npi_wr_almost_full[n]), \
    .npi_wr_flush_o(npi_wr_flush[n]), .npi_rd_data_i(npi_rd_data[64*(n) +: 64]), \
    .npi_rd_word_i(npi_rd_word[4*(n) +: 4]), .npi_rd_pop_o(npi_rd_pop[n]), \
    .npi_rd_empty_i(npi_rd_empty[n]), .npi_rd_flush_o(npi_rd_flush[n]), \
    .npi_init_done_i(npi_init_done[n])

// NPI_MEMORY connects the memory behind all ports.
`define NPI_MEMORY \
    .npi_addr_i(npi_addr), .npi_addr_req_i(npi_addr_req), .npi_addr_ack_o(npi_addr_ack), \
    .npi_rnw_i(npi_rnw), .npi_size_i(npi_size), .npi_rmw_i(npi_rmw), .npi_wr_data_i(npi_wr_data), \
    .npi_wr_be_i(npi_wr_be), .npi_wr_push_i(npi_wr_push), .npi_wr_empty_o(npi_wr_empty), \
    .npi_wr_almost_full_o(npi_wr_almost_full), .npi_wr_flush_i(npi_wr_flush), \
    .npi_rd_data_o(npi_rd_data), .npi_rd_word_o(npi_rd_word), .npi_rd_pop_i(npi_rd_pop), \
    .npi_rd_empty_o(npi_rd_empty), .npi_rd_flush_i(npi_rd_flush), .npi_init_done_o(npi_init_done)

// MEMORY_RESTS says that nobody asks the memory_mcb `memory` for anything, and that it owes nothing:
// then it does not move (memory_rest_proof.v).
`define MEMORY_RESTS(memory) \
    !(|{memory.npi_addr_req_i, memory.npi_wr_push_i, memory.npi_wr_flush_i, memory.npi_rd_pop_i, \
        memory.npi_rd_flush_i, memory.u_arbiter.u_queue.moving, memory.u_arbiter.u_queue.coming, \
        memory.u_arbiter.u_queue.cmd_valid_o})
