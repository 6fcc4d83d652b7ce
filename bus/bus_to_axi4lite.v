// SPDX-License-Identifier: MIT
//
// bus_to_axi4lite: connects a slot to a core with an AXI4-Lite slave; it is a 32-bit AXI4-Lite
// master (ARM IHI 0022, chapter B1). bus_window.v describes the words and events.
//
// There is one transfer at a time. An AXI transfer cannot be abandoned: after a time-out the
// handshakes continue until the late response arrives, which is then discarded. Until then, other
// accesses wait, and may also time out.

`default_nettype none

module bus_to_axi4lite #(
    parameter [31:0] ID_VALUE   = 32'd0,
    parameter        ADDR_WIDTH = 12,  // width of a byte address in the core, 3..32
    parameter        TIMEOUT    = 255  // time-out, clocks, 1..255
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
    // interrupt line of the core, a level in the clock domain clk_i
    input  wire                  irq_i
);
    wire busy, write;
    wire [ADDR_WIDTH-1:0] addr;
    wire [31:0] wdata;
    reg  [ADDR_WIDTH-1:2] address;
    reg  open; // a transfer has begun and its response has not arrived; no other access starts

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

`ifdef RULES // the rules are included in proofs and in tests of cores
    // Checks of the AXI4-Lite handshakes on the master's side (ARM IHI 0022, A3.1-A3.3, B1.1). The
    // slave may do anything that the standard allows: ready may come before, together with or after
    // valid, and the response may come at any later time or never.
    reg past = 1'b0;
    reg aw_taken = 1'b0, w_taken = 1'b0, ar_taken = 1'b0;
    // the slave has taken address and data, and has not responded yet
    wire write_open = aw_taken && w_taken;
    always @(posedge clk_i) begin
        past     <= past || rst_i;
        aw_taken <= !rst_i &&
            ((aw_taken && !(axi_bvalid_i && axi_bready_o)) || (axi_awvalid_o && axi_awready_i));
        w_taken  <= !rst_i &&
            ((w_taken && !(axi_bvalid_i && axi_bready_o)) || (axi_wvalid_o && axi_wready_i));
        ar_taken <= !rst_i &&
            ((ar_taken && !(axi_rvalid_i && axi_rready_o)) || (axi_arvalid_o && axi_arready_i));
    end
`ifdef FORMAL
    always @* if (!rst_i) begin
// in simulation the checks are made at clock edges, because combinational signals have glitches
`else
    always @(posedge clk_i) if (past && !rst_i) begin
`endif
        // Master: at most one write and one read are in progress.
        assert (!(axi_awvalid_o && aw_taken));
        assert (!(axi_wvalid_o && w_taken));
        assert (!(axi_arvalid_o && ar_taken));
        // Slave (A3.3.1): it responds only after it has taken the complete transfer.
        assume (!axi_bvalid_i || write_open);
        assume (!axi_rvalid_i || ar_taken);
    end
    always @(posedge clk_i) begin
        if (past && $past(rst_i)) // A3.1.2: valid is low after a reset
            assert (!axi_awvalid_o && !axi_wvalid_o && !axi_arvalid_o);
        if (past && !rst_i && !$past(rst_i)) begin
            // A3.2.1: once valid is high, valid and the payload stay unchanged until ready
            if ($past(axi_awvalid_o && !axi_awready_i))
                assert (axi_awvalid_o && axi_awaddr_o == $past(axi_awaddr_o));
            if ($past(axi_wvalid_o && !axi_wready_i))
                assert (axi_wvalid_o && axi_wdata_o == $past(axi_wdata_o));
            if ($past(axi_arvalid_o && !axi_arready_i))
                assert (axi_arvalid_o && axi_araddr_o == $past(axi_araddr_o));
            if ($past(axi_bvalid_i && !axi_bready_o))
                assume (axi_bvalid_i && axi_bresp_i == $past(axi_bresp_i));
            if ($past(axi_rvalid_i && !axi_rready_o))
                assume (axi_rvalid_i && axi_rdata_i == $past(axi_rdata_i) &&
                        axi_rresp_i == $past(axi_rresp_i));
        end
    end
`endif
`ifdef FORMAL
    // Each access that succeeds has had exactly one transfer, and returns the core's response.
    wire window = bus_valid_i && bus_addr_i[3] && bus_ready_o && !bus_error_o;
    always @* if (!rst_i && window) begin
        assert (open && address[4:2] == bus_addr_i[2:0]);
        assert (bus_write_i ? axi_bvalid_i && !axi_bresp_i[1] && axi_wdata_o == bus_wdata_i
                            : axi_rvalid_i && !axi_rresp_i[1] && bus_rdata_o == axi_rdata_i);
        assert (bus_write_i ? write_open : ar_taken);
    end
    always @* begin // an access to a data word writes the complete word
        assert (axi_wstrb_o == 4'hF && {axi_awprot_o, axi_arprot_o} == 6'd0);
        assert ({axi_awaddr_o[1:0], axi_araddr_o[1:0]} == 4'd0);
        if (!rst_i && bus_valid_i && bus_addr_i[3] && busy && open &&
            (bus_write_i ? axi_bvalid_i : axi_rvalid_i))
            assert (bus_ready_o); // the first response ends the access
    end
    reg was_late = 1'b0; // high after a late response has been discarded
    always @(posedge clk_i)
        was_late <= !rst_i && (was_late || (!busy && response));
    always @* if (!rst_i) begin
        cover (window && bus_write_i && was_late);
        cover (window && !bus_write_i && was_late);
        cover (bus_valid_i && bus_ready_o && bus_error_o && axi_rvalid_i && open);
    end
`endif
endmodule
