// SPDX-License-Identifier: MIT
//
// BUFGCE: model of Xilinx's clock buffer with enable, for variants.sh. According to UG382, a pulse
// of I passes if CE is high before the rising edge of I; a change of CE during the pulse has no
// effect on this pulse.

`default_nettype none

module BUFGCE (
    input  wire I,
    input  wire CE,
    output wire O
);
    (* gclk *) wire step;
    reg passes; // CE in the last step in which I was low
    always @(posedge step)
        if (!I)
            passes <= CE;
    assign O = I && passes;
endmodule
