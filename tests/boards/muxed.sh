#!/bin/sh
# SPDX-License-Identifier: MIT
# muxed: source-folder build-folder work-folder [program...]
# Flies the kit with multiplexed address and data: runs its self-test on the simulated kit, with and
# without a fault, flies the mission, and runs the given test programs. The commands build the
# simulator and the firmware of this kit in a separate build folder.
set -eu
source=$1 build=$2 work=$3 kit=nucleo-qmtech-muxed
shift 3
mkdir -p "$work"
cd "$source"
logged() { "$@" >"$work/log" 2>&1 || { tail -60 "$work/log" && exit 1; }; }
prints() { grep -Fq "$1" "$work/log" || { cat "$work/log" && echo "not printed: $1" && exit 1; }; }
logged ./icesoc board bringup $kit --simulated --built --build "$build" --out "$work/bringup"
prints 'least ADDHLD for NADV: 1, driver 2'
prints 'passed: answered after ms'
! ./icesoc board bringup $kit --simulated --fault NADV:open --built --build "$build" \
    --out "$work/bringup" >"$work/log" 2>&1 || { echo 'NADV:open is not found' && exit 1; }
prints 'FAILED: NADV open'
prints 'NADV: microcontroller PB7 (CN11 pin 21), FPGA J14 (U7 pin 29)'
logged ./icesoc run --board $kit --size 96x64 --guard 20 --show no --seed "${SEED:-1}" --built \
    --build "$build" --out "$work/run"
# A simulator that was built for the other kit refuses the recording; replay uses the right one.
logged ./icesoc replay "$work/run" --built --build "$build" --out "$work/replay"
[ $# = 0 ] || logged ninja -C "build/board_$kit" "$@"
for name in "$@"; do
    logged "build/board_$kit/tests/testbench/$name"
done
