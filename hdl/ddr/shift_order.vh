// SPDX-License-Identifier: MIT
//
// shift_order: macros for counters that go through 2**BITS places in the order of a shift register.
//
// Where only the places count, not their numbers, such a counter takes one to four LUTs in all, not
// one for each bit. BITS is 2..24. The order begins with 0, 1 and ends with the highest bit alone.

// SHIFT_ORDER declares the function after(from): the next place. The taps are those of Xilinx'
// XAPP052, to whose 2**BITS - 1 places it adds 0.
`define SHIFT_ORDER(after, BITS) \
    function [(BITS)-1:0] after; \
        input [(BITS)-1:0] from; \
        reg [23:0] taps; \
        begin \
            case (BITS) \
                5:       taps = 24'h000014; \
                8:       taps = 24'h0000B8; \
                9:       taps = 24'h000110; \
                10:      taps = 24'h000240; \
                11:      taps = 24'h000500; \
                12:      taps = 24'h000829; \
                13:      taps = 24'h00100D; \
                14:      taps = 24'h002015; \
                16:      taps = 24'h00D008; \
                17:      taps = 24'h012000; \
                18:      taps = 24'h020400; \
                19:      taps = 24'h040023; \
                20:      taps = 24'h090000; \
                21:      taps = 24'h140000; \
                23:      taps = 24'h420000; \
                24:      taps = 24'hE10000; \
                default: taps = 24'd3 << (BITS) - 2; \
            endcase \
            after = {from[(BITS)-2:0], \
                     ^(taps & {{24-(BITS){1'b0}}, from}) ^ !(|from[(BITS)-2:0])}; \
        end \
    endfunction

// SHIFT_NUMBERS declares place_of(number) and number_of(from), for constants and proofs.
`define SHIFT_NUMBERS(place_of, number_of, after, BITS) \
    function [(BITS)-1:0] place_of; \
        input integer number; \
        integer i; \
        begin \
            place_of = 0; \
            for (i = 0; i < number; i = i + 1) \
                place_of = after(place_of); \
        end \
    endfunction \
    function [(BITS)-1:0] number_of; \
        input [(BITS)-1:0] from; \
        integer n; \
        begin \
            number_of = 0; \
            for (n = 1; n < 1 << (BITS); n = n + 1) \
                if (place_of(n) == from) \
                    number_of = n[(BITS)-1:0]; \
        end \
    endfunction
