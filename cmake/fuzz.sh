#!/bin/sh
# SPDX-License-Identifier: MIT
# fuzz: program runs arguments...   Runs a libFuzzer program on so many inputs, from SEED (default 1).
set -eu
program=$1 runs=$2
shift 2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$program" -seed="${SEED:-1}" -runs="$runs" -artifact_prefix="$work/" "$@" >"$work/log" 2>&1 || {
    cat "$work/log" >&2
    for input in "$work"/crash-* "$work"/oom-* "$work"/timeout-*; do
        [ -f "$input" ] || continue
        echo "fuzz: SEED=${SEED:-1}; the input, for '$program FILE':" >&2
        od -An -tx1 -v "$input" >&2
    done
    exit 1
}
echo "$(basename "$program"): $runs inputs from seed ${SEED:-1}, none did harm"
