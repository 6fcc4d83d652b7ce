#!/bin/sh
# SPDX-License-Identifier: MIT
#
# gdb: Debian's GDB debugs the firmware on the RTL: breakpoints, steps, registers, memory, the FPGA's registers.
# Usage: gdb.sh icesoc-sim firmware.elf out-folder
set -eu
sim=$1 elf=$2 out=$3
rm -rf "$out"
mkdir -p "$out"
"$sim" --image /usr/share/xplanet/images/earth.jpg --size 96x64 --cpu m3 --firmware "$elf" --gdb 0 --speed max --duration 30 \
    --out "$out" --marks "$out/marks.vcd" >"$out/sim.log" 2>&1 &
pid=$!
trap 'kill $pid 2>/dev/null || true' EXIT
while ! grep -q 'target remote' "$out/sim.log"; do
    kill -0 $pid || { cat "$out/sim.log" && exit 1; }
    sleep 0.1
done
port=$(sed -n "s/.*localhost:\([0-9]*\)'.*/\1/p" "$out/sim.log")
# A client that is no debugger is sent away: a web page's request with a packet in it, a packet without an end, silence. One that
# leaves while the processor runs makes room for the next.
python3 - "$port" <<'PY'
import socket, sys, time
def talk(bytes, seconds=20):
    s = socket.create_connection(("127.0.0.1", int(sys.argv[1])))
    s.settimeout(seconds)
    try:
        s.sendall(bytes)
        return s.recv(64)
    except ConnectionError:
        return b""
def packet(text):
    return b"$%s#%02x" % (text, sum(text) & 255)
assert talk(b"POST / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n" + packet(b"k")) == b""
assert talk(b"$" + b"m" * 100000) == b""
assert talk(b"") == b""
s = socket.create_connection(("127.0.0.1", int(sys.argv[1])))
s.sendall(packet(b"?"))
s.recv(64)
s.sendall(b"+" + packet(b"c"))
time.sleep(0.5)
s.close()
assert talk(b"GET /") == b"", "the processor runs, and a web page comes"
PY
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
# Marks: the interrupt's name and number stand in the waveform.
grep -q '^sSysTick_Handler "' "$out/marks.vcd"
grep -q '^b00001111 !' "$out/marks.vcd"
