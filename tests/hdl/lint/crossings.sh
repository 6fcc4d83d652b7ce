#!/bin/sh
# SPDX-License-Identifier: MIT
# crossings: top clock source-folder generated-folder work-folder yosys-parameters synchronous-input...
# Flattens a module but for those of hdl/cdc, and has crossings.py look at each register's clock.
set -eu
top=$1 clock=$2 source=$3 gen=$4 work=$5 parameters=$6
shift 6
mkdir -p "$work"
folders="$gen $(ls -d "$source"/ip/*/ | tr "\n" " ") $source/bus $source/hdl/fsmc $source/hdl/ddr $source/hdl/modem $source/hdl/system $source/hdl/cdc $source/hdl $source/synth"
file=$(for f in $folders; do ls "$f/$top.v" 2>/dev/null || true; done)
libraries=$(for f in $folders; do printf ' -libdir %s' "$f"; done)
yosys -q -p "verilog_defaults -add -I$gen -I$source/bus -I$source/hdl/ddr -I$source/hdl/system; read_verilog $file; $parameters hierarchy -top $top $libraries;
    proc; setattr -mod -set keep_hierarchy 1 cdc_* *cdc_* *async_fifo*; flatten; opt_clean; memory -nomap; opt_clean;
    write_json $work/$top.json" >"$work/$top.log" 2>&1 || { cat "$work/$top.log"; exit 2; }
exec "$(dirname "$(readlink -f "$0")")/crossings.py" "$work/$top.json" "$top" "$clock" "$@"
