#!/bin/sh
# SPDX-License-Identifier: MIT
#
# compare: what has changed of the utilisation since another commit, or between two commits, and tests and coverage beside it,
# as Markdown for a pull request (build/synth/compare.md). A commit is built and synthesised in a checkout of its own,
# build/synth/base or build/synth/head; this one stays as it is.
# Usage: compare.sh utilisation-program commit|commit..commit [jobs]; with one commit build/synth/report.json is of now
set -eu
program=$(readlink -f "$1") jobs=${3:-2}
id_of() { # commit: its whole name, which a checkout with a HEAD of its own knows, too
    git rev-parse --verify -q "$1^{commit}" || {
        echo "compare: there is no commit $1" >&2
        exit 2
    }
}
base=$(id_of "${2%%..*}") head=
case $2 in *..*) head=$(id_of "${2#*..}") ;; esac
here=$PWD
mkdir -p build/synth
exec 9>build/synth/base.lock
flock -n 9 || echo "waiting for another comparison in this folder ..." >&2
flock 9
git worktree prune
synthesise() { # commit folder
    if [ -e "$2/.git" ]; then git -C "$2" checkout -q --detach "$1"; else git worktree add -q --detach "$2" "$1"; fi
    cd "$2"
    echo "Building what $(git log -1 --format='%h (%s)') synthesises ..." >&2
    { [ -e build/main/build.ninja ] || cmake -S . -B build/main -G Ninja; } >build.log 2>&1 &&
        ninja -C build/main -j "$jobs" synth_inputs >>build.log 2>&1 || {
        echo "compare: $1 does not build: $2/build.log" >&2
        exit 2
    }
    mkdir -p build/synth
    ln -sfn "$here/build/synth/cache" build/synth/cache # what both have is synthesised once
    # Status 1: that commit is beyond its own budget, which is not the question here.
    "$program" --jobs "$jobs" >build.log || [ $? -eq 1 ] || exit 2
    cd "$here"
}
# A row: the commit, as the regression names it; of its stored runs the one with most tests; its
# coverage.
# coverage.
row() { # name
    /usr/bin/python3 - "$1" <<'END'
import json, pathlib, sys

def kept(file):
    return pathlib.Path("build", file).read_text().splitlines() if pathlib.Path("build", file).exists() else []

runs = [run for run in map(json.loads, kept("regress/history.jsonl")) if run["commit"] == sys.argv[1]]
run = max(runs, key=lambda run: run["passed"] + run["failed"], default=None)
covered = [line.split(" ", 1)[1] for line in kept("coverage/history") if line.startswith(sys.argv[1] + " ")]
print(f"| {sys.argv[1]} |", f"{run['passed']} passed, {run['failed']} failed" if run else "not measured", "|",
      covered[-1] if covered else "not measured", "|")
END
}
synthesise "$base" "$here/build/synth/base"
after=build/synth
[ -z "$head" ] || { synthesise "$head" "$here/build/synth/head" && after=build/synth/head/build/synth; }
{
    echo "Utilisation since $(git log -1 --format='%h (%s)' "$base")${head:+, at $(git log -1 --format='%h (%s)' "$head")}:"
    echo
    "$program" --output "$after" --compare build/synth/base/build/synth/report.json
    echo
    echo "| commit | tests | coverage |"
    echo "|---|---|---|"
    row "$(git describe --always --abbrev=10 "$base")"
    if [ -n "$head" ]; then row "$(git describe --always --abbrev=10 "$head")"; else row "$(git describe --always --abbrev=10 --dirty=+)"; fi
} | tee build/synth/compare.md
