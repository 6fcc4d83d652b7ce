// SPDX-License-Identifier: MIT
//
// rests: the conditions under which the simulator stops clocks of the chip (sim_soc.v).
// rest_proof.v and memory_rest_proof.v prove that a block would not change its state while its
// clock is stopped.

// MEMORY_RESTS is true while no port of `memory`, an instance of memory_mcb, has a request, no port
// stores a part of a word in its write FIFO, and no transfer is pending. The memory then keeps its
// state. Only port 0, of the bridge, stores parts of words (MERGE).
`define MEMORY_RESTS(memory) \
    !(|{memory.npi_addr_req_i, memory.npi_wr_push_i, memory.npi_wr_flush_i, memory.npi_rd_pop_i, \
        memory.npi_rd_flush_i, memory.u_arbiter.u_queue.moving, memory.u_arbiter.u_queue.coming, \
        memory.u_arbiter.u_queue.cmd_valid_o, memory.npi_wr_be_i[7:0]})

// The clock of the memory stops 2**MEMORY_REST_LOG2 clocks later (core_gate.v).
`define MEMORY_REST_LOG2 1

// PLATFORM_STIRS is true while an access to the memory or to the register bus of the platform `p`
// may change the state of the bridge, the decoder, the modem or the system slot. Memory port 0
// belongs to the bridge, port 1 to the modem.
`define PLATFORM_STIRS(p) \
    (!p.calib_done || p.bus_valid || \
     |(p.u_memory.npi_addr_ack_o[1:0] | ~p.u_memory.npi_rd_empty_o[1:0]))
