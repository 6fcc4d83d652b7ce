#!/bin/sh
# SPDX-License-Identifier: MIT
# rm: name build-folder   Takes a core away: ip/<name> and its line in ip/cores.list. Refuses where work would be lost, unless
# FORCE=1.
set -eu
usage='usage: make rm-ip NAME=low_pass [FORCE=1]'
case ${1:-} in -h | --help) echo "$usage" && exit 0 ;; esac
name=${1:-} build=${2:-build/main}
cd "$(dirname "$0")/.."
fail() { echo "rm-ip: $*" >&2 && exit 1; }
[ -n "$name" ] || fail "$usage"
case $name in template | *[!a-z0-9_]*) fail "'$name' is not a core" ;; esac
[ -d "ip/$name" ] || fail "there is no ip/$name"
if [ -z "${FORCE:-}" ] && git rev-parse --git-dir >/dev/null 2>&1; then
    changed=$(git status --porcelain --ignored -- "ip/$name")
    [ -z "$changed" ] || fail "ip/$name has changes that are not committed (FORCE=1 takes it away all the same):
$changed"
fi
# Lines whose inputs are this core's outputs. An input that only other cores drive ("internal") is 0
# from then on; any other would become a pin of the chip.
users=$(sed 's/#.*//' ip/cores.list | grep -E "=$name\." | while read -r user words; do
    for word in $words; do
        case $word in
        *="$name".*)
            grep -qE "\"name\": *\"${word%%=*}\"[^}]*\"internal\": *true" "ip/$user/"*.regs.json 2>/dev/null || echo "$user"
            ;;
        esac
    done
done | sort -u | tr '\n' ' ')
[ -z "$users" ] || fail "in ip/cores.list the inputs of $users are outputs of '$name'; change these lines first"
rm -r "ip/$name"
sed -i -E "/^[[:space:]]*$name([[:space:]]|#|\$)/d" ip/cores.list
[ ! -f "$build/build.ninja" ] || cmake "$build" >"$build/rm-ip.log" 2>&1 ||
    fail "the build cannot be configured without it: $build/rm-ip.log"
echo "ip/$name and its line in ip/cores.list are gone"
