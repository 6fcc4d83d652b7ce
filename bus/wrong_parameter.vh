// SPDX-License-Identifier: MIT
//
// wrong_parameter: macro for a generate block that stops the elaboration, because a parameter of
// the module has a wrong value.
//
// $error as a module item is SystemVerilog, which Verilator and Yosys support. Icarus and XST
// report the place of the instance of an unknown module instead.
`ifdef VERILATOR
    `define WRONG_PARAMETER(message) $error(message);
`elsif YOSYS
    `define WRONG_PARAMETER(message) $error(message);
`else
    `define WRONG_PARAMETER(message) wrong_parameter u_wrong_parameter ();
`endif
