// SPDX-License-Identifier: MIT
//
// axil_words: an AXI4-Lite core as others write them: four words, capitals, a reset that is low.

module axil_words (
    input             S_AXI_ACLK, S_AXI_ARESETN,
    input             S_AXI_AWVALID,
    output            S_AXI_AWREADY,
    input      [3:0]  S_AXI_AWADDR,
    input      [2:0]  S_AXI_AWPROT,
    input             S_AXI_WVALID,
    output            S_AXI_WREADY,
    input      [31:0] S_AXI_WDATA,
    input      [3:0]  S_AXI_WSTRB,
    output reg        S_AXI_BVALID,
    input             S_AXI_BREADY,
    output     [1:0]  S_AXI_BRESP,
    input             S_AXI_ARVALID,
    output            S_AXI_ARREADY,
    input      [3:0]  S_AXI_ARADDR,
    input      [2:0]  S_AXI_ARPROT,
    output reg        S_AXI_RVALID,
    input             S_AXI_RREADY,
    output reg [31:0] S_AXI_RDATA,
    output     [1:0]  S_AXI_RRESP
);
    reg [31:0] words [0:3];
    wire take = S_AXI_AWVALID && S_AXI_WVALID && (!S_AXI_BVALID || S_AXI_BREADY);
    assign {S_AXI_AWREADY, S_AXI_WREADY} = {2{take}};
    assign {S_AXI_BRESP, S_AXI_RRESP} = 4'd0;
    assign S_AXI_ARREADY = !S_AXI_RVALID || S_AXI_RREADY;
    always @(posedge S_AXI_ACLK) begin
        if (take)
            words[S_AXI_AWADDR[3:2]] <= S_AXI_WDATA;
        S_AXI_BVALID <= take || (S_AXI_BVALID && !S_AXI_BREADY);
        if (S_AXI_ARVALID && S_AXI_ARREADY)
            S_AXI_RDATA <= words[S_AXI_ARADDR[3:2]];
        S_AXI_RVALID <= (S_AXI_ARVALID && S_AXI_ARREADY) || (S_AXI_RVALID && !S_AXI_RREADY);
        if (!S_AXI_ARESETN)
            {S_AXI_BVALID, S_AXI_RVALID} <= 2'b00;
    end
endmodule
