#!/bin/sh
# SPDX-License-Identifier: MIT
#
# gdb: an interactive GDB on the firmware's ARM binary, which runs against the RTL. Usage: gdb.sh build-folder
#      [options of icesoc-sim]
set -eu
build=$1
shift
log=$(mktemp)
"$build/testbench/sim/icesoc-sim" --gdb 0 --speed max "$@" >"$log" 2>&1 &
pid=$!
trap 'kill $pid 2>/dev/null || true; rm -f "$log"' EXIT
trap 'exit 143' TERM HUP
port=$("$(dirname "$0")/gdb_port.sh" "$log" $pid)
cat "$log"
trap '' INT # Ctrl-C goes to GDB, which stops the processor
gdb-multiarch -q "$build/firmware/uav.elf" -ex 'set remotetimeout unlimited' -ex "target remote localhost:$port"
