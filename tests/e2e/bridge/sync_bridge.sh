#!/bin/sh
# SPDX-License-Identifier: MIT
# sync_bridge: source-folder build-folder work-folder
# Flies the mission with the FSMC bridge that samples its pins, with the host build and with the ARM
# binary of the firmware, and replays a flight. The commands build the simulator and the firmware
# with this bridge in build/sync. Then runs the tests of the whole chip with this bridge.
set -eu
source=$1 build=$2 work=$3
mkdir -p "$work"
cd "$source"
logged() { "$@" >"$work/log" 2>&1 || { tail -60 "$work/log" && exit 1; }; }
prints() { grep -Fq "$1" "$work/log" || { cat "$work/log" && echo "not printed: $1" && exit 1; }; }
export XDG_CONFIG_HOME="$work/config" # keys for this test only
for cpu in host m3; do
    logged ./icesoc run --built --build "$build" --bridge sync --cpu $cpu --size 96x64 --guard 20 \
        --show no --seed "${SEED:-1}" --out "$work/$cpu"
    prints 'the result equals the C++ reference, bit by bit'
done
# Replay uses the simulator with the recorded bridge; a simulator with another bridge refuses.
logged ./icesoc replay "$work/host" --built --build "$build" --out "$work/replay"
! "$build/testbench/sim/icesoc-sim" --replay "$work/host" --out "$work/refused" >"$work/log" 2>&1 ||
    { echo 'a simulator with the other bridge replays the flight' && exit 1; }
prints "this simulator has the bridge 'async', and the recorded flight has 'sync'"
logged ninja -C build/sync test_sim_soc test_sim_quiet
logged ctest --test-dir build/sync --output-on-failure --no-tests=error \
    -R '^test_sim_(soc|quiet)[.]'
