#!/bin/sh
# SPDX-License-Identifier: MIT
# hang: simulator work-folder
# Checks a flight with firmware that hangs: the simulator prints the time and the function after 10
# s of CPU time, and then ends at once when it is interrupted.
set -eu
mkdir -p "$2"
cd "$2"
{ printf 'P5 48 32 255\n' && head -c 1536 /dev/zero; } >image.pgm
"$1" --image image.pgm --size 48x32 --open --speed max --guard 20 --out . >log 2>&1 &
trap 'kill -9 $! 2>/dev/null || true' EXIT
message='^icesoc-sim: simulated time has stopped at .* the firmware is in computesWithoutEnd,'
while ! grep "$message" log; do
    kill -0 $! || { cat log && exit 1; }
    sleep 0.2
done
kill $!
status=0
wait $! || status=$?
[ $status -eq 143 ] || { echo "ended with $status, expected 143 (TERM)" && exit 1; }
