#!/bin/bash
# SPDX-License-Identifier: MIT
#
# program: tests icesoc-xbee like a user: stty and the shell take the place of the programs that use
# the serial ports. Tests help, wrong options, command mode, data in both directions, statistics,
# and a clean end by Ctrl-C.
# Usage: program.sh icesoc-xbee
set -eu
program=$1
work=$(mktemp -d)
trap 'kill $pid 2>/dev/null || true; rm -rf "$work"' EXIT
trap 'exit 130' INT TERM HUP
pid=''
fail() {
    echo "FAILED: $*" >&2
    cat "$work"/out >&2 || true
    exit 1
}
"$program" --help | grep -q 'two XBee' || fail "--help"
for wrong in '--loss 2' '--a ZZ=1' '--a MY=G' '--a CH=1' '--b MY' '--nonsense' \
    '--trace /dev/null' "--link-a $work/none/x"; do
    # shellcheck disable=SC2086
    if "$program" $wrong --duration 0.1 >"$work/out" 2>&1; then fail "took $wrong"; fi
    [ -s "$work/out" ] || fail "said nothing about $wrong"
done

"$program" --a GT=14 --a BD=7 --b BD=7 --link-a "$work/a" --link-b "$work/b" -v >"$work/out" 2>&1 &
pid=$!
for _ in $(seq 500); do # waits until the link exists
    [ -e "$work/b" ] && break
    sleep 0.02
done
stty -F "$work/a" 115200 raw -echo
stty -F "$work/b" 115200 raw -echo
exec 3<>"$work/a" 4<>"$work/b"
sleep 0.2
# Uses head, because bash's built-in `read` would change the settings of the terminal. The limit
# only prevents a broken program from hanging.
expect() { # arguments: file descriptor, text, description
    answer=$(timeout 60 head -c ${#2} <&"$1" | tr '\r' '~') || true
    [ "$answer" = "${2//$'\r'/'~'}" ] || fail "$3: '$answer'"
}
printf '+++' >&3
expect 3 $'OK\r' "answer to +++"
printf 'ATMY\r' >&3
expect 3 $'1\r' "answer to ATMY"
printf 'ATCN\r' >&3
expect 3 $'OK\r' "answer to ATCN"
printf 'hello, world.' >&3
expect 4 'hello, world.' "came across"
kill -INT $pid
wait $pid || fail "status $? after Ctrl-C"
pid=''
grep -q '0001 -> 0002 *13 bytes  delivered' "$work/out" || fail "no line for the packet"
grep -q '^a: .* 2 commands (0 refused)' "$work/out" || fail "no statistics"
grep -q 'air: 1 packets, 13 bytes, 0 lost' "$work/out" || fail "no statistics of the air"
[ ! -L "$work/a" ] || fail "the link is still there"
echo passed
