#!/bin/sh
# SPDX-License-Identifier: MIT
# sync_bridge: source-folder build-folder work-folder
# Builds simulator and firmware with the FSMC bridge that samples its pins, runs the tests of the
# whole chip, and flies the mission with the host build and with the ARM binary of the firmware.
set -eu
source=$1 build=$2 work=$3
mkdir -p "$work/build"
logged() { "$@" >"$work/log" 2>&1 || { tail -40 "$work/log" && exit 1; }; }
# GHDL is downloaded only once.
[ -e "$work/build/ghdl" ] || ln -s "$build/ghdl" "$work/build/ghdl"
logged cmake -S "$source" -B "$work/build" -G Ninja -DBRIDGE=sync \
    "-DCORES=$(sed -n 's/^CORES:[A-Z]*=//p' "$build/CMakeCache.txt")" \
    "-DCORE_FOLDERS=$(sed -n 's/^CORE_FOLDERS:[A-Z]*=//p' "$build/CMakeCache.txt")" \
    "-DROOMS=bus;slice;ip;sw;hdl;synth;testbench;tests"
logged ninja -C "$work/build" icesoc-sim vision-reference firmware_uav regmaps \
    test_sim_soc test_sim_quiet
logged ctest --test-dir "$work/build" --output-on-failure --no-tests=error \
    -R '^test_sim_(soc|quiet)[.]'
# The ground's programs do not depend on the bridge.
mkdir -p "$work/build/ground"
cp "$build"/ground/*xbeeat* "$work/build/ground"
export XDG_CONFIG_HOME="$work/config" # keys for this test only
for cpu in host m3; do
    logged "$source/icesoc" run --built --build "$work/build" --bridge sync --cpu $cpu \
        --size 96x64 --guard 20 --seed "${SEED:-1}" --out "$work/$cpu"
    grep -q 'the result equals the C++ reference, bit by bit' "$work/log" ||
        { cat "$work/log" && echo 'the result was not compared with the reference' && exit 1; }
done
