#!/bin/sh
# SPDX-License-Identifier: MIT
#
# run: plants each seeded bug of tests/mutants/ and ip/*/mutants/ in a copy of the tree and expects the test it names to fail.
# Usage: tests/mutants/run.sh [--block NAME] [--jobs N] [--check]
#
# --check: only that each patch names its test and applies to today's tree, line by line; builds nothing.
# A patch says the bug in its first line, `Caught-by: <ctest name>` in a line of its own, and is then a
# diff for `patch -p1`. Exit status 1: a bug survived, a patch no longer applies, or a mutant does not build.
# Leaves build/mutants/results.tsv (patch, result, test, seconds) and summary.json (the score, by block).
set -eu
block='*' jobs=$(nproc) check=
while [ $# -gt 0 ]; do
    case $1 in
    --block) block=$2 && shift 2 ;;
    --jobs) jobs=$2 && shift 2 ;;
    --check) check=1 && shift ;;
    -h | --help) sed -n '4,11s/^# \{0,1\}//p' "$0" && exit 0 ;;
    *) echo "run.sh: '$1' is not an option; see --help" >&2 && exit 2 ;;
    esac
done
cd "$(dirname "$(readlink -f "$0")")/../.."
top=$PWD
list=$(ls tests/mutants/$block/*.patch ip/$block/mutants/*.patch 2>/dev/null || true)
[ -n "$list" ] || {
    echo "mutants: no tests/mutants/$block/*.patch, no ip/$block/mutants/*.patch" >&2
    exit 2
}
caught_by() { sed -n 's/^Caught-by: *//p' "$1" | head -1; }

if [ -n "$check" ]; then
    bad=0
    for patch in $list; do
        [ -n "$(caught_by "$patch")" ] || { echo "$patch: names no test (Caught-by:)" && bad=1; }
        patch --dry-run -s -f -F0 -p1 <"$patch" || { echo "$patch: does not apply; make it anew from today's source" && bad=1; }
    done
    exit $bad
fi
mkdir -p build/mutants
# Two runs would plant their bugs in the same copies. -o: what a test leaves running does not keep the lock.
if [ -z "${MUTANT_STEP:-}" ]; then
    flock -n build/mutants/lock true || echo "mutants: another run is at work in build/mutants; waiting for its end ..." >&2
    exec flock -o build/mutants/lock env MUTANT_STEP=all sh tests/mutants/run.sh --block "$block" --jobs "$jobs"
fi

name_of() { echo "$1" | sed 's,^tests/mutants/,,; s,^ip/\(.*\)/mutants/,\1/,; s/[.]patch$//'; } # bus/wrapper_event_lost

# a copy of the tree for each worker, with its own build folder
prepare() {
    copy=$top/build/mutants/$1
    mkdir -p "$copy"
    # what a run that was interrupted had planted
    find "$copy" -name '*.orig' | while read -r kept; do mv "$kept" "${kept%.orig}" && touch "${kept%.orig}"; done
    git ls-files -coz --exclude-standard | xargs -0 cp -pu --parents -t "$copy" 2>/dev/null || true
    [ -f "$copy/build/main/build.ninja" ] ||
        (cd "$copy" && CCACHE_BASEDIR=$copy CCACHE_NOHASHDIR=1 cmake -S . -B build/main -G Ninja >cmake.log 2>&1) || {
        cat "$copy/cmake.log"
        exit 1
    }
}

# builds what a test needs, runs it: 0 passes, 1 fails, 2 does not build
try() { # test log
    export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1
    case $1 in
    test_*) target=${1%%.*} ;;
    cdc.*) target=${1#cdc.} && target=${target%.*} ;;
    vhdl.*) target=${1#vhdl.}_vectors ;;
    slice.hardware.vhdl.*) target="slice2c ghdl" ;;
    slice.*) target=slice2c ;;
    interop.*) # the programs that its command names
        target=$(ctest --test-dir build/main --show-only=json-v1 -R "^$1\$" | sed -n "s,^ *\"$PWD/build/main/\([^\"]*\)\".*,\1,p") ;;
    *) target=regmaps ;;
    esac
    # shellcheck disable=SC2086 # a list of words
    nice ninja -C build/main -j 1 $target >"$2" 2>&1 || return 2
    regexp=$(echo "$1" | sed 's/[.]/\\./g')
    ctest --test-dir build/main -R "^$regexp(\\.|\$)" --no-tests=error --output-on-failure >>"$2" 2>&1 && return 0
    case $1 in # a proof must fail by its properties, not by a file that cannot be read
    formal.*) grep -q 'an assertion fails\|not proven\|not reached' "$2" || return 2 ;;
    esac
    return 1
}

one() { # patch, in the worker's copy
    patch=$1
    test=$(caught_by "$patch")
    name=$(name_of "$patch")
    start=$(date +%s)
    log=$top/build/mutants/$(echo "$name" | tr / -).log
    cd "$top/build/mutants/$SLOT"
    files=$(sed -n 's,^+++ b/\([^\t ]*\).*,\1,p' "$top/$patch")
    for file in $files; do cp "$file" "$file.orig"; done
    if [ -z "$test" ]; then
        result='names no test (Caught-by:)'
    elif ! patch -s -f -F0 -p1 <"$top/$patch" >"$log" 2>&1; then
        result='does not apply'
    else
        status=0
        try "$test" "$log" || status=$?
        case $status in
        0) result=SURVIVED ;;
        1) result=caught ;;
        *) result='does not build' ;;
        esac
    fi
    # newer than what was built from the mutant
    for file in $files; do mv "$file.orig" "$file" && touch "$file"; done
    seconds=$(($(date +%s) - start))
    printf '%s\t%s\t%s\t%s\n' "$name" "$result" "$test" "$seconds" >"$top/build/mutants/result.$(echo "$name" | tr / -)"
    printf '%-10s %-36s %s (%s s)\n' "$result" "$name" "$test" "$seconds"
}

if [ "$MUTANT_STEP" = one ]; then
    one "$MUTANT_PATCH"
    exit 0
fi

# The state that all blocks were measured from, for the regression's light.
if [ "$block" = '*' ] && [ -x build/main/tests/regress/regress ]; then
    build/main/tests/regress/regress --tree 'bus hdl ip slice sw testbench tests' >build/mutants/tree
fi
# Results of other blocks stay from an earlier run, unless the bug is gone.
if [ "$block" = '*' ]; then rm -f build/mutants/result.*; else rm -f "build/mutants/result.$block-"*; fi
for result in build/mutants/result.*; do
    [ -e "$result" ] || continue
    name=$(cut -f1 "$result")
    [ -e "tests/mutants/$name.patch" ] || [ -e "ip/${name%%/*}/mutants/${name#*/}.patch" ] || rm -f "$result"
done
workers=$jobs
worker=0
while [ "$worker" -lt "$workers" ]; do
    prepare "$worker"
    worker=$((worker + 1))
done

# The tests must pass without a bug, or "caught" says nothing.
cd "$top/build/mutants/0"
for patch in $list; do caught_by "$top/$patch"; done | grep . | sort -u >../tests
while read -r test; do
    try "$test" ../baseline.log || {
        cat ../baseline.log
        echo "mutants: $test fails without any mutant: mend that first" >&2
        exit 1
    }
done <../tests
cd "$top"

echo "$list" | MUTANT_STEP=one xargs -P "$workers" --process-slot-var=SLOT -I '{}' \
    env MUTANT_PATCH='{}' sh tests/mutants/run.sh
cat build/mutants/result.* >build/mutants/results.tsv
# The score of all blocks that were run, for reports; the exit status is that of this run.
awk -F '\t' '{ split($1, path, "/"); block = path[1]; all[block]++; total++ }
    $2 == "caught" { good[block]++; caught++ }
    $2 != "caught" { bad = bad (bad ? ", " : "") "\"" $1 "\"" }
    END { printf "{\"caught\": %d, \"total\": %d, \"score\": %.1f, \"not_caught\": [%s], \"blocks\": {", caught, total, 100 * caught / total, bad
          for (block in all) printf "%s\"%s\": {\"caught\": %d, \"total\": %d}", separator, block, good[block], all[block], separator = ", "
          print "}}" }' build/mutants/results.tsv >build/mutants/summary.json
now=0 caught=0
for patch in $list; do
    name=$(name_of "$patch")
    now=$((now + 1))
    [ "$(cut -f2 "build/mutants/result.$(echo "$name" | tr / -)")" != caught ] || caught=$((caught + 1))
done
echo "mutants: $caught of $now caught (build/mutants/results.tsv, summary.json)"
[ "$caught" -eq "$now" ]
