// SPDX-License-Identifier: MIT
//
// shift_order: macros for counters with 2**BITS states that count in the order of a shift register.
//
// Such a counter needs one to four LUTs in total, instead of one per bit. It can be used if only
// the number of states matters, not their numeric order. BITS is 2..24. The order begins with 0, 1
// and ends with the state in which only the highest bit is set.

// SHIFT_TAPS is a constant: the taps from Xilinx XAPP052. With these taps a shift register has
// 2**BITS - 1 states; the order here also includes the state 0.
`define SHIFT_TAPS(BITS) \
    ((BITS) == 5  ? 24'h000014 : \
     (BITS) == 8  ? 24'h0000B8 : \
     (BITS) == 9  ? 24'h000110 : \
     (BITS) == 10 ? 24'h000240 : \
     (BITS) == 11 ? 24'h000500 : \
     (BITS) == 12 ? 24'h000829 : \
     (BITS) == 13 ? 24'h00100D : \
     (BITS) == 14 ? 24'h002015 : \
     (BITS) == 16 ? 24'h00D008 : \
     (BITS) == 17 ? 24'h012000 : \
     (BITS) == 18 ? 24'h020400 : \
     (BITS) == 19 ? 24'h040023 : \
     (BITS) == 20 ? 24'h090000 : \
     (BITS) == 21 ? 24'h140000 : \
     (BITS) == 23 ? 24'h420000 : \
     (BITS) == 24 ? 24'hE10000 : \
     24'd3 << (BITS) - 2)

// SHIFT_ORDER declares the function after(from), which returns the next state.
`define SHIFT_ORDER(after, BITS) \
    function [(BITS)-1:0] after; \
        input [(BITS)-1:0] from; \
        after = {from[(BITS)-2:0], \
                 ^(`SHIFT_TAPS(BITS) & {{24-(BITS){1'b0}}, from}) ^ !(|from[(BITS)-2:0])}; \
    endfunction

// SHIFT_NUMBERS declares the functions place_of(number) and number_of(from), for constants and
// proofs.
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
