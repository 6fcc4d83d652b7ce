#!/bin/sh
# SPDX-License-Identifier: MIT
# cores: source-folder build-folder work-folder TRACE|NETLIST
# Builds a simulator with the cores of a separate list, from the RTL with tracing or from the chip's
# netlist, and calls the cores by radio.
set -eu
source=$1 build=$2 work=$3 chip=$4
# This folder is as deep in the tree as build/main, so that the compiler cache has many of its
# object files: their sources have the same relative paths.
own=$source/build/cores_$(echo "$chip" | tr '[:upper:]' '[:lower:]')
mkdir -p "$own" "$work"
# fresh NAME: replaces NAME by fresh/NAME if their contents differ. Otherwise NAME keeps its file
# times and is not built again.
fresh() {
    diff -r "$work/fresh/$1" "$work/$1" >/dev/null 2>&1 ||
        { rm -rf "${work:?}/$1" && mv "$work/fresh/$1" "$work/$1"; }
}
# mapped NAME: copies a core from the tests of the hardware mapping into the folder for the list.
mapped() {
    mkdir -p "$work/fresh/$1"
    printf 'interface = "%s"\nverilog = ["%s"]\n' "$source/tests/slice/hardware/golden/$1.ice" \
        "$source/tests/slice/hardware/$1.v" >"$work/fresh/$1/core.toml"
    fresh "$1"
}
logged() { "$@" >"$work/log" 2>&1 || { tail -40 "$work/log" && exit 1; }; }
rm -rf "$work/fresh" && mkdir "$work/fresh"
clocked='my_requests clock=6/25'
[ "$chip" = TRACE ] || clocked='# no core with a separate clock: its DCM_CLKGEN has no model'
signals=''
for signal in valid_i write_i addr_i:4 wdata_i:32 ready_o rdata_o:32; do
    signals=$signals,u_sample_verilog.bus_$signal
done
cat >"$work/fresh/cores.list" <<END
# the chip of this test does not contain the vision core
sample_verilog
sample_vhdl identity=newcomer slot=9
scaler
servo fault_i=@B4
crc32
my_port name=port
$clocked
my_lamps
many
probe signals=${signals#,}
END
fresh cores.list
samples=$build/tests/ip/new
foreign=$build/tests/ip/new_foreign
here=$source/tests/e2e/cores
golden=$source/tests/slice/hardware/golden
folders="$samples/sample_verilog;$samples/sample_vhdl;$work/scaler;$here/servo;$here/crc32"
folders="$folders;$work/many;$foreign/my_port;$foreign/my_requests;$work/my_lamps"
mapped scaler # a core with sequences, exceptions and events
mapped many   # a core with 46 words, more than the 16 of a slot
# A core in VHDL that ./icesoc core foreign has put into a slot. GHDL is downloaded only once.
lamps=$source/tests/ip/new_foreign/lamps
logged "$source/tools/python" -m icesoc.cores.new_foreign \
    my_lamps lamps own "$work/fresh/my_lamps" GHDL="$build/ghdl/ghdl" \
    LIBRARY=lights PARAM:lamps_lit=4 read=request_rd write=request_wr address=request_a \
    wdata=request_d rdata=q "$lamps.vhd" "${lamps}_types.vhd"
fresh my_lamps
[ -e "$own/ghdl" ] || ln -s "$build/ghdl" "$own/ghdl"
# CLK_HZ is low, because the servo core counts in every clock, so that the simulator cannot skip any
# clock.
logged cmake -S "$source" -B "$own" -G Ninja "-D$chip=ON" -DCLK_HZ=2000000 \
    "-DCORES=$work/cores.list" "-DCORE_FOLDERS=$folders" \
    "-DROOMS=bus;slice;ip;sw;hdl;synth;testbench"
tested='test_ip_servo test_ip_crc32 test_ip_my_lamps'
# shellcheck disable=SC2086 # a list of words
logged ninja -C "$own" icesoc-sim firmware_uav $tested
logged ctest --test-dir "$own" --output-on-failure --no-tests=error \
    -R "^($(echo $tested | tr ' ' '|'))[.]"
echo '1000 servo.fault_i 1 # milliseconds' >"$work/pins"
echo '1001 servo.fault_i 0' >>"$work/pins"
echo '500 port.port_in_i 0x83' >>"$work/pins"
simulator=$own/testbench/sim/icesoc-sim
logged "$simulator" --pins "$work/pins" --size 96x64 --image /usr/share/xplanet/images/earth.jpg \
    --out "$work" --seed "${SEED:-1}" --guard 20 -- "$source/tools/python" "$here/client.py" \
    '{device}' '{guard}' '{status}' "$build/ground/xbeeat:createXBeeAT" "$work" "$own/gen" "$chip" \
    "$samples/sample_verilog/sample_verilog.ice" "$golden/scaler.ice" "$golden/many.ice" \
    "$here/servo/servo.ice" "$here/crc32/crc32.ice" "$samples/sample_vhdl/sample_vhdl.ice" \
    "$source/sw/hw/registers/Registers.ice" "$source/ip/probe/Probe.ice"
# Checks that pulses last 1.5 ms and are 20 ms apart, independent of the clock frequency. The fault
# pin may have ended one pulse and delayed the pulses after it.
awk '$2 != "servo.pwm_o" { next }
     $3 == 4 { frames += up && $1 - last > 19.999 && $1 - last < 20.001; last = up = $1 }
     $3 == 0 && up { n += $1 - up > 1.499 && $1 - up < 1.501; all++ }
     END { exit !(n > 10 && all - n <= 1 && frames >= n - 2) }' "$work/pins.log" ||
    { tail "$work/pins.log" && echo 'the pulses are not 1.5 ms long, 20 ms apart' && exit 1; }
prints() { grep -Eq "$1" "$work/log" || { cat "$work/log" && echo "not said: $1" && exit 1; }; }
prints 'cores: all as expected'

# The simulator must list the cores that prevent it from skipping clocks: two cores are never idle.
# The probe's capture is fetched by radio and converted by GTKWave's tools. Over the captured time,
# it must be equal to the simulator's trace of the replayed flight.
traced() {
    prints "'(my_requests|servo)' changes in nearly every clock"
    vcd2fst "$work/probe.vcd" "$work/probe.fst" >"$work/log"
    fst2vcd "$work/probe.fst" >"$work/captured.vcd"
    span=$(awk '/^#/ { t = substr($1, 2) / 1e9; if (!n++) first = t }
        END { printf "--from %.6f --to %.6f", first - 2e-5, t + 2e-5 }' "$work/probe.vcd")
    mkdir -p "$work/begin" && cp "$work/before.png" "$work/begin"
    awk -v end="${span##* }" -F '"ns":' 'NR > 1 && $2 / 1e9 > end + 0.1 { exit } 1' \
        "$work/flight.jsonl" >"$work/begin/flight.jsonl"
    # shellcheck disable=SC2086 # options
    logged "$simulator" --replay "$work/begin" --out "$work/again" --wave "$work/trace.fst" $span
    fst2vcd "$work/trace.fst" >"$work/trace.vcd"
    "$source/tools/python" "$here/same.py" "$work/captured.vcd" "$work/trace.vcd" 500
}
[ "$chip" = NETLIST ] || traced # a netlist has other signal names
# If the captured inputs are applied to a simulation of only the core, its outputs must be equal to
# the captured outputs.
"$source/tools/python" -m icesoc.cores.replay "$work/probe.vcd" \
    --scope u_sample_verilog --top sample_verilog \
    --out "$work/replay" -I "$own/gen" -I "$source/bus" \
    "$samples/sample_verilog/sample_verilog.v" "$own/gen/sample_verilog_wrapper.v"
