#!/bin/sh
# SPDX-License-Identifier: MIT
# check: golden|errors|parse slice2c file.ice work-folder sw-folder
# UPDATE_GOLDENS=1 rewrites what is expected.
set -eu
kind=$1 slice2c=$2 ice=$3 work=$4 sw=$5
rm -rf "$work"
mkdir -p "$work"
case $kind in
golden)
    expected=${ice%.ice}
    "$slice2c" "$ice" --output-dir "$work" 2>"$work/messages"
    for cc in gcc clang; do
        command -v $cc >/dev/null || continue
        for c in "$work"/*.c; do
            $cc -std=c90 -pedantic -Wall -Wextra -Wconversion -Wstrict-prototypes -Wmissing-prototypes \
                -Wdeclaration-after-statement -Werror -I"$sw/base" -I"$sw/icec" -I"$work" -c "$c" -o "$work/o"
        done
    done
    rm -f "$work/o"
    sed -i "s|^.*/||" "$work/messages"
    [ -z "${UPDATE_GOLDENS:-}" ] || { rm -rf "$expected"; cp -r "$work" "$expected"; }
    diff -ru "$expected" "$work"
    ;;
errors)
    cd "$(dirname "$ice")"
    status=0
    "$slice2c" "$(basename "$ice")" --output-dir "$work" 2>"$work/messages" || status=$?
    [ $status = 1 ] || { echo "exit status $status; expected 1" && exit 1; }
    [ "$(ls "$work")" = messages ] || { echo "files were written in spite of errors" && exit 1; }
    sed -i "s|^/[^:]*/||" "$work/messages"
    [ -z "${UPDATE_GOLDENS:-}" ] || cp "$work/messages" "${ice%.ice}.expected"
    diff -u "${ice%.ice}.expected" "$work/messages"
    ;;
parse) # what cannot be mapped gets an error, never a crash
    find "$ice" -name '*.ice' >"$work/list"
    while read -r file; do
        status=0
        "$slice2c" -I "$ice" "$file" --output-dir "$work/out" >"$work/messages" 2>&1 || status=$?
        [ $status -le 1 ] || { echo "$file: exit status $status" && exit 1; }
        [ $status = 0 ] || grep -q 'error:' "$work/messages" || { echo "$file: no error said" && exit 1; }
    done <"$work/list"
    wc -l <"$work/list"
    ;;
esac
