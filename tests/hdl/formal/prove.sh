#!/bin/sh
# SPDX-License-Identifier: MIT
# prove: module depth source-folder work-folder [yosys command for parameters]
set -eu
module=$1 depth=$2 source=$3 work=$4 parameters=${5:-}
mkdir -p "$work"
cd "$work"
file=$(find "$source/bus" "$source/hdl" -name "$module.v")
yosys -q -p "read_verilog -formal -sv $file; $parameters; prep -top $module -nordff; memory_nordff; flatten; \
    async2sync; dffunmap; setundef -anyseq -undriven; opt_clean; check; write_smt2 -wires $module.smt2"
run() {
    echo "$module: $1"
    shift
    yosys-smtbmc -s z3 "$@" "$module.smt2" >log 2>&1 || {
        cat log
        exit 1
    }
}
run bounded --presat -t "$depth" --dump-vcd bounded.vcd
run induction -i -t "$depth" --dump-vcd induction.vcd
run cover -c -t $((depth * 4)) --dump-vcd cover%.vcd
