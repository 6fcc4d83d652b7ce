// SPDX-License-Identifier: MIT
//
// cdc_random: draws which bits a flip-flop takes with their old value, because they moved near its
// clock's edge; only for simulation.
//
// It is included in the body of a module with WIDTH and TOGETHER. No bit is late unless the run is
// given +cdc_random (testbench/common/observer.h), and only bits that have moved are drawn: a chip
// at rest stays at rest.

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
