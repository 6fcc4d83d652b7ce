// SPDX-License-Identifier: MIT
//
// axil_uart: a slot with ZipCPU's UART (AXI4-Lite, 16 bytes of FIFO each way) behind bus_to_axi4lite. This file is all
// that an AXI4-Lite core needs. The UART itself is under the GPL, version 3; it is fetched, and not part of this tree.

`default_nettype none

module axil_uart (
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
    output wire        irq_o,
    // serial line
    input  wire        rx_i,
    output wire        tx_o
);
    `include "axil_uart_regs.vh"

    wire        awvalid, awready, wvalid, wready, bvalid, bready, arvalid, arready, rvalid, rready, received;
    wire [5:0]  awaddr, araddr;
    wire [2:0]  awprot, arprot;
    wire [31:0] wdata, rdata;
    wire [3:0]  wstrb;
    wire [1:0]  bresp, rresp;

    bus_to_axi4lite #(.ID_VALUE(AXIL_UART_ID_VALUE), .ADDR_WIDTH(6)) u_bus (
        .clk_i(clk_i), .rst_i(rst_i),
        .bus_valid_i(bus_valid_i), .bus_write_i(bus_write_i), .bus_addr_i(bus_addr_i),
        .bus_wdata_i(bus_wdata_i), .bus_ready_o(bus_ready_o), .bus_rdata_o(bus_rdata_o),
        .bus_error_o(bus_error_o), .irq_o(irq_o),
        .axi_awvalid_o(awvalid), .axi_awready_i(awready), .axi_awaddr_o(awaddr), .axi_awprot_o(awprot),
        .axi_wvalid_o(wvalid), .axi_wready_i(wready), .axi_wdata_o(wdata), .axi_wstrb_o(wstrb),
        .axi_bvalid_i(bvalid), .axi_bready_o(bready), .axi_bresp_i(bresp),
        .axi_arvalid_o(arvalid), .axi_arready_i(arready), .axi_araddr_o(araddr), .axi_arprot_o(arprot),
        .axi_rvalid_i(rvalid), .axi_rready_o(rready), .axi_rdata_i(rdata), .axi_rresp_i(rresp),
        .irq_i(received));

    axiluart #(.INITIAL_SETUP(31'd868), .HARDWARE_FLOW_CONTROL_PRESENT(1'b0)) u_core ( // 115,200 baud at 100 MHz
        .S_AXI_ACLK(clk_i), .S_AXI_ARESETN(!rst_i),
        .S_AXI_AWVALID(awvalid), .S_AXI_AWREADY(awready), .S_AXI_AWADDR(awaddr[3:0]), .S_AXI_AWPROT(awprot),
        .S_AXI_WVALID(wvalid), .S_AXI_WREADY(wready), .S_AXI_WDATA(wdata), .S_AXI_WSTRB(wstrb),
        .S_AXI_BVALID(bvalid), .S_AXI_BREADY(bready), .S_AXI_BRESP(bresp),
        .S_AXI_ARVALID(arvalid), .S_AXI_ARREADY(arready), .S_AXI_ARADDR(araddr[3:0]), .S_AXI_ARPROT(arprot),
        .S_AXI_RVALID(rvalid), .S_AXI_RREADY(rready), .S_AXI_RDATA(rdata), .S_AXI_RRESP(rresp),
        .i_uart_rx(rx_i), .o_uart_tx(tx_o), .i_cts_n(1'b0), .o_rts_n(),
        .o_uart_rx_int(received), .o_uart_tx_int(), .o_uart_rxfifo_int(), .o_uart_txfifo_int());
endmodule
