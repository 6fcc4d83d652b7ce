#!/bin/sh
# SPDX-License-Identifier: MIT
#
# speed: clocks a second of the Verilated chip in the simulator, each one evaluated, and of the same chip under Icarus
# (chip_tb.v). Both are at rest, where Icarus has the least to do. In processor time: what else the machine does, does not count.
# Usage: speed.sh icesoc-sim source-folder generated-folder out.json [--brief]
# Of three runs the quickest counts; --brief: one run of fewer clocks.
# Exit status 1: Verilator's model is not `least` times as fast as Icarus: something costs that should not.
set -eu
sim=$1 source=$2 gen=$3 out=$4 runs=3 seconds=0.02 rest=20000 least=50
[ "${5:-}" != --brief ] || runs=1 seconds=0.0025 rest=1000
mkdir -p "$(dirname "$out")"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT TERM HUP
folders=$(for f in "$source"/bus "$source"/hdl/* "$source"/ip/* "$gen"; do [ ! -d "$f" ] || echo "-y $f -I $f"; done)
# shellcheck disable=SC2086 # a list of words
iverilog -g2005 -o "$work/chip.vvp" -s chip_tb $folders "$source/tests/bench/chip_tb.v" "$source/hdl/soc.v" 2>"$work/log" || { cat "$work/log" >&2 && exit 1; }

# Each prints the clocks that it ran.
Verilator() {
    "$sim" --image /usr/share/xplanet/images/earth.jpg --speed max --duration $seconds --every-clock --out "$work/flight" >"$work/log" 2>&1 &&
        od -An -td8 -j16 -N8 "$work/flight/status" # cycles in sw/ground/sim_status.h
}
Icarus() { vvp -n "$work/chip.vvp" "+clocks=$rest" | sed -n 's/^clocks //p'; } # newer ones tell of $finish, too
measure() { # name: "name clocks microseconds"
    for run in $(seq "$runs"); do
        times >"$work/before"
        "$1" >"$work/clocks" || { cat "$work/log" >&2 && exit 1; }
        times >"$work/after"
        # The second line: minutes and seconds of the children, in the program and in the system.
        awk -F '[ms ]+' -v what="$1 $(cat "$work/clocks")" 'FNR == 2 { spent = 60 * ($1 + $3) + $2 + $4 - spent }
            END { printf "%s %d\n", what, 1e6 * spent }' "$work/before" "$work/after"
    done | sort -n -k3 | head -n 1
}
{ measure Verilator && measure Icarus; } >"$work/figures"
awk -v least="$least" 'BEGIN { printf "{\"rows\": [" }
    { rate = $2 * 1e6 / $3; if (NR == 1) first = rate; times = first / rate
      printf "%s\n  {\"simulator\": \"%s\", \"clocks\": %d, \"microseconds\": %d, \"clocks_per_second\": %d, \"ratio\": %.5f}", (NR == 1 ? "" : ","), $1, $2, $3, rate, rate / first }
    END { printf "\n], \"entries\": [{\"name\": \"Verilator over Icarus, each clock of the chip at rest\", \"value\": %.0f, \"unit\": \"times, at least\", \"limit\": %d, \"share\": %.2f, \"command\": \"make bench\"}]}\n", times, least, times / least
          printf "Verilator is %.0f times as fast as Icarus; %d are wanted\n", times, least >"/dev/stderr"
          exit !(times >= least) }' "$work/figures" >"$out" || { echo "speed: too slow, see $out" >&2; exit 1; }
echo "$out"
