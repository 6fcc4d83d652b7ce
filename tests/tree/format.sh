#!/bin/sh
# SPDX-License-Identifier: MIT
#
# format: reports C and C++ files that .clang-format would change, and scripts, CMake files, Verilog
# and VHDL with lines of more than 100 columns. Prints the names of these files; the exit status is
# then 1. Versions of clang-format differ in some lines; version 19 is in Debian 12 and 13.
# Usage: format.sh TREE
# To fix all files: clang-format-19 -i FILE...
set -eu
cd "$1"
listed() { git grep --no-index --exclude-standard --no-color "$@"; }
if listed -nE '^.{101}' -- '*.sh' '*.py' '*.cmake' '*CMakeLists.txt' '*.v' '*.vh' \
    '*.vhd'; then
    echo "Over 100 columns (see above)."
    exit 1
fi
log=$(mktemp)
trap 'rm -f "$log"' EXIT
files=$(listed -l '' -- '*.c' '*.h' '*.cpp' | grep -v -e /golden/ -e /errors/)
# shellcheck disable=SC2086 # a list of words
echo $files | xargs -n 60 -P 2 clang-format-19 --dry-run -Werror >"$log" 2>&1 || {
    echo "Not as clang-format 19 writes them (to fix: clang-format-19 -i FILE):"
    sed -n 's/^\([^:]*\):[0-9].*error.*/    \1/p' "$log" | sort -u
    grep -v '^[^:]*:[0-9]' "$log" | grep 'clang-format-19:' | head -3
    exit 1
}
