#!/bin/sh
# SPDX-License-Identifier: MIT
# names: ip-folder work-folder   make new-ip's script: names that it refuses, with what is there left as it was.
set -eu
ip=$1 work=$2
rm -rf "$work"
mkdir -p "$work/bus" "$work/hdl/modem" "$work/ip/old" "$work/sw" "$work/testbench" "$work/synth"
cp -r "$ip/new.sh" "$ip/template" "$work/ip"
echo '{}' >"$work/hdl/modem/modem.regs.json"
echo 'module bus_thing (' >"$work/bus/other.v"
echo 'entity Vhdl_Thing is' >"$work/ip/old/other.vhd"
before=$(ls "$work/ip")
refused() { # words of the message, arguments
    words=$1
    shift
    status=0
    "$work/ip/new.sh" "$@" >"$work/log" 2>&1 || status=$?
    [ $status = 1 ] || { echo "exit status $status, not 1: $*" && exit 1; }
    grep -q -- "$words" "$work/log" || { cat "$work/log" && echo "'$words' is not said: $*" && exit 1; }
    [ "$(ls "$work/ip")" = "$before" ] || { echo "files were written: $*" && exit 1; }
}
refused 'usage'
refused 'usage' '' verilog
refused "not ''" fir
refused "not 'c'" fir c
refused 'small letters' Fir verilog
refused 'small letters' 2fir verilog
refused 'small letters' a_b verilog
refused 'small letters' ../fir verilog
refused 'small letters' 'fir x' verilog
refused 'reserved' signal vhdl
refused 'reserved' module verilog
refused 'reserved' template verilog
refused 'there already' old verilog
refused 'modem.regs.json' modem verilog
refused 'a module' bus_thing verilog
refused 'a module' vhdl_thing verilog
# A build that cannot be configured with it: taken back.
mkdir "$work/build"
touch "$work/build/build.ninja"
refused 'nothing was changed' fir verilog "$work/build"
rm -r "$work/build"
"$work/ip/new.sh" fir verilog "$work/build" | grep -q 'make ip-test IP=fir'
[ -f "$work/ip/fir/fir.v" ] && ! grep -rq '@[A-Z]*@' "$work/ip/fir" || { echo 'ip/fir is not what it should be' && exit 1; }
"$work/ip/new.sh" --help | grep -q usage
echo 'names: all as expected'
