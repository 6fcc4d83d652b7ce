#!/bin/sh
# SPDX-License-Identifier: MIT
#
# format: fails on C and C++ files that .clang-format would write in another way, and names them.
# Usage: format.sh TREE PROGRAMS    PROGRAMS: a folder for clang-format 14
# To mend them all: PROGRAMS/clang-format -i FILE...
set -eu
cd "$1"
program=$2/clang-format
[ -x "$program" ] || cmake/fetch.sh clang-format "$2"
files=$(git grep --no-index --exclude-standard --no-color -l '' -- '*.c' '*.h' '*.cpp' | grep -v -e /golden/ -e /errors/)
# shellcheck disable=SC2086 # a list of words
echo $files | xargs -n 60 -P 2 "$program" --dry-run -Werror >"$2/format.log" 2>&1 || {
    echo "Not as clang-format 14 writes them (mend: $program -i FILE):"
    sed -n 's/^\([^:]*\):[0-9].*error.*/    \1/p' "$2/format.log" | sort -u
    exit 1
}
