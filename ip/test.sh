#!/bin/sh
# SPDX-License-Identifier: MIT
# test: build-folder core [jobs]   Builds and runs the tests of one core, wherever its folder is: its block test, and its VHDL
# under GHDL, where it has such a test.
set -eu
case ${1:-} in -h | --help) sed -n '3,4s/^# //p' "$0" && exit 0 ;; esac
build=${1:-} core=${2:-} jobs=${3:-$(nproc)}
fail() { echo "ip-test: $*" >&2 && exit 1; }
case $core in '' | *[!A-Za-z0-9_]*) fail "IP=name of a core, not '$core'" ;; esac
ninja -C "$build" --quiet build.ninja # folders that are new since CMake ran
grep -qx "$core" "$build/cores.known" || fail "there is no core '$core': $(tr '\n' ' ' <"$build/cores.known")"
programs=$(ninja -C "$build" -t targets all | sed -n "s/^\(test_ip_$core\|${core}_vectors\): phony\$/\1/p")
[ -n "$programs" ] || fail "$core has no test: ${core}_test.cpp is not in its folder"
# shellcheck disable=SC2086 # a list of words
ninja -C "$build" -j "$jobs" --quiet $programs
ctest --test-dir "$build" --output-on-failure --no-tests=error -R "^(test_ip_${core}[.]|vhdl[.]${core}\$)"
