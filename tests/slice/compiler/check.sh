#!/bin/sh
# SPDX-License-Identifier: MIT
# check: golden|errors|compile slice2c file.ice-or-folder work-folder sw-folder
# golden: the C has no warnings, `messages` are those of the compiler (no file: none), and the header has the lines of `lines`, in that order.
# errors: the messages are those of the lines behind `//> `. UPDATE_GOLDENS=1 rewrites the messages that are expected.
set -eu
kind=$1 slice2c=$2 ice=$3 work=$4 sw=$5
rm -rf "$work"
mkdir -p "$work"
flags='-std=c90 -pedantic -Wall -Wextra -Wconversion -Wstrict-prototypes -Wmissing-prototypes -Wdeclaration-after-statement -Werror'
case $kind in
golden)
    expected=${ice%.ice}
    "$slice2c" "$ice" --output-dir "$work" 2>"$work/messages" || { cat "$work/messages" && exit 1; }
    for cc in gcc clang; do
        $cc $flags -I"$sw/base" -I"$sw/icec" -I"$work" -fsyntax-only "$work"/*.c
    done
    g++ -Wall -Wextra -Werror -I"$sw/base" -I"$sw/icec" -fsyntax-only -include "$work"/*.h -x c++ /dev/null
    sed -i "s|^.*/||" "$work/messages"
    [ -z "${UPDATE_GOLDENS:-}" ] || cp "$work/messages" "$expected/messages"
    diff -uN "$expected/messages" "$work/messages"
    [ ! -e "$expected/lines" ] || awk 'BEGIN { i = 0 } NR == FNR { wanted[n++] = $0; next } $0 == wanted[i] { i++ }
        END { if (i < n) { print ARGV[1] ":" i + 1 ": not in the header, or too early: " wanted[i]; exit 1 } }' "$expected/lines" "$work"/*.h
    ;;
errors)
    cd "$(dirname "$ice")"
    status=0
    "$slice2c" "$(basename "$ice")" --output-dir "$work" 2>"$work/messages" || status=$?
    [ $status = 1 ] || { echo "exit status $status; expected 1" && exit 1; }
    [ "$(ls "$work")" = messages ] || { echo "files were written in spite of errors" && exit 1; }
    sed -i "s|^/[^:]*/||" "$work/messages"
    [ -z "${UPDATE_GOLDENS:-}" ] || { sed -i '/^\/\/> /d' "$ice" && sed 's/^/\/\/> /' "$work/messages" >>"$ice"; }
    sed -n 's/^\/\/> //p' "$ice" | diff -u - "$work/messages"
    ;;
compile) # every file of a folder compiles without a message, and its C without a warning
    find "$ice" -name '*.ice' | sort >"$work/list"
    while read -r file; do
        folder=${file#"$ice"/}
        "$slice2c" -I "$ice" "$file" --output-dir "$work/out/$(dirname "$folder")" 2>"$work/messages" || {
            echo "$file:" && cat "$work/messages" && exit 1
        }
        ! grep ': warning: ' "$work/messages" | grep -v deprecated || exit 1
    done <"$work/list"
    # The sources of a file in one go: a compiler's start takes longer than its work.
    find "$work/out" -name '*_types.c' | while read -r types; do
        for part in types client async server; do echo "#include \"${types%_types.c}_$part.c\""; done >"${types%_types.c}_whole.c"
    done
    for cc in gcc clang 'arm-none-eabi-gcc -mcpu=cortex-m3 -mthumb'; do
        find "$work/out" -name '*_whole.c' -exec $cc $flags -I"$sw/base" -I"$sw/icec" -I"$work/out" -fsyntax-only {} +
    done
    wc -l <"$work/list"
    ;;
esac
