#!/bin/sh
# SPDX-License-Identifier: MIT
# viewed: simulator work-folder
# Checks that a flight follows real time while a browser shows its page. How much faster a flight
# without a page runs depends on the machine, so it is not checked.
set -eu
rm -rf "$2"
mkdir -p "$2"
cd "$2"
{ printf 'P5 48 32 255\n' && head -c 1536 /dev/zero; } >image.pgm
touch viewed # tools/icesoc/web/live.py writes this file
begin=$(date +%s%N)
"$1" --image image.pgm --size 48x32 --open --speed viewed --guard 20 --duration 4 --out .
passed=$((($(date +%s%N) - begin) / 1000000))
[ $passed -ge 3900 ] || { echo "4 s of a viewed flight took $passed ms" && exit 1; }
