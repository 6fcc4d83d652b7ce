// SPDX-License-Identifier: MIT
//
// fsmc_parameter_rules: checks the parameters of fsmc_bridge and fsmc_sync_bridge at elaboration.

`default_nettype none

// $error as a module item is SystemVerilog, so for Icarus and XST the name of an undefined module
// serves as the message.
`ifdef VERILATOR
    `define TELLS_ERRORS
`endif
`ifdef YOSYS
    `define TELLS_ERRORS
`endif

module fsmc_parameter_rules #(
    parameter MUXED        = 0,
    parameter WAIT_HIGH    = 0,
    parameter TIMEOUT_LOG2 = 12,
    parameter POST_LOG2    = 4,
    parameter BLOCK_LOG2   = 3
);
    generate
        if (MUXED >> 1 != 0 || WAIT_HIGH >> 1 != 0 || TIMEOUT_LOG2 < 1 || TIMEOUT_LOG2 > 24 ||
            POST_LOG2 < 2 || POST_LOG2 > 5 || BLOCK_LOG2 < 1 || BLOCK_LOG2 > 4) begin : g_refused
`ifdef TELLS_ERRORS
            $error("FSMC bridge: MUXED, WAIT_HIGH 0..1, TIMEOUT_LOG2 1..24, POST 2..5, BLOCK 1..4");
`else
            fsmc_bridge_parameter_out_of_range u_refused ();
`endif
        end
    endgenerate
endmodule
