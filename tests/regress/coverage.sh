#!/bin/sh
# SPDX-License-Identifier: MIT
#
# coverage: builds models, C and C++ that count what ran (build/coverage), runs all tests but proofs, lint and those of tools,
# and merges Verilator's, GHDL's and gcov's counts. Usage: coverage.sh main-build jobs
# Leaves build/coverage/html/index.html, summary.json, history (a line a run). Exit status 1: a file is below its gate.
set -eu
build=$1 jobs=$2
top=$(cd "$(dirname "$(readlink -f "$0")")/../.." && pwd)
cd "$top"
work=build/coverage
cmake/configure.sh $work -DCOVERAGE=ON >/dev/null
tree=$("$build/tests/regress/regress" --tree "bus hdl ip slice sw testbench tests")
commit=$(git describe --always --dirty=+ --abbrev=10 2>/dev/null || echo unknown)
echo "coverage: building with counters"
ninja -C $work -j "$jobs"
rm -rf $work/points $work/html
mkdir -p $work/points
find $work -name '*.gcda' -delete
echo "coverage: running the tests"
# Tests that fail still count: the regression reports them. Fuzzers have their own counts; e2e.cores builds its own chip.
COVERAGE_DIR=$PWD/$work/points ctest --test-dir $work -j "$jobs" -L 'rtl|firmware|vhdl|models|slice|interop|e2e' -E 'NOT_BUILT|^fuzz|^e2e.cores' >$work/ctest.log 2>&1 ||
    echo "coverage: some tests failed, see $work/ctest.log" >&2
echo "coverage: merging"
verilator_coverage --write $work/rtl.dat $work/points/*.dat >/dev/null
verilator_coverage --write-info $work/rtl.info $work/points/*.dat >/dev/null
# A step's patterns may match nothing in a build of few rooms; that is no error.
own() { # in out pattern...
    in=$1 out=$2
    shift 2
    lcov --quiet --extract "$in" "$@" --output-file "$out" 2>>$work/lcov.log && [ -s "$out" ] || rm -f "$out"
}
: >$work/lcov.log
lcov --quiet --capture --directory $work --output-file $work/all.info --ignore-errors gcov,source 2>>$work/lcov.log || {
    tail -5 $work/lcov.log >&2
    exit 2
}
own $work/all.info $work/host.info "$PWD/sw/*" "$PWD/slice/*" "$PWD/testbench/*" "$PWD/bus/*" "$PWD/ip/*"
own $work/rtl.info $work/rtl_own.info "$PWD/hdl/*" "$PWD/bus/*" "$PWD/ip/*"
rm -f $work/vhdl.info
ls $work/points/*.json >/dev/null 2>&1 && "$build/ghdl/ghdl" coverage --format=lcov $work/points/*.json >$work/vhdl.info
set --
for info in host rtl_own vhdl; do
    [ ! -s $work/$info.info ] || set -- "$@" --add-tracefile $work/$info.info
done
lcov --quiet "$@" --output-file $work/merged.info
genhtml --quiet --title "IceSoC" --output-directory $work/html $work/merged.info
set --
for info in host vhdl; do
    [ ! -s $work/$info.info ] || set -- "$@" --info $work/$info.info
done
"$build/tests/regress/coverage" --gates tests/regress/coverage_gates.json --verilator $work/rtl.dat "$@" --out $work/summary.json && status=0 || status=$?
echo "$tree" >$work/tree
sed -n 's/^ "total": \([0-9]*\.*[0-9]\{0,1\}\).*/'"$commit"' \1 % of lines/p' $work/summary.json >>$work/history # of each commit, for make synth BASE=
exit $status
