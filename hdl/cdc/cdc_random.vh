// SPDX-License-Identifier: MIT
//
// cdc_random: chooses at random which bits a flip-flop samples with their old value, as if they had
// changed near its clock edge; for simulation only.
//
// The file is included in the body of a module that has WIDTH and TOGETHER. Bits are late only if
// the simulation runs with +cdc_random (testbench/common/observer.h). Only bits that have changed
// can be late, so a chip that is idle stays idle.

    reg uncertain;
    initial uncertain = $test$plusargs("cdc_random") != 0;

    function [WIDTH-1:0] late(input [WIDTH-1:0] moved);
        integer b;
        begin
            late = {WIDTH{1'b0}};
            if (uncertain && moved != {WIDTH{1'b0}})
                for (b = 0; b < WIDTH; b = b + 1)
                    late[b] = b > 0 && TOGETHER != 0 ? late[0] : ($urandom & 32'd1) != 32'd0;
            late = late & moved;
        end
    endfunction
