#!/bin/sh
# SPDX-License-Identifier: MIT
#
# gdb_port: waits until a simulator waits for GDB, and prints the port. Usage: gdb_port.sh its-output its-process
#      Exit status 1, with the output, where the simulator ends first.
set -eu
while ! grep -q 'target remote' "$1"; do
    grep -q '^State:.[^ZX]' "/proc/$2/status" 2>/dev/null || { cat "$1" >&2 && exit 1; }
    sleep 0.1
done
sed -n "s/.*localhost:\([0-9]*\)'.*/\1/p" "$1"
