#!/bin/sh
# SPDX-License-Identifier: MIT
#
# fuzz: runs a libFuzzer program on a number of inputs, from SEED (default 1). Usage: fuzz.sh program runs seeds|- option...
# seeds: a folder of inputs, or a file with one a line in hex ("#" begins a comment). FUZZ=10: ten times as many inputs.
# An input that does harm is printed.
set -eu
program=$1 runs=$(($2 * ${FUZZ:-1})) seeds=$3
shift 3
[ "$seeds" != - ] || seeds=
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT TERM HUP
mkdir "$work/found"
if [ -f "$seeds" ]; then
    mkdir "$work/seeds"
    python3 -c 'import sys
for number, line in enumerate(sys.stdin):
    open(f"{sys.argv[1]}/{number}", "wb").write(bytes.fromhex(line.partition("#")[0]))' "$work/seeds" <"$seeds"
    seeds=$work/seeds
fi
# Addresses are among what is compared with, and so among what is tried: where the system lets one
# choose, they are the same each time, and so are the inputs.
alike=$(setarch -R true 2>/dev/null && echo "setarch -R" || :)
$alike "$program" -seed="${SEED:-1}" -runs="$runs" -artifact_prefix="$work/" "$@" "$work/found" $seeds >"$work/log" 2>&1 || {
    cat "$work/log" >&2
    for input in "$work"/crash-* "$work"/oom-* "$work"/timeout-*; do
        [ -f "$input" ] || continue
        echo "fuzz: SEED=${SEED:-1}; the input, for '$program FILE':" >&2
        od -An -tx1 -v "$input" >&2
    done
    exit 1
}
echo "$(basename "$(dirname "$program")"): $runs inputs from seed ${SEED:-1}, none did harm"
