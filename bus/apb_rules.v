// SPDX-License-Identifier: MIT
//
// apb_rules: checks the rules for an APB requester (ARM IHI 0024, 3.1 to 3.4, 4.1) as formal
// properties.
//
// The completer may do anything: PREADY may be high at any time, even in the set-up phase.

`default_nettype none

module apb_rules #(
    parameter ADDR_WIDTH = 12
) (
    input wire                  clk_i,
    input wire                  rst_i,
    input wire                  psel_i,
    input wire                  penable_i,
    input wire                  pwrite_i,
    input wire [ADDR_WIDTH-1:0] paddr_i,
    input wire [31:0]           pwdata_i,
    input wire [3:0]            pstrb_i,
    input wire                  pready_i,
    // the requester may end the transfer in the next clock, without waiting for PREADY
    input wire                  abort_i
);
    reg past = 1'b0;
    always @(posedge clk_i) begin
        past <= past || rst_i;
        if (past && !rst_i && !$past(rst_i)) begin
            // A transfer has a set-up phase of one clock, then an access phase that lasts until
            // PREADY.
            assert (psel_i || !penable_i);
            assert (!penable_i || $past(psel_i));
            assert (!psel_i || pwrite_i || pstrb_i == 4'd0); // PSTRB is 0 in a read
            if ($past(psel_i && !abort_i && !(penable_i && pready_i))) begin
                assert (psel_i && penable_i);
                assert (pwrite_i == $past(pwrite_i) && paddr_i == $past(paddr_i));
                assert (pstrb_i == $past(pstrb_i) && (!pwrite_i || pwdata_i == $past(pwdata_i)));
            end
            if ($past(psel_i && penable_i && pready_i))
                assert (!penable_i);
            // No transfer ends before it has reached its access phase.
            if ($past(psel_i && !penable_i))
                assert (psel_i);
        end
    end
endmodule
