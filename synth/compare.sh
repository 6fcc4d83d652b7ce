#!/bin/sh
# SPDX-License-Identifier: MIT
#
# compare: what has changed of the utilisation since another commit, as Markdown for a pull request (build/synth/compare.md).
# That commit is built and synthesised in a checkout of its own, build/synth/base; this one stays as it is.
# Usage: compare.sh utilisation-program commit [jobs]; build/synth/report.json is of now
set -eu
program=$(readlink -f "$1") commit=$2 jobs=${3:-2}
git rev-parse --verify -q "$commit^{commit}" >/dev/null || {
    echo "compare: there is no commit $commit" >&2
    exit 2
}
here=$PWD base=$PWD/build/synth/base
mkdir -p build/synth
exec 9>build/synth/base.lock
flock -n 9 || echo "waiting for another comparison in this folder ..." >&2
flock 9
git worktree prune
if [ -e "$base/.git" ]; then git -C "$base" checkout -q --detach "$commit"; else git worktree add -q --detach "$base" "$commit"; fi
cd "$base"
echo "Building what $(git log -1 --format='%h (%s)') synthesises ..." >&2
{ [ -e build/main/build.ninja ] || cmake -S . -B build/main -G Ninja; } >build.log 2>&1 &&
    ninja -C build/main -j "$jobs" synth_inputs >>build.log 2>&1 || {
    echo "compare: $commit does not build: $base/build.log" >&2
    exit 2
}
mkdir -p build/synth
ln -sfn "$here/build/synth/cache" build/synth/cache # what both have is synthesised once
# Status 1: that commit is beyond its own budget, which is not the question here.
"$program" --jobs "$jobs" >build.log || [ $? -eq 1 ] || exit 2
cd "$here"
{
    echo "Utilisation since $(git log -1 --format='%h (%s)' "$commit"):"
    echo
    "$program" --compare "$base/build/synth/report.json"
} | tee build/synth/compare.md
