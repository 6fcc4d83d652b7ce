// SPDX-License-Identifier: MIT
//
// axil_words: an AXI core for tests, in the style of other people: four words, signals for bursts,
// names in capitals, an active-low reset. It accepts an address after `aw_late` clocks and data
// after `w_late` clocks, so either can come first. It answers `late` clocks later, if it is awake
// and the request is for a single word.

module axil_words (
    input             S_AXI_ACLK, S_AXI_ARESETN, S_AXI_AWAKEUP,
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
    output     [1:0]  S_AXI_RRESP,
    input      [3:0]  S_AXI_AWID, S_AXI_WID, S_AXI_ARID,
    input      [7:0]  S_AXI_AWLEN, S_AXI_ARLEN,
    input      [2:0]  S_AXI_AWSIZE, S_AXI_ARSIZE,
    input      [1:0]  S_AXI_AWBURST, S_AXI_ARBURST,
    input             S_AXI_WLAST,
    output     [3:0]  S_AXI_BID, S_AXI_RID,
    output            S_AXI_RLAST,
    input      [2:0]  aw_late, w_late, late
);
    reg  [31:0] words [0:3];
    reg  [2:0]  aw_waited, w_waited, waited;
    reg         has_aw, has_w, has_ar;
    reg  [1:0]  word;
    reg  [31:0] value;
    // While idle, a channel is ready if its delay is 0.
    assign S_AXI_AWREADY = !has_aw && aw_waited == aw_late;
    assign S_AXI_ARREADY = !has_ar && aw_waited == aw_late;
    assign S_AXI_WREADY  = !has_w && w_waited == w_late;
    assign {S_AXI_BRESP, S_AXI_RRESP} = 4'd0;
    assign {S_AXI_BID, S_AXI_RID, S_AXI_RLAST} = {S_AXI_AWID, S_AXI_ARID, 1'b1};
    wire is_single =
        {S_AXI_AWID, S_AXI_WID, S_AXI_ARID, S_AXI_AWLEN, S_AXI_ARLEN, S_AXI_AWSIZE, S_AXI_ARSIZE,
         S_AXI_AWBURST,
                      S_AXI_ARBURST, S_AXI_WLAST, S_AXI_WSTRB,
                          S_AXI_AWAKEUP} == {28'd0, 6'o22, 4'b0101, 6'h3F};
    wire has_all = is_single && (has_ar || (has_aw && has_w));
    always @(posedge S_AXI_ACLK) begin
        aw_waited <= (S_AXI_AWVALID && !S_AXI_AWREADY && !has_aw) ||
            (S_AXI_ARVALID && !S_AXI_ARREADY && !has_ar) ? aw_waited + 1 : 0;
        w_waited  <= S_AXI_WVALID && !S_AXI_WREADY && !has_w ? w_waited + 1 : 0;
        if (S_AXI_AWVALID && S_AXI_AWREADY)
            {has_aw, word} <= {1'b1, S_AXI_AWADDR[3:2]};
        if (S_AXI_ARVALID && S_AXI_ARREADY)
            {has_ar, word} <= {1'b1, S_AXI_ARADDR[3:2]};
        if (S_AXI_WVALID && S_AXI_WREADY)
            {has_w, value} <= {1'b1, S_AXI_WDATA};
        waited <= has_all && waited != late ? waited + 1 : 0;
        if (has_all && waited == late) begin
            {has_aw, has_w, has_ar} <= 3'd0;
            if (has_aw)
                words[word] <= value;
            S_AXI_RDATA  <= words[word];
            S_AXI_BVALID <= has_aw;
            S_AXI_RVALID <= has_ar;
        end
        if (S_AXI_BVALID && S_AXI_BREADY)
            S_AXI_BVALID <= 0;
        if (S_AXI_RVALID && S_AXI_RREADY)
            S_AXI_RVALID <= 0;
        if (!S_AXI_ARESETN)
            {S_AXI_BVALID, S_AXI_RVALID, has_aw, has_w, has_ar, aw_waited, w_waited, waited} <= 0;
    end
endmodule
