#!/bin/sh
# SPDX-License-Identifier: MIT
#
# tests_named: every test that a page names (`Suite.Name` or `Suite.*` in backquotes) exists. Usage: tests_named.sh PAGE test-folder...
set -eu
page=$1
shift
status=0
for name in $(grep -o '`[A-Z][A-Za-z]*\.\([A-Z][A-Za-z0-9]*\|\*\)`' "$page" | tr -d '`' | sort -u); do
    suite=${name%%.*} case=${name#*.}
    [ "$case" != '*' ] || case='[A-Z]'
    grep -rqE "TEST(_F|_P)?\($suite, $case" --include='*.cpp' "$@" || {
        echo "$page: there is no test $name" >&2
        status=1
    }
done
exit $status
