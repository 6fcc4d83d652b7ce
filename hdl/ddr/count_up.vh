// SPDX-License-Identifier: MIT
//
// count_up: macro for binary counters without a carry chain.
//
// In a carry chain, each bit takes a LUT site. Without one, two bits usually share a site, but a
// counter of more than six bits needs several LUTs in series.

// COUNT_UP declares the function up(from), which returns the next number; 0 follows the greatest.
// ~up(~from) is the previous number.
`define COUNT_UP(up, BITS) \
    function automatic [(BITS)-1:0] up; \
        input [(BITS)-1:0] from; \
        integer i; \
        reg carry; \
        begin \
            carry = 1'b1; \
            for (i = 0; i < (BITS); i = i + 1) begin \
                up[i] = from[i] ^ carry; \
                carry = carry && from[i]; \
            end \
        end \
    endfunction
