// SPDX-License-Identifier: MIT
//
// table1: the content of the paper's Table I: FSMC bridge, memory controller with two NPI ports,
// radio IP.
//
// The system slot (page register, errors) is not in the table: its signals are ports here, and its
// slot answers as an empty one does.

`default_nettype none

module table1 #(
    parameter CLK_HZ = 100000000 // Hz
) (
    input  wire        clk_i,
    input  wire        rst_i,
    `include "platform_ports.vh"
    // system slot
    input  wire [5:0]  page_i,
    output wire        access_error_o,
    output wire        error_memory_o,
    output wire [9:0]  error_addr_o,
    output wire        error_write_o,
    output wire        late_o,
    output reg         irq_o
);
    localparam SLOTS = 2, PORTS = 2, READ_FIFO = 2'b00, MODEM_API = 0;
    localparam MAP_SLOT_MODEM = 1, MAP_NPI_PORT_FSMC = 0, MAP_NPI_PORT_MODEM = 1;

    wire rst = rst_i;
    `include "platform.vh"

    assign page = page_i;
    assign access_error_o = access_error, error_memory_o = error_memory, error_write_o = error_write;
    assign error_addr_o = error_addr, late_o = late;
    assign slot_ready[0] = 1'b1, slot_error[0] = 1'b1, slot_rdata[31:0] = 32'd0; // nothing in slot 0
    always @(posedge clk_i) irq_o <= slot_irq[MAP_SLOT_MODEM];
    wire unused = &{1'b0, slot_valid[0], slot_addr[3:0], 1'b0};
endmodule
