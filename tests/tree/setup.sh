#!/bin/sh
# SPDX-License-Identifier: MIT
# setup: on a terminal set-up says what it would install and asks before it calls sudo; elsewhere
# it goes on. What CMake needs is among the packages of set-up without --tests, and it ends where
# one is missing: so the list of tests is the same on each machine.
# Usage: setup.sh source-folder
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT TERM HUP
fail() {
    cat "$work/said" >&2
    echo "setup: $*" >&2
    exit 1
}
# A machine that has no package yet, and a user who is not root
mkdir "$work/bin"
program() { printf '#!/bin/sh\n%s\n' "$2" >"$work/bin/$1" && chmod +x "$work/bin/$1"; }
program dpkg-query ''
program id 'echo 1000'
program sudo "echo \"\$*\" >>'$work/sudo'"
export PATH="$work/bin:$PATH"
asked() { # answer
    rm -f "$work/sudo"
    echo "$1" | script -qec "$2/cmake/setup.sh" "$work/said" >/dev/null || true
}
asked n "$1"
grep -q '    verilator: turns' "$work/said" || fail "no word of what is missing"
grep -q 'sudo apt-get? \[Y/n\]' "$work/said" || fail "no question"
[ ! -e "$work/sudo" ] || fail "sudo was called after a no"
listed() { git -C "$1" grep --no-index --exclude-standard -hE "$2" -- '*.cmake' '*CMakeLists.txt'; }
for package in $(listed "$1" '^ *icesoc_needs' | sed 's/.*(\([^ ]*\).*/\1/'); do
    grep -q "    $package: " "$work/said" || fail "CMake needs $package, which is not set up"
done
sed -n '/^function(icesoc_needs/,/^endfunction/p' "$1/cmake/icesoc.cmake" >"$work/needs.cmake"
echo 'icesoc_needs(yosys YOSYS program nothing)' >>"$work/needs.cmake"
! cmake -P "$work/needs.cmake" >"$work/said" 2>&1 || fail "CMake goes on without a program"
grep -q "nothing is missing (Debian: yosys): run 'make setup'" "$work/said" || fail "no word of it"
! listed "$1" 'find_(package|program|library|path|file)\(' | grep -vE 'REQUIRED|\(CCACHE' ||
    fail "CMake goes on where that is missing"
asked y "$1"
grep -q 'apt-get install .* verilator' "$work/sudo" || fail "nothing was installed after a yes"
rm "$work/sudo"
"$1/cmake/setup.sh" >"$work/said" </dev/null || fail "exit status $?"
grep -q 'apt-get install .* verilator' "$work/sudo" || fail "it stops where nobody can be asked"
