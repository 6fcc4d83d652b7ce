#!/bin/sh
# SPDX-License-Identifier: MIT
# run_test: run.sh in a tree of one program: each result that a seeded bug can have, an interrupted run, two at once.
# Usage: run_test.sh run.sh work-folder
set -eu
run=$1 work=$2
rm -rf "$work"
mkdir -p "$work/tests/mutants/tiny"
cp "$run" "$work/tests/mutants/run.sh"
cd "$work"
fail() {
    cat run.log >&2
    echo "$*" >&2
    exit 1
}
cat >CMakeLists.txt <<'END'
cmake_minimum_required(VERSION 3.25)
project(tiny C)
enable_testing()
add_executable(test_tiny tiny.c)
add_test(NAME test_tiny COMMAND test_tiny)
END
cat >tiny.c <<'END'
/* doubles */
static int twice(int n) {
    return 2 * n;
}
int main(void) {
    return twice(3) != 6;
}
END
echo build >.gitignore
git init -q .
git add .
bug() { # name, test, sed command
    sed "$3" tiny.c >tiny.new
    { printf 'A bug.\nCaught-by: %s\n\n' "$2" && diff -u --label a/tiny.c --label b/tiny.c tiny.c tiny.new; } >"tests/mutants/tiny/$1.patch" || true
    rm tiny.new
}
bug wrong test_tiny 's/2 \*/3 */'
sh tests/mutants/run.sh --jobs 1 >run.log 2>&1 || fail "a bug that its test catches is no error"
grep -q '^caught *tiny/wrong ' run.log || fail "the bug was not caught"
grep -q '"caught": 1, "total": 1, "score": 100.0' build/mutants/summary.json || fail "no summary"

# A bug that an interrupted run had planted is taken out, or the tests would fail without a bug.
cp build/mutants/0/tiny.c build/mutants/0/tiny.c.orig
sed -i 's/2 \*/3 */' build/mutants/0/tiny.c
bug comment test_tiny 's/doubles/halves/'
bug nonsense test_tiny 's/return 2/retrun 2/'
bug untested '' 's/2 \*/4 */'
bug stale test_tiny 's/2 \*/5 */'
sed -i 's/2 \*/6 */' tests/mutants/tiny/stale.patch
status=0
sh tests/mutants/run.sh --jobs 2 >run.log 2>&1 || status=$?
[ $status -eq 1 ] || fail "exit status $status of a run in which bugs survive"
for line in 'caught *tiny/wrong ' 'SURVIVED *tiny/comment ' 'does not build *tiny/nonsense ' 'does not apply *tiny/stale ' 'names no test' '^mutants: 1 of 5 caught'; do
    grep -q "$line" run.log || fail "not said: $line"
done
for copy in 0 1; do cmp tiny.c build/mutants/$copy/tiny.c || fail "a bug was left in copy $copy"; done
! sh tests/mutants/run.sh --check >run.log 2>&1 || fail "--check does not see the stale patch"
grep -q 'tiny/stale.patch: does not apply' run.log || fail "--check does not name the stale patch"
rm tests/mutants/tiny/[!w]*

# A test that fails by itself catches nothing.
sed -i 's/!= 6/!= 7/' tiny.c
! sh tests/mutants/run.sh --jobs 1 >run.log 2>&1 || fail "a test that fails by itself is no error"
grep -q 'test_tiny fails without any mutant' run.log || fail "the failing test is not named"
git checkout -q tiny.c
touch tiny.c

# Two at once: the second waits.
mkfifo hold
flock build/mutants/lock sh -c 'echo held >held; read -r _ <hold' &
until [ -e held ]; do sleep 0.1; done
sh tests/mutants/run.sh --jobs 1 >run.log 2>&1 &
until grep -q 'another run is at work' run.log; do sleep 0.1; done
! grep -q caught run.log || fail "the second run did not wait"
echo >hold
wait $! || fail "the second run failed"
grep -q '^mutants: 1 of 1 caught' run.log || fail "the second run did not do its work"
