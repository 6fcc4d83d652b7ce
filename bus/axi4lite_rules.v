// SPDX-License-Identifier: MIT
//
// axi4lite_rules: AXI4-Lite's handshakes as properties of a master (ARM IHI 0022, A3.1-A3.3, B1.1).
//
// The slave's side is assumed, with all its freedom: ready before, with or after valid, a response
// at any later time, or never.

`default_nettype none

module axi4lite_rules #(
    parameter ADDR_WIDTH = 12
) (
    input  wire                  clk_i,
    input  wire                  rst_i,
    input  wire                  awvalid_i,
    input  wire                  awready_i,
    input  wire [ADDR_WIDTH-1:0] awaddr_i,
    input  wire                  wvalid_i,
    input  wire                  wready_i,
    input  wire [31:0]           wdata_i,
    input  wire                  bvalid_i,
    input  wire                  bready_i,
    input  wire [1:0]            bresp_i,
    input  wire                  arvalid_i,
    input  wire                  arready_i,
    input  wire [ADDR_WIDTH-1:0] araddr_i,
    input  wire                  rvalid_i,
    input  wire                  rready_i,
    input  wire [31:0]           rdata_i,
    input  wire [1:0]            rresp_i,
    output wire                  write_open_o, // address and data taken, no response yet
    output wire                  read_open_o
);
    reg past = 1'b0;
    reg aw_taken = 1'b0, w_taken = 1'b0, ar_taken = 1'b0;
    assign write_open_o = aw_taken && w_taken;
    assign read_open_o  = ar_taken;
    always @(posedge clk_i) begin
        past     <= past || rst_i;
        aw_taken <= !rst_i && ((aw_taken && !(bvalid_i && bready_i)) || (awvalid_i && awready_i));
        w_taken  <= !rst_i && ((w_taken && !(bvalid_i && bready_i)) || (wvalid_i && wready_i));
        ar_taken <= !rst_i && ((ar_taken && !(rvalid_i && rready_i)) || (arvalid_i && arready_i));
    end
`ifdef FORMAL
    always @* if (!rst_i) begin
`else // a simulator has glitches
    always @(posedge clk_i) if (past && !rst_i) begin
`endif
        // Master: one transfer of each kind at a time.
        assert (!(awvalid_i && aw_taken));
        assert (!(wvalid_i && w_taken));
        assert (!(arvalid_i && ar_taken));
        // Slave (A3.3.1): no response before all of its transfer was taken.
        assume (!bvalid_i || write_open_o);
        assume (!rvalid_i || read_open_o);
    end
    always @(posedge clk_i) begin
        if (past && $past(rst_i)) // A3.1.2: no valid after reset
            assert (!awvalid_i && !wvalid_i && !arvalid_i);
        if (past && !rst_i && !$past(rst_i)) begin
            // A3.2.1: valid, once high, stays with its payload until ready
            if ($past(awvalid_i && !awready_i))
                assert (awvalid_i && awaddr_i == $past(awaddr_i));
            if ($past(wvalid_i && !wready_i))
                assert (wvalid_i && wdata_i == $past(wdata_i));
            if ($past(arvalid_i && !arready_i))
                assert (arvalid_i && araddr_i == $past(araddr_i));
            if ($past(bvalid_i && !bready_i))
                assume (bvalid_i && bresp_i == $past(bresp_i));
            if ($past(rvalid_i && !rready_i))
                assume (rvalid_i && rdata_i == $past(rdata_i) && rresp_i == $past(rresp_i));
        end
    end
endmodule
