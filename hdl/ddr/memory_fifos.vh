// SPDX-License-Identifier: MIT
//
// memory_fifos: parameters of the memory (memory_mcb.v) in the chip, with one bit per memory port.
// Include it in the body of a module that has PORTS and map_regs.vh.

    // The bridge and the modem take each read word in the cycle in which it arrives, so they need
    // no FIFO.
    localparam [31:0] NO_READ_FIFO = 1 << MAP_NPI_PORT_FSMC | 1 << MAP_NPI_PORT_MODEM;
    localparam [PORTS-1:0] READ_FIFO = ~NO_READ_FIFO[PORTS-1:0];
    // The modem writes single bytes, so its write FIFO stores one lane.
    localparam [31:0] WRITES_BYTES = 1 << MAP_NPI_PORT_MODEM;
    localparam [PORTS-1:0] BYTES = WRITES_BYTES[PORTS-1:0];
