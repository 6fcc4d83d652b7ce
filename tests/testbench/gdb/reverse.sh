#!/bin/sh
# SPDX-License-Identifier: MIT
#
# reverse: Debian's GDB runs a recorded flight backwards, a secure one. Usage: reverse.sh icesoc-sim firmware.elf out-folder
set -eu
command -v gdb-multiarch >/dev/null || { echo "reverse: gdb-multiarch is missing; run 'make setup-tests'" >&2 && exit 1; }
sim=$1 elf=$2 out=$3
rm -rf "$out"
mkdir -p "$out"
(umask 077 && echo 000102030405060708090a0b0c0d0e0f >"$out/a.key")
"$sim" --image /usr/share/xplanet/images/earth.jpg --size 96x64 --cpu m3 --firmware "$elf" --speed max --duration 0.3 --key "$out/a.key" \
    --out "$out/flight" --quiet
"$sim" --replay "$out/flight" --out "$out" --gdb 0 >"$out/sim.log" 2>&1 &
pid=$!
trap 'kill $pid 2>/dev/null || true' EXIT
port=$("$(dirname "$0")/../../../testbench/sim/gdb_port.sh" "$out/sim.log" $pid)
# Where it is, as a line "NAME instructions pc"; going on from a place must lead to the same one each time.
cat >"$out/commands" <<E1
set confirm off
set width 0
set remotetimeout unlimited
target remote localhost:$port
reverse-stepi
echo AT_BEGIN \\n
monitor info
break UAV_start
continue
echo START \\n
monitor info
delete
stepi 20
echo AHEAD \\n
monitor info
reverse-stepi 20
echo BACK \\n
monitor info
stepi 20
echo AGAIN \\n
monitor info
continue
echo END \\n
monitor info
break SysTick_Handler
reverse-continue
echo TICK1 \\n
monitor info
reverse-continue
echo TICK2 \\n
monitor info
set var boot_record.starts = 77
continue
echo TICK1_AGAIN \\n
monitor info
reverse-finish
echo CALLER \\n
info symbol \$pc
delete
break UAV_start
reverse-continue
echo START_AGAIN \\n
monitor info
print boot_record.starts
kill
E1
timeout 300 gdb-multiarch -nx -batch -x "$out/commands" "$elf" >"$out/gdb.log" 2>&1 || true
status=0
wait $pid || status=$?
trap - EXIT
fail() {
    cat "$out/gdb.log" "$out/sim.log"
    echo "$1"
    exit 1
}
at() { sed -n "/^$1 \$/,/simulated/ s/.*simulated, \([0-9]*\) instructions, \([0-9]*\) cycles.*/\1 \2/p" "$out/gdb.log" | grep . || fail "nothing of $1"; }
same() { [ "$(at "$1")" = "$(at "$2")" ] || fail "$1 is at $(at "$1"), $2 at $(at "$2")"; }
[ $status = 0 ] || fail "the simulator's exit status is $status"
[ "$(at AT_BEGIN)" = "0 0" ] || fail "it began at $(at AT_BEGIN)"
same START BACK
same AHEAD AGAIN
same TICK1 TICK1_AGAIN
same START START_AGAIN
[ "$(at TICK1 | cut -d' ' -f1)" -gt "$(at TICK2 | cut -d' ' -f1)" ] || fail "the tick before comes later"
[ "$(at END | cut -d' ' -f1)" -gt "$(at TICK1 | cut -d' ' -f1)" ] || fail "the last tick comes after the end"
# As GDB 13 says it, or GDB 16.
[ "$(grep -c -e 'No more reverse-execution history' -e 'Reached end of recorded history' "$out/gdb.log")" = 2 ] || fail "begin and end are not told"
! grep -q '= 77$' "$out/gdb.log" || fail "what the debugger wrote later is there earlier"
! pgrep -f -- "--out $out --gdb" || fail "a copy of the simulator was left behind"
