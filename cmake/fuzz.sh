#!/bin/sh
# SPDX-License-Identifier: MIT
#
# fuzz: runs a libFuzzer program on a number of inputs, from SEED (default 1).
# Usage: fuzz.sh program runs seeds|- option...
# seeds: a folder of inputs, or a file with one input per line in hex ("#" begins a comment).
# FUZZ=600 runs for 600 s, starting from the inputs that earlier runs stored (~/.cache/icesoc/fuzz).
# If an input fails, prints its bytes.
set -eu
program=$1 end=-runs=$2 seeds=$3
shift 3
[ "$seeds" != - ] || seeds=
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT TERM HUP
found=$work/found
if [ "${FUZZ:-}" ]; then
    end=-max_total_time=$FUZZ
    found=${XDG_CACHE_HOME:-$HOME/.cache}/icesoc/fuzz/$(basename "$(dirname "$program")" .fuzz)
fi
mkdir -p "$found"
if [ -f "$seeds" ]; then
    mkdir "$work/seeds"
    /usr/bin/python3 -c 'import sys
for number, line in enumerate(sys.stdin):
    line = line.partition("#")[0]
    open(f"{sys.argv[1]}/{number}", "wb").write(bytes.fromhex(line))' "$work/seeds" <"$seeds"
    seeds=$work/seeds
fi
# libFuzzer also tries values that the program compares, and these values can be addresses. If the
# system allows it, setarch therefore turns off address randomisation, so that every run has the
# same inputs.
alike=$(setarch -R true 2>/dev/null && echo "setarch -R" || :)
$alike "$program" -seed="${SEED:-1}" "$end" -timeout=60 -print_final_stats=1 \
    -artifact_prefix="$work/" "$@" "$found" $seeds >"$work/log" 2>&1 || {
    cat "$work/log" >&2
    for input in "$work"/crash-* "$work"/oom-* "$work"/timeout-*; do
        [ -f "$input" ] || continue
        echo "fuzz: SEED=${SEED:-1}; the input, for '$program FILE':" >&2
        od -An -tx1 -v "$input" >&2
    done
    exit 1
}
echo "${FUZZ:+note: }$(awk '/executed_units/ { n = $2 } /exec_per_sec/ { s = $2 }
    END { print n " inputs, " s " a second" }' "$work/log") from seed ${SEED:-1}, none did harm"
