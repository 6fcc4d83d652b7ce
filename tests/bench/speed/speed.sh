#!/bin/sh
# SPDX-License-Identifier: MIT
#
# speed: clocks a second of Verilator, Icarus and GHDL on the same frames of the vision core, in one run.
# Usage: speed.sh verilated-program ghdl generated-folder vision.v work-folder "vhdl-files..." out.json
# Of three runs the quickest counts. A `ghdl` of -: one run of fewer frames, without GHDL.
# Exit status 1: Verilator's model is not `least` times as fast as Icarus: something costs that should not.
set -eu
runs=3 frames=2 verilated=200 least=100
program=$1 ghdl=$2 gen=$3 core=$4 work=$5 vhdl=$6 out=$7
[ "$ghdl" != - ] || runs=1 frames=1 verilated=100
here=$(dirname "$(readlink -f "$0")")
mkdir -p "$work" "$(dirname "$out")"
iverilog -g2005 -o "$work/speed.vvp" -I"$gen" -s speed_tb "$here/speed_tb.v" "$core"
# shellcheck disable=SC2086 # a list of files
[ "$ghdl" = - ] || (cd "$work" && "$ghdl" -a --std=08 $vhdl "$here/speed_tb.vhd" && "$ghdl" -e --std=08 speed_tb)

# name command...: "name clocks microseconds"; of a processor: what else the machine does, does not count.
measure() {
    name=$1
    shift
    for run in $(seq "$runs"); do
        times >"$work/before"
        clocks=$("$@" 2>&1 | sed -n 's/.*clocks \([0-9]*\).*/\1/p')
        times >"$work/after"
        [ -n "$clocks" ] || {
            echo "speed: $name gave no result" >&2
            exit 1
        }
        # The second line: minutes and seconds of the children, in the program and in the system.
        awk -F '[ms ]+' -v what="$name $clocks" 'FNR == 2 { spent = 60 * ($1 + $3) + $2 + $4 - spent }
            END { printf "%s %d\n", what, 1e6 * spent }' "$work/before" "$work/after"
    done | sort -n -k3 | head -n 1
}
{
    measure Verilator "$program" $verilated
    measure Icarus vvp -n "$work/speed.vvp" +frames="$frames"
    [ "$ghdl" = - ] || (cd "$work" && measure GHDL "$ghdl" -r --std=08 speed_tb -gframes="$frames")
} >"$work/figures"
awk -v least="$least" 'BEGIN { printf "{\"block\": \"vision, 256 x 64\", \"rows\": [" }
    { rate = $2 * 1e6 / $3; if (NR == 1) first = rate; if (NR == 2) times = first / rate
      printf "%s\n  {\"simulator\": \"%s\", \"clocks\": %d, \"microseconds\": %d, \"clocks_per_second\": %d, \"ratio\": %.5f}", (NR == 1 ? "" : ","), $1, $2, $3, rate, rate / first
      printf "%-10s %10.0f clocks/s  %8.5f of the first\n", $1, rate, rate / first >"/dev/stderr" }
    END { printf "\n], \"entries\": [{\"name\": \"Verilator over Icarus, vision core\", \"value\": %.0f, \"unit\": \"times, at least\", \"limit\": %d, \"share\": %.2f, \"command\": \"make bench\"}]}\n", times, least, times / least
          printf "Verilator is %.0f times as fast as Icarus; %d are wanted\n", times, least >"/dev/stderr"
          exit times < least }' "$work/figures" >"$out" || { echo "speed: too slow, see $out" >&2; exit 1; }
echo "$out"
