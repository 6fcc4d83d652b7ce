#!/bin/sh
# SPDX-License-Identifier: MIT
# memories: slice2c source-folder generated-folder work-folder   Three cores with buffers of different sizes, in
# every order of ip/cores.list: in the simulated chip none writes into another's memory. And the proof for two generated wrappers:
# whatever is written to them besides, no byte of one's buffers is a byte of the other's.
set -eu
slice2c=$1 source=$2 gen=$3 work=$4 coremap=$2/bus/coremap.py regmap=$2/bus/regmap.py
here=$(cd "$(dirname "$0")" && pwd)
rm -rf "$work"
mkdir -p "$work"
"$slice2c" "$here/fillers.ice" --output-dir "$work/c" --hw-verilog "$work" --hw-regs "$work"
for core in little=128 middle=4096 big=16384; do
    sed "s/@NAME@/${core%=*}/g; s/@BYTES@/${core#*=}/g" "$here/filler.v.in" >"$work/${core%=*}.v"
done
for order in 'little middle big' 'little big middle' 'middle little big' 'middle big little' 'big little middle' 'big middle little'; do
    out=$work/$(echo "$order" | tr ' ' _)
    mkdir "$out"
    echo "$order" | tr ' ' '\n' >"$out/cores.list"
    "$coremap" "$out/cores.list" --base "$source/bus/map.regs.json" --core "little=$work/little.regs.json" \
        --core "middle=$work/middle.regs.json" --core "big=$work/big.regs.json" --output-dir "$out"
    "$regmap" "$out/map.regs.json" --output-dir "$out"
    iverilog -g2005-sv -Wno-timescale -o "$out/chip" -I"$out" -I"$gen" -I"$source/bus" -I"$source/hdl/ddr" -I"$source/hdl/system" -y "$work" -y "$source/bus" -y "$source/hdl/ddr" \
        -y "$source/hdl/fsmc" -y "$source/hdl/cdc" -y "$source/hdl/modem" -y "$source/hdl/system" -s memories_tb "$here/memories_tb.v" "$source/hdl/soc.v" \
        2>"$out/messages" || { cat "$out/messages" && exit 1; }
    vvp -n "$out/chip" >"$out/log"
    echo "$order: $(tail -1 "$out/log")"
    grep -q '^each has its own memory' "$out/log" || { cat "$out/log" && exit 1; }
done
yosys -q -l "$work/proof.log" -p "read_verilog -formal -sv $work/little_wrapper.v $work/middle_wrapper.v $source/bus/bus_registers.v \
    $source/bus/bus_wrapper.v $source/bus/bus_rules.v $here/memories_proof.v; prep -top memories_proof -nordff; flatten; async2sync; \
    dffunmap; chformal -early; setundef -anyseq -undriven; chformal -cover -remove; opt_clean; \
    sat -verify -tempinduct -prove-asserts -set-assumes -seq 1 -maxsteps 4" >/dev/null || { tail -40 "$work/proof.log" && exit 1; }
grep -q 'Induction step proven' "$work/proof.log" || { tail -20 "$work/proof.log" && exit 1; }
echo 'memories: apart in every order, and by proof'
