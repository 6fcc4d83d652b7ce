#!/bin/sh
# SPDX-License-Identifier: MIT
#
# bisect: finds the commit since which a test fails, in a checkout of its own; this one stays as it is.
# Usage: bisect.sh regress-program test [good-commit] [bad-commit] [seed] [jobs]
# Without a good commit: the last one that the test passed at (build/regress/history.jsonl). Commits that do not build, or lack
# the test, are passed over. Exit status 0: found, and named in the last line; 1: not found; 2: it could not begin.
set -eu
regress=$1 test=$2 good=${3:-} bad=${4:-HEAD} seed=${5:-1} jobs=${6:-2}
stop() {
    echo "bisect: $1" >&2
    exit 2
}
[ -n "$test" ] || stop "TEST= names the test, as CTest does: make bisect TEST=test_fifo.Fifo.Wraps"
git rev-parse --verify -q "$bad^{commit}" >/dev/null || stop "there is no commit $bad"
if [ -z "$good" ]; then # lines are runs, the oldest first; a bisection cannot begin at a state that is not committed
    good=$(TEST=$test python3 -c '
import json, os
for line in open("build/regress/history.jsonl"):
    run = json.loads(line)
    if run["tests"].get(os.environ["TEST"], [""])[0] == "p" and "dirty" not in run["commit"]: print(run["commit"])' 2>/dev/null | tail -n 1)
    [ -n "$good" ] || stop "no run that is noted passed $test at a commit: GOOD= names one"
fi
git rev-parse --verify -q "$good^{commit}" >/dev/null || stop "there is no commit $good"
git merge-base --is-ancestor "$good" "$bad" || stop "$good does not lead to $bad"
mkdir -p build/bisect
exec 9>build/bisect/lock
flock -n 9 || stop "another one runs in this folder"
tree=$PWD/build/bisect/tree
git worktree remove --force "$tree" 2>/dev/null || rm -rf "$tree"
git worktree prune
git worktree add -q --detach "$tree" "$bad"
trap 'git worktree remove --force "$tree"' EXIT
trap 'exit 2' INT TERM
regress=$(readlink -f "$regress")
cat >build/bisect/step.sh <<END
#!/bin/sh
# Judges one commit: 0 passes, 1 fails, 125 unknown. The build stays for the next one.
[ -e build/main/build.ninja ] || cmake -S . -B build/main -G Ninja >/dev/null || exit 125
status=0
"$regress" --make --name '^$(printf %s "$test" | sed 's/[].[*+?(){}|^$\\]/\\&/g')\$' --seed '$seed' --jobs '$jobs' --waves 0 >build/step.log 2>&1 || status=\$?
echo "\$(git log -1 --format='%h %s'): \$(case \$status in 0) echo passes ;; 1) echo fails ;; *) echo 'cannot be told' ;; esac)"
[ \$status -le 1 ] || exit 125
exit \$status
END
chmod +x build/bisect/step.sh
step=$PWD/build/bisect/step.sh
cd "$tree"
"$step" && stop "the test passes at $bad"
git bisect start "$bad" "$good" >/dev/null 2>&1
git bisect run "$step" 2>&1 | grep -E ': (passes|fails|cannot be told)$' || true
first=$(git bisect log | sed -n 's/^# first bad commit: \[\(.*\)\].*/\1/p')
git bisect reset >/dev/null 2>&1
[ -n "$first" ] || {
    echo "bisect: not found: commits that cannot be told lie between" >&2
    exit 1
}
echo "since $(git log -1 --format='%h %s (%an, %as)' "$first")"
