#!/bin/sh
# SPDX-License-Identifier: MIT
#
# simulator: simulated clocks a second, the best of three runs in turn: the UAV alone, at 100 and at 2 MHz, with quiet clocks
# passed at once and with each one evaluated; and the mission, flown again from its recording, on the host and on the Cortex-M3.
# Usage: simulator.sh source-folder build-folder output.json [--brief]   (--brief: without 2 MHz, whose simulator it would build)
set -eu
source=$1 build=$2 json=$3 runs='1 2 3' seconds=5 flight='' slow=$1/build/slow
[ "${4:-}" != --brief ] || runs=1 seconds=0.5 flight='--size 96x64 --guard 20' slow=
image=/usr/share/xplanet/images/earth.jpg
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT TERM HUP
logged() { "$@" >"$work/log" 2>&1 || { tail -40 "$work/log" && exit 1; }; }
speed() { # build folder, options: million clocks a second, and the share of them that were evaluated, in percent
    sim=$1/testbench/sim/icesoc-sim
    shift
    "$sim" --speed max --out "$work/out" "$@" | sed -n 's/.* \([0-9.]*\) million clocks.*; \([0-9.]*\) %.*/\1 \2/p'
}
better() { # file, figures: keeps the larger
    { cat "$work/$1" 2>/dev/null || true; echo "$2"; } | sort -g | tail -1 >"$work/new" && mv "$work/new" "$work/$1"
}
for cpu in host m3; do
    # shellcheck disable=SC2086 # a list of words
    logged "$source/icesoc" run --built --build "$build" --image $image --cpu $cpu --out "$work/mission_$cpu" $flight
done
if [ -n "$slow" ]; then
    logged cmake -S "$source" -B "$slow" -G Ninja -DCLK_HZ=2000000 '-DROOMS=bus;slice;sw;hdl;ip;testbench'
    logged ninja -C "$slow" --quiet icesoc-sim
fi
for run in $runs; do
    better 1_quiet "$(speed "$build" --image $image --duration $seconds)"
    better 2_quiet_m3 "$(speed "$build" --image $image --duration $seconds --cpu m3)"
    better 3_every "$(speed "$build" --image $image --duration 0.02 --every-clock)"
    better 4_flight "$(speed "$build" --replay "$work/mission_host")"
    better 5_flight_m3 "$(speed "$build" --replay "$work/mission_m3")"
    if [ -n "$slow" ]; then
        better 6_slow "$(speed "$slow" --image $image --duration $seconds)"
        better 7_slow_every "$(speed "$slow" --image $image --duration 1 --every-clock)"
    fi
    echo "run $run: at best $(cut -d' ' -f1 "$work/1_quiet") million clocks/s"
done
mkdir -p "$(dirname "$json")"
cat "$work"/[1-7]_* | awk -v json="$json" '
    { rate[NR] = $1; active[NR] = $1 * $2 / 100 }
    function row(name, value, rest) {
        printf "%s{\"name\": \"%s\", \"value\": %.4g, \"unit\": \"million clocks/s\"%s, \"command\": \"make bench\"}",
            rows++ ? ",\n " : "[", name, value, rest > json
    }
    function peer(name, ratio) { return sprintf(", \"peer\": \"%s\", \"ratio\": %.0f", name, ratio) }
    function real(value) { return sprintf(", \"limit\": 100, \"share\": %.3f", value / 100) }
    END {
        row("UAV at 100 MHz, quiet clocks passed at once", rate[1], real(rate[1]))
        row("the same on the Cortex-M3", rate[2], real(rate[2]))
        row("each clock evaluated", rate[3], peer("quiet ones passed at once", rate[1] / rate[3]))
        row("the default mission, from its recording", rate[4], real(rate[4]))
        row("of these evaluated", active[4], "")
        row("the mission on the Cortex-M3", rate[5], real(rate[5]))
        row("of these evaluated, Cortex-M3", active[5], "")
        if (NR > 5) {
            row("UAV at 2 MHz, quiet clocks passed at once", rate[6], sprintf(", \"limit\": 2, \"share\": %.3f", rate[6] / 2))
            row("each clock evaluated at 2 MHz", rate[7], peer("quiet ones passed at once", rate[6] / rate[7]))
        }
        print "]" > json
        printf "the mission: %s million clocks/s, on the Cortex-M3 %s; 100 are wanted and are real time. Written: %s\n", rate[4], rate[5], json
    }'
