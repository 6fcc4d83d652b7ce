#!/bin/sh
# SPDX-License-Identifier: MIT
# new_core: from nothing to a called core: make new-ip's script, its line, the build of the simulator with it, and a call from
# Python by radio, in machine seconds. Begins with the build of test e2e.cores, which it makes if it is missing. Then the same with
# two third-party cores by make new-foreign's, if they can be had, beside the lines that LiteX takes (docs/hw-mapping.md).
# Usage: new_core.sh source-folder build-folder out.json [--brief]     --brief: only calls a core of that build
set -eu
source=$1 build=$2 json=$3
work=$build/tests/e2e/cores/chip
[ -x "$work/build/testbench/sim/icesoc-sim" ] || "$source/tests/e2e/cores/cores.sh" "$source" "$build" "$work"
tree=$work/tree
rm -rf "$tree"
mkdir -p "$tree/bus" "$tree/hdl" "$tree/sw" "$tree/testbench" "$tree/synth" "$tree/ip" "$(dirname "$json")"
cp -r "$source/ip/new.sh" "$source/ip/template" "$tree/ip"
name=fresh$(date +%s | tail -c 6) # new to the compiler's cache, too
guard=1000 # ms, of modems as they are delivered
[ "${4:-}" != --brief ] || { name=sample_verilog && guard=20; }
begin=$(date +%s.%N)
"$tree/ip/new.sh" "$name" verilog "$tree/none" >/dev/null
if [ "${4:-}" != --brief ]; then
    echo "$name identity=sample_verilog" >"$work/cores.list"
    cmake -S "$source" -B "$work/build" "-DCORE_FOLDERS=$tree/ip/$name" >"$work/build.log" 2>&1
    ninja -C "$work/build" icesoc-sim >>"$work/build.log" 2>&1 || { tail -20 "$work/build.log" && exit 1; }
fi
built=$(date +%s.%N)
type=$(echo "$name" | sed -E 's/(^|_)([a-z])/\U\2/g')
caller() { # Slice file, statements with the proxy p
    cat >"$work/call.py" <<P
import sys, Ice
Ice.loadSlice("", ["$1"])
data = Ice.InitializationData()
data.properties = Ice.createProperties()
data.properties.setProperty("Ice.Plugin.XBeeAT", "$build/ground/xbeeat:createXBeeAT")
data.properties.setProperty("XBeeAT.Clock", sys.argv[2])
data.properties.setProperty("XBeeAT.Guard", "$guard")
with Ice.initialize(data) as ic:
    p = ic.stringToProxy("sample_verilog:xbee-at -d %s -a 0x0001 -t 300000" % sys.argv[1])
    $2
P
    "$work/build/testbench/sim/icesoc-sim" --size 96x64 --image /usr/share/xplanet/images/earth.jpg --out "$work" --guard $guard -- \
        /usr/bin/python3 "$work/call.py" '{device}' '{status}' >"$work/log" 2>&1 || { cat "$work/log" && exit 1; }
}
caller "$tree/ip/$name/$name.ice" "import Cores; sys.exit(Cores.${type}Prx.checkedCast(p).sumTo(100) != 5050)"
called=$(date +%s.%N)
foreign='' # entries of the figures
if [ "${4:-}" != --brief ] && "$source/cmake/fetch.py" foreign "$work/foreign" >"$work/log" 2>&1; then
    for core in "aes memory aes 22" "wbuart wishbone wbuart32 34"; do
        # shellcheck disable=SC2086 # words
        set -- $core
        slot=foreign_$1$(date +%s | tail -c 6)
        from=$(date +%s.%N)
        "$source/ip/new_foreign.py" "$slot" "$1" "$2" "$tree/ip/$slot" "$work/foreign/$3"/*.v >/dev/null
        echo "$slot identity=sample_verilog" >"$work/cores.list"
        cmake -S "$source" -B "$work/build" "-DCORE_FOLDERS=$tree/ip/$slot" >"$work/build.log" 2>&1
        ninja -C "$work/build" icesoc-sim >>"$work/build.log" 2>&1 || { tail -20 "$work/build.log" && exit 1; }
        caller "$source/sw/hw/registers/Registers.ice" "import Hw; sys.exit(len(Hw.RegistersPrx.checkedCast(p).list()) < 2)"
        foreign="$foreign$(date +%s.%N | awk -v a="$from" -v core="$1" -v lines="$4" '{
            printf ",\\n {\"name\": \"foreign core %s, lines by hand\", \"value\": 1, \"unit\": \"lines\", \"peer\": \"LiteX %d\", \"ratio\": %.3f, \"command\": \"make bench\"}", core, lines + 1, 1 / (lines + 1)
            printf ",\\n {\"name\": \"foreign core %s, from its sources to called by radio\", \"value\": %.1f, \"unit\": \"s\", \"command\": \"make bench\"}", core, $1 - a }')"
    done
fi
awk -v a="$begin" -v b="$built" -v c="$called" -v foreign="$foreign" -v json="$json" 'BEGIN {
    command = "make bench"
    printf "[{\"name\": \"new core, from nothing to called by radio\", \"value\": %.1f, \"unit\": \"s\", \"limit\": 60, \"share\": %.3f, \"command\": \"%s\"},\n", c - a, (c - a) / 60, command > json
    printf " {\"name\": \"new core, of that its build into the simulator\", \"value\": %.1f, \"unit\": \"s\", \"command\": \"%s\"},\n", b - a, command > json
    printf " {\"name\": \"new core, files touched by hand\", \"value\": 1, \"unit\": \"files\", \"limit\": 1, \"share\": 1, \"command\": \"%s\"}%s]\n", command, foreign > json
    printf "new core: %.1f s from nothing to called by radio, %.1f s of it the build (limit 60)\n", c - a, b - a }'
