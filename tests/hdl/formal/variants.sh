#!/bin/sh
# SPDX-License-Identifier: MIT
# variants: source-folder work-folder
# Proves that modules with separate code for simulation, for proofs and for the chip act alike.
#
# cdc_bit: without late bits, all three variants equal each other; any late bits that the simulation
# can choose, the prover can choose as well. cdc_copy: without late bits, the variant for simulation
# equals the variant for the chip, which proofs also use.
# core_gate: the variant for simulation equals the variant for the chip with a model of BUFGCE. The
# clock of the variant for proofs rises exactly before the first edge that the chip's gate stops.
# core_clock: its DCM has no model. The variant for simulation has the frequency that the chip's DCM
# is configured for.
set -eu
here=$(dirname "$(readlink -f "$0")") source=$1 work=$2
rm -rf "$work"
mkdir -p "$work/sim"
cd "$work"
cp "$source/hdl/cdc/cdc_bit.v" "$source/hdl/cdc/cdc_copy.v" "$source/hdl/system/core_gate.v" .
cp cdc_bit.v cdc_copy.v sim
# `ungated` has no driver, so it becomes an input.
sed '/initial ungated =/d' core_gate.v >sim/core_gate.v
# Every edge of clk_i is one step of the proof.
sed 's/posedge clk_i or negedge clk_i/posedge clk_i/' "$source/hdl/system/core_clock.v" \
    >sim/core_clock.v
# In the variant for simulation, the random choice becomes an input.
cat >sim/cdc_random.vh <<'END'
    wire [WIDTH-1:0] mask; // has no driver, so `expose` makes it an input
    function [WIDTH-1:0] late(input [WIDTH-1:0] moved);
        late = moved & (TOGETHER != 0 ? {WIDTH{mask[0]}} : mask);
    endfunction
END
# prove NAME script [clocks]: yosys proves all assertions of the module `same` by induction; the
# command `clocks` converts flip-flops
prove() {
    printf '%s\n' "$2" 'hierarchy -top same' proc flatten "${3:-async2sync}" dffunmap opt_clean \
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
# In this proof, every edge of clk_i is a separate step of time.
prove core_gate "$(
    variant simulated core_gate '-DVERILATOR sim/core_gate.v' 'GATED 1'
    variant proven core_gate '-formal -DFORMAL core_gate.v' 'GATED 1'
    variant chip core_gate "core_gate.v $here/BUFGCE.v" 'GATED 1'
    for each in simulated proven chip; do echo "design -import $each -as $each"; done
    echo "chformal -remove"
    echo "read_verilog -formal -sv -DGATE $here/variants.v"
)" clk2fflogic
for ratio in '2 2' '2 5' '3 7' '32 125' '256 256'; do
    # shellcheck disable=SC2086 # words
    set -- $ratio
    prove "core_clock_$1_$2" "$(
        variant simulated core_clock '-DVERILATOR sim/core_clock.v' "MULTIPLY $1 -set DIVIDE $2"
        echo "design -import simulated -as simulated"
        echo "read_verilog -formal -sv -DCLOCK -DWIDTH=1 -DMULTIPLY=$1 -DDIVIDE=$2 $here/variants.v"
    )"
done
