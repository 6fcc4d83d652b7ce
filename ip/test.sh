#!/bin/sh
# SPDX-License-Identifier: MIT
# test: build-folder core [jobs]   Builds and runs the tests of one core: its block test, wherever it lies (ip/<core> or
# tests/ip/<core>), and its VHDL under GHDL, where it has such a test.
set -eu
case ${1:-} in -h | --help) sed -n '3,4s/^# //p' "$0" && exit 0 ;; esac
build=${1:-} core=${2:-} jobs=${3:-$(nproc)}
fail() { echo "ip-test: $*" >&2 && exit 1; }
case $core in '' | *[!A-Za-z0-9_]*) fail "IP=name of a core in ip/, not '$core'" ;; esac
[ -f "$(dirname "$0")/$core/CMakeLists.txt" ] || fail "there is no ip/$core/CMakeLists.txt"
programs=$(ninja -C "$build" -t targets all | sed -n "s/^\(test_ip_$core\|test_$core\|${core}_vectors\): phony\$/\1/p")
[ -n "$programs" ] || fail "$core has no test: neither ip/$core/${core}_test.cpp nor tests/ip/$core"
# shellcheck disable=SC2086 # a list of words
ninja -C "$build" -j "$jobs" --quiet $programs
ctest --test-dir "$build" --output-on-failure --no-tests=error -R "^(test_ip_${core}[.]|test_${core}[.]|vhdl[.]${core}\$)"
