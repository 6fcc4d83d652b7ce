// SPDX-License-Identifier: MIT
//
// fsmc_timeout: time-out counter of fsmc_bridge and fsmc_sync_bridge.
//
// expired_o is high for one cycle after 2**TIMEOUT_LOG2 clocks in which restart_i was low. Then the
// count starts again.

`default_nettype none
`include "shift_order.vh"

module fsmc_timeout #(
    parameter TIMEOUT_LOG2 = 12 // 1..24
) (
    input  wire clk_i,
    input  wire rst_i,
    input  wire restart_i, // starts the count from zero
    output reg  expired_o
);
    localparam BITS = TIMEOUT_LOG2 > 1 ? TIMEOUT_LOG2 : 2;
    `SHIFT_ORDER(after, BITS)
    localparam [BITS-1:0] LAST = 1 << (TIMEOUT_LOG2 - 1); // state 2**TIMEOUT_LOG2 - 1
    reg [BITS-1:0] patience;

    always @(posedge clk_i) begin
        expired_o <= patience == LAST;
        patience  <= after(patience);
        if (rst_i || expired_o || restart_i) begin
            expired_o <= 1'b0;
            patience  <= 0;
        end
    end

`ifdef FORMAL
    // Proves that the counter expires after 2**TIMEOUT_LOG2 clocks, and at no other time.
    reg          past = 1'b0;
    reg [BITS:0] waited; // clocks since the count started
    initial assume (rst_i);
    always @(posedge clk_i) begin
        past   <= 1'b1;
        waited <= rst_i || restart_i || expired_o ? 0 : waited + 1'b1;
        if (past) begin
            assert (expired_o == (waited == 1 << TIMEOUT_LOG2));
            assert (waited <= 1 << TIMEOUT_LOG2);
        end
        cover (past && expired_o);
        cover (past && expired_o && $past(restart_i, (1 << TIMEOUT_LOG2) + 1));
    end
`endif
endmodule
