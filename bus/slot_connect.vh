// SPDX-License-Identifier: MIT
//
// slot_connect: connects the ports of slot_ports.vh to an instance with the same ports. Include it
// at the beginning of the connection list.

        .clk_i(clk_i), .rst_i(rst_i),
        .bus_valid_i(bus_valid_i), .bus_write_i(bus_write_i), .bus_addr_i(bus_addr_i),
        .bus_wdata_i(bus_wdata_i), .bus_ready_o(bus_ready_o), .bus_rdata_o(bus_rdata_o),
        .bus_error_o(bus_error_o),
