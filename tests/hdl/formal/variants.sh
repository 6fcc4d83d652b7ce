#!/bin/sh
# SPDX-License-Identifier: MIT
# variants: source-folder work-folder
# Proves that modules with separate code for simulation, for proofs and for the chip act alike.
#
# cdc_bit: without late bits, all three variants equal each other; any late bits that the simulation
# can choose, the prover can choose as well. cdc_copy: without late bits, the variant for simulation
# equals the variant for the chip, which proofs also use.
set -eu
here=$(dirname "$(readlink -f "$0")") source=$1 work=$2
rm -rf "$work"
mkdir -p "$work/sim"
cd "$work"
cp "$source/hdl/cdc/cdc_bit.v" "$source/hdl/cdc/cdc_copy.v" .
cp cdc_bit.v cdc_copy.v sim
# In the variant for simulation, the random choice becomes an input.
cat >sim/cdc_random.vh <<'END'
    wire [WIDTH-1:0] mask; // has no driver, so `expose` makes it an input
    function [WIDTH-1:0] late(input [WIDTH-1:0] moved);
        late = moved & (TOGETHER != 0 ? {WIDTH{mask[0]}} : mask);
    endfunction
END
# prove NAME script: yosys proves all assertions of the module `same` by induction
prove() {
    printf '%s\n' "$2" 'hierarchy -top same' proc flatten async2sync dffunmap opt_clean \
        'sat -tempinduct -prove-asserts -set-assumes -seq 1 -maxsteps 8 -verify' \
        >"$1.ys"
    yosys -q -l "$1.log" "$1.ys" >/dev/null || {
        tail -20 "$1.log"
        echo "variants: $1: the variants differ" >&2
        exit 1
    }
    echo "variants: $1: equal"
}
# variant NAME MODULE "read_verilog options" parameters: reads a module under a new name
variant() {
    printf '%s\n' "read_verilog -sv $3" "chparam -set $4 $2" "hierarchy -top $2" proc \
        'setundef -undriven -expose' "rename -top $1" "design -stash $1"
}
for choice in '1 0 0' '3 0 0' '3 0 1' '5 3 0'; do
    # shellcheck disable=SC2086 # words
    set -- $choice
    size="WIDTH $1 -set TOGETHER $2 -set EXACT $3 -set INITIAL 1"
    prove "cdc_bit_$1_$2_$3" "$(
        variant simulated cdc_bit '-DVERILATOR sim/cdc_bit.v' "$size"
        variant proven cdc_bit '-DFORMAL cdc_bit.v' "$size"
        variant chip cdc_bit cdc_bit.v "$size"
        for each in simulated proven chip; do echo "design -import $each -as $each"; done
        echo "read_verilog -formal -sv -DWIDTH=$1 -DTOGETHER=$2 $here/variants.v"
    )"
done
prove cdc_copy "$(
    variant simulated cdc_copy '-DVERILATOR sim/cdc_copy.v' 'WIDTH 4'
    variant chip cdc_copy cdc_copy.v 'WIDTH 4'
    for each in simulated chip; do echo "design -import $each -as $each"; done
    echo "read_verilog -formal -sv -DCOPY -DWIDTH=4 $here/variants.v"
)"
