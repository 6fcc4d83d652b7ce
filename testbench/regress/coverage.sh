#!/bin/sh
# SPDX-License-Identifier: MIT
#
# coverage: builds models, C and C++ that count what ran (build/coverage), runs the RTL and firmware tests,
# and merges Verilator's and gcov's counts. Usage: coverage.sh main-build jobs
# Leaves build/coverage/html/index.html, summary.json. Exit status 1: a file is below its gate.
set -eu
build=$1 jobs=$2
top=$(dirname "$(readlink -f "$0")")/../..
cd "$top"
work=build/coverage
[ -f $work/build.ninja ] || cmake -S . -B $work -G Ninja -DCOVERAGE=ON >/dev/null
ninja -C $work -j "$jobs" test_programs
rm -rf $work/points
mkdir -p $work/points
find $work -name '*.gcda' -delete
# A failing test is the regression's matter: what ran, ran.
COVERAGE_DIR=$PWD/$work/points ctest --test-dir $work -j "$jobs" -L 'rtl|firmware' -E NOT_BUILT >$work/ctest.log 2>&1 ||
    echo "coverage: some tests failed, see $work/ctest.log" >&2
verilator_coverage --write $work/rtl.dat $work/points/*.dat >/dev/null
verilator_coverage --write-info $work/rtl.info $work/points/*.dat >/dev/null
lcov --quiet --capture --directory $work --output-file $work/all.info --ignore-errors gcov,source 2>$work/lcov.log || {
    tail -5 $work/lcov.log >&2
    exit 2
}
lcov --quiet --extract $work/all.info "$PWD/sw/*" "$PWD/slice/*" "$PWD/testbench/*" --output-file $work/host.info
lcov --quiet --extract $work/rtl.info "$PWD/hdl/*" "$PWD/bus/*" "$PWD/ip/*" --output-file $work/rtl_own.info || cp $work/rtl.info $work/rtl_own.info
lcov --quiet --add-tracefile $work/host.info --add-tracefile $work/rtl_own.info --output-file $work/merged.info
genhtml --quiet --title "IceSoC" --output-directory $work/html $work/merged.info
"$build/testbench/regress/coverage" --gates testbench/regress/coverage_gates.json --verilator $work/rtl.dat \
    --info $work/host.info --out $work/summary.json
