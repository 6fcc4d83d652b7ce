#!/bin/sh
# SPDX-License-Identifier: MIT
#
# simulator: simulated clocks a second at the board's clock, the best of three runs in turn: the UAV alone, with quiet clocks
# passed at once and with each one evaluated; and the mission, flown again from its recording, on the host and on the Cortex-M3.
# Usage: simulator.sh source-folder build-folder output.json [--brief]
set -eu
source=$1 build=$2 json=$3 runs='1 2 3' seconds=5 flight=
[ "${4:-}" != --brief ] || runs=1 seconds=0.5 flight='--size 96x64 --guard 20'
sim=$build/testbench/sim/icesoc-sim image=/usr/share/xplanet/images/earth.jpg
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
speed() { # options: million clocks a second, and the share of them that were evaluated, in percent
    "$sim" --speed max --out "$work/out" "$@" | sed -n 's/.* \([0-9.]*\) million clocks.*; \([0-9.]*\) %.*/\1 \2/p'
}
better() { # file, figures: keeps the larger
    { cat "$work/$1" 2>/dev/null || true; echo "$2"; } | sort -g | tail -1 >"$work/new" && mv "$work/new" "$work/$1"
}
for cpu in host m3; do
    # shellcheck disable=SC2086 # a list of words
    "$source/testbench/sim/run.sh" "$build" --image $image --cpu $cpu --out "$work/mission_$cpu" $flight >"$work/log" 2>&1 || {
        cat "$work/log"
        exit 1
    }
done
for run in $runs; do
    better quiet "$(speed --image $image --duration $seconds)"
    better quiet_m3 "$(speed --image $image --duration $seconds --cpu m3)"
    better every "$(speed --image $image --duration 0.02 --every-clock)"
    better flight "$(speed --replay "$work/mission_host")"
    better flight_m3 "$(speed --replay "$work/mission_m3")"
    echo "run $run: at best $(cut -d' ' -f1 "$work/quiet") million clocks/s"
done
mkdir -p "$(dirname "$json")"
(cd "$work" && cat quiet quiet_m3 every flight flight_m3) | awk -v json="$json" '
    { rate[NR] = $1; active[NR] = $1 * $2 / 100 }
    function row(name, value, rest) {
        printf "%s{\"name\": \"%s\", \"value\": %.4g, \"unit\": \"million clocks/s\"%s, \"command\": \"make bench\"}",
            rows++ ? ",\n " : "[", name, value, rest > json
    }
    END {
        limit = ", \"limit\": 100, \"share\": %.3f"
        row("UAV at 100 MHz, quiet clocks passed at once", rate[1], sprintf(limit, rate[1] / 100))
        row("the same on the Cortex-M3", rate[2], "")
        row("each clock evaluated", rate[3], sprintf(", \"peer\": \"quiet ones passed at once\", \"ratio\": %.0f", rate[1] / rate[3]))
        row("the default mission, from its recording", rate[4], sprintf(limit, rate[4] / 100))
        row("of these evaluated", active[4], "")
        row("the mission on the Cortex-M3", rate[5], "")
        print "]" > json
        printf "the mission: %s million clocks/s, on the Cortex-M3 %s; 100 are wanted and are real time. Written: %s\n", rate[4], rate[5], json
    }'
