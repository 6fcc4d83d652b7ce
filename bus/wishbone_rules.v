// SPDX-License-Identifier: MIT
//
// wishbone_rules: the Wishbone B4 handshakes as properties of a master with one transfer at a time.
//
// Numbers are those of the standard's rules (B4, 2010). The slave's side is assumed.

`default_nettype none

module wishbone_rules #(
    parameter PIPELINED  = 0,
    parameter ADDR_WIDTH = 12
) (
    input wire                  clk_i,
    input wire                  rst_i,
    input wire                  cyc_i,
    input wire                  stb_i,
    input wire                  we_i,
    input wire [ADDR_WIDTH-1:0] adr_i,
    input wire [31:0]           dat_i,
    input wire                  ack_i,
    input wire                  err_i,
    input wire                  rty_i,
    input wire                  stall_i,
    input wire                  abort_i, // the master may end the cycle without an answer in the next clock
    output wire                 outstanding_o // pipelined: a strobe was taken and not answered
);
    reg past = 1'b0, outstanding = 1'b0;
    assign outstanding_o = outstanding;
    wire answer = ack_i || err_i || rty_i;
    wire taken  = stb_i && (PIPELINED == 0 ? answer : !stall_i);
    always @(posedge clk_i) begin
        past <= past || rst_i;
        outstanding <= PIPELINED != 0 && !rst_i && cyc_i && !answer && !abort_i && (outstanding || taken);
    end

`ifdef FORMAL
    always @* if (!rst_i) begin
`else // a simulator has glitches
    always @(posedge clk_i) if (past && !rst_i) begin
`endif
        assert (!stb_i || cyc_i);                         // 3.25: CYC whenever STB
        assert (!(stb_i && outstanding));                 // one at a time
        assume (ack_i + err_i + rty_i <= 1);              // 3.45: one of ACK, ERR, RTY
        // 3.55: outside of a cycle a slave may hold its answer, so nothing is assumed there.
        if (PIPELINED != 0 && cyc_i && !outstanding && !taken)
            assume (!answer);                             // 3.35: none before the strobe was taken
    end
    always @(posedge clk_i) begin
        if (past && $past(rst_i))
            assert (!cyc_i && !stb_i);                    // 3.20: reset ends everything
        if (past && !rst_i && !$past(rst_i)) begin
            // Rule 3.60: what qualifies a strobe stays until the strobe is taken.
            if ($past(stb_i && !taken && !abort_i)) begin
                assert (stb_i && cyc_i);
                assert (we_i == $past(we_i) && adr_i == $past(adr_i));
                assert (!we_i || dat_i == $past(dat_i));
            end
            // a taken strobe keeps the cycle open until its answer
            if ($past(PIPELINED != 0 && cyc_i && (outstanding || taken) && !answer && !abort_i))
                assert (cyc_i);
        end
    end
endmodule
