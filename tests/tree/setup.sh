#!/bin/sh
# SPDX-License-Identifier: MIT
# setup: on a terminal set-up says what it would install and asks before it calls sudo; elsewhere
# it goes on.
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
asked y "$1"
grep -q 'apt-get install .* verilator' "$work/sudo" || fail "nothing was installed after a yes"
rm "$work/sudo"
"$1/cmake/setup.sh" >"$work/said" </dev/null || fail "exit status $?"
grep -q 'apt-get install .* verilator' "$work/sudo" || fail "it stops where nobody can be asked"
