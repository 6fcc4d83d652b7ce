#!/bin/sh
# SPDX-License-Identifier: MIT
# cores: source-folder build-folder work-folder   Builds a simulator with the cores of a list of its own, and calls them by radio.
set -eu
source=$1 build=$2 work=$3
mkdir -p "$work"
{
    echo '# No vision core here.'
    echo sample_verilog
    echo 'sample_vhdl identity=newcomer slot=9'
    echo scaler
} >"$work/cores.list"
samples=$build/tests/ip/new
folders="$samples/sample_verilog;$samples/sample_vhdl;$source/tests/e2e/cores/scaler"
# GHDL is fetched once.
mkdir -p "$work/build"
[ -e "$work/build/ghdl" ] || ln -s "$build/ghdl" "$work/build/ghdl"
cmake -S "$source" -B "$work/build" -G Ninja "-DCORES=$work/cores.list" "-DCORE_FOLDERS=$folders" \
    "-DROOMS=bus;slice;ip;sw;hdl;testbench" >"$work/build.log" 2>&1 &&
    ninja -C "$work/build" icesoc-sim >>"$work/build.log" 2>&1 || { tail -40 "$work/build.log" && exit 1; }
"$work/build/testbench/sim/icesoc-sim" --size 96x64 --image /usr/share/xplanet/images/earth.jpg --out "$work" --seed "${SEED:-1}" --guard 20 -- \
    /usr/bin/python3 "$source/tests/e2e/cores/client.py" '{device}' '{guard}' '{status}' "$build/ground/xbeeat:createXBeeAT" \
    "$samples/sample_verilog/sample_verilog.ice" "$source/tests/slice/hardware/golden/scaler.ice" "$samples/sample_vhdl/sample_vhdl.ice" \
    >"$work/log" 2>&1 || { cat "$work/log" && exit 1; }
grep -q 'cores: all as expected' "$work/log" || { cat "$work/log" && exit 1; }
