#!/bin/sh
# SPDX-License-Identifier: MIT
# slice: slice2c beside slice2cpp on the five largest files of Debian's zeroc-ice-slice: user and system time, the files
# alternating; the best of the rounds counts, since everything else on the machine only makes them slower.
# Usage: slice.sh slice2c output.json [--brief]
set -eu
slice2c=$1 json=$2 rounds=15 count=5
[ "${3:-}" != --brief ] || rounds=1 count=1
slices=/usr/share/ice/slice
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT TERM HUP
command -v slice2cpp >/dev/null || {
    echo "slice: slice2cpp is missing; run 'make setup'" >&2
    exit 1
}
files=$(find $slices -name '*.ice' -printf '%s %p\n' | sort -rn | head -n $count | cut -d ' ' -f 2)
mkdir "$work/c" "$work/cpp"

# Milliseconds of processor time that ten runs take, over ten.
once() { # output, command...
    to=$1
    shift
    /usr/bin/env bash -c 'TIMEFORMAT="%U %S"; time for i in 1 2 3 4 5 6 7 8 9 10; do "$@" || exit 1; done' - "$@" 2>"$to" >/dev/null || {
        cat "$to" >&2
        exit 1
    }
    tail -n 1 "$to" | awk '{printf "%.2f", ($1 + $2) * 100}'
}

smaller() { awk -v a="$1" -v b="$2" 'BEGIN { print (a < b ? a : b) }'; }

entries=''
printf '%-28s %12s %12s %8s\n' file slice2cpp slice2c ratio
sumTheirs=0 sumOurs=0
for file in $files; do
    theirs=1e9 ours=1e9
    round=0
    while [ $round -lt "$rounds" ]; do
        theirs=$(smaller "$theirs" "$(once "$work/log" slice2cpp -I $slices "$file" --output-dir "$work/cpp")")
        ours=$(smaller "$ours" "$(once "$work/log" "$slice2c" -I $slices "$file" --output-dir "$work/c")")
        round=$((round + 1))
        [ ! -t 2 ] || printf '\r%s: %d of %d ' "${file#"$slices"/}" $round "$rounds" >&2
    done
    [ ! -t 2 ] || printf '\r%60s\r' '' >&2
    ratio=$(awk -v a="$theirs" -v b="$ours" 'BEGIN { printf "%.2f", a / b }')
    printf '%-28s %9.2f ms %9.2f ms %8s\n' "${file#"$slices"/}" "$theirs" "$ours" "$ratio"
    entries="$entries{\"name\": \"slice2c.${file#"$slices"/}\", \"value\": $ours, \"unit\": \"ms\", \"peer\": \"slice2cpp: $theirs ms\", \"ratio\": $ratio, \"command\": \"make bench\"},
 "
    sumTheirs=$(awk -v a="$sumTheirs" -v b="$theirs" 'BEGIN { print a + b }')
    sumOurs=$(awk -v a="$sumOurs" -v b="$ours" 'BEGIN { print a + b }')
done
ratio=$(awk -v a="$sumTheirs" -v b="$sumOurs" 'BEGIN { printf "%.2f", a / b }')
printf '%-28s %9.2f ms %9.2f ms %8s (wanted: 2)\n' all "$sumTheirs" "$sumOurs" "$ratio"
mkdir -p "$(dirname "$json")"
printf '[%s{"name": "slice2c.all", "value": %s, "unit": "ms", "peer": "slice2cpp: %s ms", "ratio": %s, "command": "make bench"}]\n' \
    "$entries" "$sumOurs" "$sumTheirs" "$ratio" >"$json"
echo "Written: $json"
