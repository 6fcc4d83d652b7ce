#!/bin/sh
# SPDX-License-Identifier: MIT
#
# tests_named: every test that a page names exists: `Suite.Name` or `Suite.*` in backquotes as a C++
# test in the folders,
# `slice.name` and its like as ctest's. Usage: tests_named.sh PAGE build-folder test-folder...
set -eu
page=$1 build=$2
shift 2
status=0
missing() {
    echo "$page: unknown test $1" >&2
    status=1
}
named() { grep -oE "\`$1\`" "$page" | tr -d '`' | sort -u; }
for name in $(named '[A-Z][A-Za-z]*\.([A-Z][A-Za-z0-9]*|\*)' | grep -v "^Ice[.]"); do
    suite=${name%%.*} case=${name#*.}
    [ "$case" != '*' ] || case='[A-Z]'
    grep -rqE "TEST(_F|_P)?\($suite, $case" --include='*.cpp' "$@" || missing "$name"
done
names=$(named '([a-z]+\.fuzz|e2e|slice|lint|formal)\.[a-z0-9_.]+[a-z0-9]')
[ -z "$names" ] || known=$(ctest --test-dir "$build" -N 2>/dev/null | sed -n 's/.*: \(.*\)/\1/p')
for name in $names; do
    echo "$known" | grep -qxF "$name" || missing "$name"
done
exit $status
