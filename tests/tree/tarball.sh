#!/bin/sh
# SPDX-License-Identifier: MIT
# tarball: what lists the tree's files does so in a copy that is no clone.
# Usage: tarball.sh TREE regress-program
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$1"
git grep --no-index --exclude-standard --no-color -lz '' | xargs -0 cp --parents -t "$work"
"$work/tests/tree/arrows.py" "$work"
"$work/tests/tree/pages.py" "$work"
for tree in "$1" "$work"; do "$2" --source "$tree" --tree 'bus hdl'; done | uniq -u | {
    ! grep . || { echo 'the copy has another state' && exit 1; }
}
