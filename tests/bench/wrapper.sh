#!/bin/sh
# SPDX-License-Identifier: MIT
# wrapper: what generating a wrapper costs: LUTs and flip-flops of the one of a new core (ip/template) in Verilog, in VHDL,
# and of wrapper_minimum.v, written by hand, which is shown to do the same clock by clock, from reset on.
# Usage: wrapper.sh source-folder slice2c ghdl out.json [--brief]     --brief: fewer clocks, and the size of the last only
set -eu
source=$1 slice2c=$2 ghdl=$3 json=$4 clocks=13
[ "${5:-}" != --brief ] || clocks=6
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT TERM HUP
sed 's/@NAME@/sample/g; s/@TYPE@/Sample/g; s/@MODULE@/Cores/g' "$source/ip/template/NAME.ice.in" >"$work/sample.ice"
"$slice2c" "$work/sample.ice" --output-dir "$work" --hw-verilog "$work" --hw-vhdl "$work"
"$ghdl" -a --std=08 --workdir="$work" "$work/sample_wrapper.vhd"
"$ghdl" --synth --std=08 --workdir="$work" --out=verilog sample_wrapper >"$work/from_vhdl.v"
generated="$source/bus/bus_registers.v $source/bus/bus_wrapper.v $work/sample_wrapper.v" minimum=$source/tests/bench/wrapper_minimum.v

# Equal: a reset for two clocks, then whatever may come for 12 more: a write, what it begins, its end, reads of all that.
timeout 120 yosys -q -p "read_verilog -I$source/bus $generated $minimum; hierarchy -check; proc; flatten
    miter -equiv -flatten sample_wrapper wrapper_minimum both; hierarchy -top both; opt -full
    sat -verify -set-at 1 in_rst_i 1 -set-at 2 in_rst_i 1 -seq 2 -prove trigger 0 -tempinduct-baseonly -maxsteps $clocks both" >"$work/equal" 2>&1 || {
    cat "$work/equal" && echo 'wrapper: wrapper_minimum.v does something else' >&2 && exit 1
}

size() { # top, files: "luts flip-flops"
    top=$1 && shift
    sed -e "s|@INCLUDES@|-I$source/bus|; s|@SOURCES@|$*|; s|@PARAMETERS@||; s|@TOP@|$top|" -e "/@MAP@/r $source/synth/yosys/xilinx_map.ys" \
        -e '/@MAP@/d; /^select A:top/,$d' "$source/synth/yosys/xc6s.ys" |
        sed 's|@ORDER@||' >"$work/$top.ys"
    echo "tee -o $work/$top.stat stat" >>"$work/$top.ys"
    yosys -q -s "$work/$top.ys" >"$work/$top.log" 2>&1 || { cat "$work/$top.log" >&2 && exit 1; }
    awk '$1 ~ /^LUT[1-6]$/ { l += $2 } $1 ~ /^FD/ { f += $2 } END { print l + 0, f + 0 }' "$work/$top.stat"
}
# shellcheck disable=SC2086 # a list of files
b=$(size wrapper_minimum "$minimum")
[ "${5:-}" != --brief ] || { echo "the one by hand: $b LUTs and flip-flops" && exit 0; }
a=$(size sample_wrapper $generated)
c=$(size sample_wrapper "$work/from_vhdl.v")
mkdir -p "$(dirname "$json")"
echo "$a $b $c" | awk -v json="$json" '{
    form = "{\"name\": \"wrapper of a new core, %s\", \"value\": %d, \"unit\": \"%s\", \"by_hand\": %d, \"in_vhdl\": %d, \"command\": \"make bench\"}"
    printf "[" form ",\n " form "]\n", "LUTs", $1, "LUTs", $3, $5, "flip-flops", $2, "flip-flops", $4, $6 > json
    printf "wrapper of a new core: %d LUTs, %d flip-flops; written by hand: %d LUTs, %d flip-flops; in VHDL: %d LUTs, %d flip-flops\n", $1, $2, $3, $4, $5, $6 }'
