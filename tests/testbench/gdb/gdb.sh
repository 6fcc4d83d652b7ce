#!/bin/sh
# SPDX-License-Identifier: MIT
#
# gdb: Debian's GDB debugs the firmware on the RTL: breakpoints, steps, registers, memory, the FPGA's registers.
# Usage: gdb.sh icesoc-sim firmware.elf out-folder
set -eu
command -v gdb-multiarch >/dev/null || { echo "gdb: gdb-multiarch is missing; run 'make setup-tests'" >&2 && exit 1; }
sim=$1 elf=$2 out=$3
rm -rf "$out"
mkdir -p "$out"
"$sim" --image /usr/share/xplanet/images/earth.jpg --size 96x64 --cpu m3 --firmware "$elf" --gdb 0 --speed max --duration 30 \
    --out "$out" >"$out/sim.log" 2>&1 &
pid=$!
trap 'kill $pid 2>/dev/null || true' EXIT
port=$("$(dirname "$0")/../../../testbench/sim/gdb_port.sh" "$out/sim.log" $pid)
cat >"$out/commands" <<E1
set confirm off
set width 0
set remotetimeout unlimited
target remote localhost:$port
monitor reset
maintenance flush register-cache
echo START \n
info symbol \$pc
break UAV_start
continue
print board_fsmc.read32
stepi
stepi
info symbol \$pc
break SysTick_Handler
continue
backtrace 1
print \$xpsr & 0x1ff
print/x \$control
print \$msp != \$psp
x/1xw 0x64000000
x/1xw 0xe000ed00
print boot_record.starts
set var boot_record.starts = 77
print boot_record.starts
set \$r12 = 0x1234
print/x \$r12
finish
delete
monitor info
monitor reset
info symbol \$pc
kill
E1
timeout 600 gdb-multiarch -nx -batch -x "$out/commands" "$elf" >"$out/gdb.log" 2>&1 || true
wait $pid || true
trap - EXIT
expect() {
    grep -q -- "$1" "$out/gdb.log" || { cat "$out/gdb.log" "$out/sim.log" && echo "expected: $1" && exit 1; }
}
expect '^Reset_Handler in section .text'
expect '^Breakpoint 1, UAV_start'
expect '^UAV_start + [24] in section .text'
expect '^Breakpoint 2, .*SysTick_Handler'
expect '^#0 .*SysTick_Handler'
expect '= 15$'
expect '^0x64000000:.*0x5359'       # the system slot says who it is
expect '^0xe000ed00:.*0x412fc230'   # a Cortex-M3
expect '= 77$'
expect '= 0x1234$'
expect 's simulated, .* instructions'
