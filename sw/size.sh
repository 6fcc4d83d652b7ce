#!/bin/sh
# SPDX-License-Identifier: MIT
#
# size: text and read-only data of each firmware layer for a Cortex-M3 at -Os, beside the paper's Table II.
# Usage: size.sh source-folder generated-folder output.json

set -eu
source=$1 gen=$2 json=$3
command -v arm-none-eabi-gcc >/dev/null || {
    echo "size: arm-none-eabi-gcc is missing; run 'make setup'" >&2
    exit 1
}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
includes="-I$gen"
for d in base os os/host fsmc radio link icec icec/endpoints; do includes="$includes -I$source/sw/$d"; done
entries='' total=0
layer() { # name, paper's bytes, files
    name=$1 paper=$2
    shift 2
    for f in "$@"; do
        # shellcheck disable=SC2086
        arm-none-eabi-gcc -std=c90 -mcpu=cortex-m3 -mthumb -Os -ffunction-sections $includes -c "$f" \
            -o "$work/$name.$(basename "$f").o"
    done
    bytes=$(arm-none-eabi-size "$work/$name".*.o | awk 'NR > 1 {n += $1} END {print n}')
    printf '%-22s %7d %9s\n' "$name" "$bytes" "$paper"
    entries="$entries${entries:+, }{\"name\": \"$name\", \"value\": $bytes, \"unit\": \"bytes\", \"limit\": $paper, \"command\": \"make size\"}"
    total=$((total + bytes))
}
printf '%-22s %7s %9s\n' layer bytes "paper's"
layer fsmc 1116 "$source"/sw/fsmc/*.c
layer radio 1795 "$source"/sw/radio/*.c
layer link 1307 "$source"/sw/link/*.c
layer icec 2622 "$source"/sw/icec/*.c
printf '%-22s %7d %9d\n' all $total 6840
mkdir -p "$(dirname "$json")"
echo "[$entries]" >"$json"
echo "Written: $json"
