// SPDX-License-Identifier: MIT
//
// fsmc_parameter_rules: checks the parameters of fsmc_bridge and fsmc_sync_bridge at elaboration.

`default_nettype none

`include "wrong_parameter.vh"

module fsmc_parameter_rules #(
    parameter MUXED        = 0,
    parameter WAIT_HIGH    = 0,
    parameter TIMEOUT_LOG2 = 12,
    parameter POST_LOG2    = 4,
    parameter BLOCK_LOG2   = 3
);
    generate
        if (MUXED >> 1 != 0 || WAIT_HIGH >> 1 != 0 || TIMEOUT_LOG2 < 1 ||
            TIMEOUT_LOG2 > 24) begin : g_pins_refused
            `WRONG_PARAMETER("FSMC bridge: MUXED, WAIT_HIGH is 0..1, TIMEOUT_LOG2 1..24")
        end
        if (POST_LOG2 < 2 || POST_LOG2 > 5 || BLOCK_LOG2 < 1 ||
            BLOCK_LOG2 > 4) begin : g_sizes_refused
            `WRONG_PARAMETER("FSMC bridge: POST_LOG2 is 2..5, BLOCK_LOG2 1..4")
        end
    endgenerate
endmodule
