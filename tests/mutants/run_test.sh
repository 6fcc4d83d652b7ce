#!/bin/sh
# SPDX-License-Identifier: MIT
# run_test: run.py in a tree of one program: each result that a seeded bug can have, an interrupted run.
# Usage: run_test.sh source-folder work-folder
set -eu
source=$1 work=$2
rm -rf "$work"
mkdir -p "$work/tests/mutants" "$work/testbench/page"
cp "$source/tests/mutants/run.py" "$work/tests/mutants" && cp "$source/testbench/page/tool.py" "$work/testbench/page"
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
bug() { # name, test, the line that goes, the line that comes
    printf '%s: A bug.\n%s\ntiny.c\n-%s\n+%s\n\n' "$@" >>tests/mutants/tiny.bugs
}
bug wrong test_tiny '    return 2 * n;' '    return 3 * n;'
tests/mutants/run.py --jobs 1 >run.log 2>&1 || fail "a bug that its test catches is no error"
grep -q '^caught *tiny/wrong ' run.log || fail "the bug was not caught"
grep -q '^tiny/wrong	caught	test_tiny	' build/mutants/results.tsv || fail "no results"

# The bug of an interrupted run is removed; the tests would fail without a bug.
cp build/mutants/0/tiny.c build/mutants/0/tiny.c.orig
sed -i 's/2 \*/3 */' build/mutants/0/tiny.c
touch build/mutants/0/left_the_tree.c
bug comment test_tiny '/* doubles */' '/* halves */'
bug nonsense test_tiny '    return 2 * n;' '    retrun 2 * n;'
bug stale test_tiny '    return 6 * n;' '    return 5 * n;'
bug nothing test_tiny '    return 2 * n;' '    return 2 * n;'
status=0
tests/mutants/run.py --jobs 2 >run.log 2>&1 || status=$?
[ $status -eq 1 ] || fail "exit status $status of a run in which bugs survive"
for line in 'caught *tiny/wrong ' 'SURVIVED *tiny/comment ' 'does not build *tiny/nonsense ' 'does not apply *tiny/stale ' 'does not apply *tiny/nothing ' '^mutants: 1 of 5 caught'; do
    grep -q "$line" run.log || fail "not said: $line"
done
[ ! -e build/mutants/0/left_the_tree.c ] || fail "a copy keeps a file that has left the tree"
for copy in 0 1; do cmp tiny.c build/mutants/$copy/tiny.c || fail "a bug was left in copy $copy"; done
! tests/mutants/run.py --check >run.log 2>&1 || fail "--check does not see the stale patch"
grep -q 'tiny/stale: does not apply' run.log || fail "--check does not name the stale patch"
"$source/tests/regress/test/make_in.sh" "$source" "$work" build mutants BLOCK=tiny/wrong JOBS=1 >run.log 2>&1 || fail "one bug by its name"
grep -q '^mutants: 1 of 1 caught' run.log || fail "one bug by its name is not one"
rm tests/mutants/tiny.bugs
bug wrong test_tiny '    return 2 * n;' '    return 3 * n;'
printf 'no test\n-and no file\n' >tests/mutants/wrong.bugs
! tests/mutants/run.py --check >run.log 2>&1 && grep -q 'wrong.bugs: not a bug as' run.log || fail "a malformed bug is not told"
rm tests/mutants/wrong.bugs

# A test that fails by itself catches nothing.
sed -i 's/!= 6/!= 7/' tiny.c
! tests/mutants/run.py --jobs 1 >run.log 2>&1 || fail "a test that fails by itself is no error"
grep -q 'test_tiny fails without any mutant' run.log || fail "the failing test is not named"
git checkout -q tiny.c
touch tiny.c
