#!/bin/sh
# SPDX-License-Identifier: MIT
# constraints: source-folder generated-folder work-folder   The chip's paths and pads against the
# constraints for ISE.
set -eu
source=$1 gen=$2 work=$3
here=$(dirname "$(readlink -f "$0")")
mkdir -p "$work"
libraries=$(printf ' -libdir %s' "$gen" "$source"/bus "$source"/hdl/*/ "$source"/hdl \
    "$source"/ip/*/)
ise=$source/synth/ise
yosys -q -p "verilog_defaults -add -I$gen -I$source/bus -I$source/hdl/ddr -I$source/hdl/system
    read_verilog $ise/chip.v; read_verilog -lib $here/mig.v; hierarchy -top chip $libraries; proc
    flatten; tribuf; opt_clean; memory -nomap; opt_clean; write_json $work/chip.json" \
    >"$work/yosys.log" 2>&1 || { cat "$work/yosys.log"; exit 2; }
# As a board has them: with MIG's.
"$ise/merge_ucf.py" "$here/mig.ucf" "$ise/chip.ucf" "$gen/core_pins.ucf" "$ise/board.ucf" \
    >"$work/all.ucf" 2>"$work/renamed"
diff "$here/mig.renamed" "$work/renamed" ||
    { echo "what merge_ucf.py says it renamed is not mig.renamed"; exit 1; }
exec "$here/constraints.py" "$work/chip.json" "$ise" "$ise/chip.ucf" "$gen/core_pins.ucf" \
    "$ise/board.ucf"
