#!/bin/sh
# SPDX-License-Identifier: MIT
#
# replay: flies a recorded flight again. Usage: replay.sh build-folder folder-of-the-flight out-folder [from to]
#      With a span, in simulated seconds, its waveform is written, by a simulator that is built for it once,
#      and with CPU=m3 the program's task, interrupt and function above it.
set -eu
build=$1 flight=$2 out=$3 from=${4:-} to=${5:-}
[ -f "$flight/flight.jsonl" ] || { echo "replay: no flight was recorded in '$flight': make run OUT='$flight' does so" >&2 && exit 2; }
if [ -z "$from$to" ]; then
    exec "$build/testbench/sim/icesoc-sim" --replay "$flight" --out "$out"
fi
awk -v from="${from:-0}" -v to="${to:-1e9}" 'BEGIN { n = "^[0-9]*[.]?[0-9]*(e9)?$"; exit !(from ~ n && to ~ n && from + 0 < to + 0) }' || {
    echo "replay: FROM='$from' TO='$to' are no span in seconds, such as FROM=1.5 TO=1.6" >&2
    exit 2
}
hz=$(sed -n 's/^CLK_HZ:STRING=//p' "$build/CMakeCache.txt")
echo "replay: building the simulator that writes waveforms (build/trace) ..."
cmake -S . -B build/trace -G Ninja -DTRACE=ON -DCLK_HZ="$hz" >/dev/null
cmake/ninja.sh build/trace --quiet icesoc-sim
mkdir -p "$out"
build/trace/testbench/sim/icesoc-sim --replay "$flight" --out "$out" --wave "$out/wave.fst" --from "${from:-0}" ${to:+--to "$to"}
"$(dirname "$0")/../common/join_waves.sh" "$out/wave.fst"
echo "Waveform: gtkwave $out/wave.fst"
