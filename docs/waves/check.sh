#!/bin/sh
# SPDX-License-Identifier: MIT
# check: every drawing is today's, and has its signals' names; wavesvg says what is wrong with a waveform.
set -eu
tool=$1 folder=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT TERM HUP
for wave in "$folder"/*.json; do
    "$tool" "$wave" "$work/out.svg"
    cmp -s "$work/out.svg" "${wave%.json}.svg" || {
        echo "${wave%.json}.svg is not drawn from $wave: ninja -C build/main docs_waves, and commit it" >&2
        exit 1
    }
    grep -o '"name": "[^"]*"' "$wave" | sed 's/.*: "//; s/"$//' | while read -r name; do
        grep -qF ">$name</text>" "$work/out.svg" || {
            echo "$wave: signal '$name' is not drawn" >&2
            exit 1
        }
    done
done
refused() { # text of the file, what must be said
    printf '%s' "$1" >"$work/bad.json"
    if "$tool" "$work/bad.json" "$work/bad.svg" 2>"$work/said"; then
        echo "accepted: $1" >&2
        exit 1
    fi
    grep -q "$2" "$work/said" || {
        echo "expected '$2' for $1, got: $(cat "$work/said")" >&2
        exit 1
    }
}
refused '{' 'parse error'
refused '{}' "no list 'signal'"
refused '{"signal": [{"name": "a", "wave": "01q"}]}' "signal 'a': 'q' is no state"
refused '{"signal": [{"name": "a", "wave": ".1"}]}' "begins with"
refused '{"signal": [{"name": "a", "wave": "1", "period": 2}]}' "signal 'a': 'period' is not drawn"
"$tool" /nonexistent "$work/x.svg" 2>"$work/said" && exit 1
grep -q 'cannot be read' "$work/said"
