// SPDX-License-Identifier: MIT
//
// bus_to_axi4lite: a slot that is an AXI4-Lite master of 32 bits (ARM IHI 0022, chapter B1).
// Words and events: bus_window.v.
//
// One transfer at a time. AXI has no way to give a transfer up: after a time-out the handshakes go on
// until the late response has come and is thrown away; accesses until then wait, and time out.

`default_nettype none

module bus_to_axi4lite #(
    parameter [31:0] ID_VALUE   = 32'd0,
    parameter        ADDR_WIDTH = 12,  // of the core's byte addresses, 3..32
    parameter        TIMEOUT    = 255  // clocks, 1..255
) (
    `include "slot_ports.vh"
    output wire                  irq_o,
    // AXI4-Lite master
    output reg                   axi_awvalid_o,
    input  wire                  axi_awready_i,
    output wire [ADDR_WIDTH-1:0] axi_awaddr_o,
    output wire [2:0]            axi_awprot_o,
    output reg                   axi_wvalid_o,
    input  wire                  axi_wready_i,
    output reg  [31:0]           axi_wdata_o,
    output wire [3:0]            axi_wstrb_o,
    input  wire                  axi_bvalid_i,
    output wire                  axi_bready_o,
    input  wire [1:0]            axi_bresp_i,
    output reg                   axi_arvalid_o,
    input  wire                  axi_arready_i,
    output wire [ADDR_WIDTH-1:0] axi_araddr_o,
    output wire [2:0]            axi_arprot_o,
    input  wire                  axi_rvalid_i,
    output wire                  axi_rready_o,
    input  wire [31:0]           axi_rdata_i,
    input  wire [1:0]            axi_rresp_i,
    input  wire                  irq_i // the core's interrupt line, a level of clk_i
);
    wire busy, write;
    wire [ADDR_WIDTH-1:0] addr;
    wire [31:0] wdata;
    reg  [ADDR_WIDTH-1:2] address;
    reg  open; // a transfer has begun and its response has not come; no access starts meanwhile

    wire response = (axi_bvalid_i && axi_bready_o) || (axi_rvalid_i && axi_rready_o);

    bus_window #(.ID_VALUE(ID_VALUE), .ADDR_WIDTH(ADDR_WIDTH), .TIMEOUT(TIMEOUT)) u_window (
        `include "slot_connect.vh"
        .irq_o(irq_o),
        .idle_i(!open), .busy_o(busy), .write_o(write), .addr_o(addr), .wdata_o(wdata),
        .done_i(response), .error_i(write ? axi_bresp_i[1] : axi_rresp_i[1]),
        .rdata_i(axi_rdata_i), .irq_i(irq_i)
    );

    assign axi_awaddr_o = {address, 2'b00};
    assign axi_araddr_o = {address, 2'b00};
    assign axi_awprot_o = 3'b000;
    assign axi_arprot_o = 3'b000;
    assign axi_wstrb_o  = 4'hF;
    assign axi_bready_o = open;
    assign axi_rready_o = open;

    always @(posedge clk_i) begin
        if (axi_awready_i)
            axi_awvalid_o <= 1'b0;
        if (axi_wready_i)
            axi_wvalid_o <= 1'b0;
        if (axi_arready_i)
            axi_arvalid_o <= 1'b0;
        if (busy && !open) begin
            open          <= 1'b1;
            address       <= addr[ADDR_WIDTH-1:2];
            axi_wdata_o   <= wdata;
            axi_awvalid_o <= write;
            axi_wvalid_o  <= write;
            axi_arvalid_o <= !write;
        end else if (response) begin
            open <= 1'b0;
        end
        if (rst_i) begin
            open          <= 1'b0;
            axi_awvalid_o <= 1'b0;
            axi_wvalid_o  <= 1'b0;
            axi_arvalid_o <= 1'b0;
        end
    end

    wire unused = &{1'b0, addr[1:0], axi_bresp_i[0], axi_rresp_i[0], 1'b0};

`ifdef RULES // in proofs, and in tests of cores
    wire write_open, read_open;
    axi4lite_rules #(.ADDR_WIDTH(ADDR_WIDTH)) u_axi (
        .clk_i(clk_i), .rst_i(rst_i),
        .awvalid_i(axi_awvalid_o), .awready_i(axi_awready_i), .awaddr_i(axi_awaddr_o),
        .wvalid_i(axi_wvalid_o), .wready_i(axi_wready_i), .wdata_i(axi_wdata_o),
        .bvalid_i(axi_bvalid_i), .bready_i(axi_bready_o), .bresp_i(axi_bresp_i),
        .arvalid_i(axi_arvalid_o), .arready_i(axi_arready_i), .araddr_i(axi_araddr_o),
        .rvalid_i(axi_rvalid_i), .rready_i(axi_rready_o), .rdata_i(axi_rdata_i),
        .rresp_i(axi_rresp_i), .write_open_o(write_open), .read_open_o(read_open));
`endif
`ifdef FORMAL
    // Each answered access is answered by its own transfer, with what the core said.
    wire window = bus_valid_i && bus_addr_i[3] && bus_ready_o && !bus_error_o;
    always @* if (!rst_i && window) begin
        assert (open && address[4:2] == bus_addr_i[2:0]);
        assert (bus_write_i ? axi_bvalid_i && !axi_bresp_i[1] && axi_wdata_o == bus_wdata_i
                            : axi_rvalid_i && !axi_rresp_i[1] && bus_rdata_o == axi_rdata_i);
        assert (bus_write_i ? write_open : read_open);
    end
    reg was_late = 1'b0; // a late response has been thrown away
    always @(posedge clk_i)
        was_late <= !rst_i && (was_late || (!busy && response));
    always @* if (!rst_i) begin
        cover (window && bus_write_i && was_late);
        cover (window && !bus_write_i && was_late);
        cover (bus_valid_i && bus_ready_o && bus_error_o && axi_rvalid_i && open);
    end
`endif
`ifdef COVER_POINTS
    data_before_address: cover property (@(posedge clk_i) axi_wvalid_o && axi_wready_i && axi_awvalid_o && !axi_awready_i);
    address_before_data: cover property (@(posedge clk_i) axi_awvalid_o && axi_awready_i && axi_wvalid_o && !axi_wready_i);
    late_answer: cover property (@(posedge clk_i) response && !busy);
`endif
endmodule
