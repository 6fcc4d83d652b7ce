// SPDX-License-Identifier: MIT
//
// slot_ports: clock, reset and register bus of a core in a slot (docs/bus.md). Include it at the
// beginning of a port list, before irq_o, the memory port (memory_ports.vh) and pins.

    input  wire        clk_i,
    input  wire        rst_i,
    // register bus
    input  wire        bus_valid_i,
    input  wire        bus_write_i,
    input  wire [3:0]  bus_addr_i,
    input  wire [31:0] bus_wdata_i,
    output wire        bus_ready_o,
    output wire [31:0] bus_rdata_o,
    output wire        bus_error_o,
