#!/bin/sh
# SPDX-License-Identifier: MIT
# cores: source-folder build-folder work-folder   Builds a simulator with the cores of a list of its own, and calls them by radio.
set -eu
source=$1 build=$2 work=$3
mkdir -p "$work/build"
# Puts fresh/NAME in the place of NAME if they differ: what is as it was is not built again.
fresh() { diff -r "$work/fresh/$1" "$work/$1" >/dev/null 2>&1 || { rm -rf "${work:?}/$1" && mv "$work/fresh/$1" "$work/$1"; }; }
rm -rf "$work/fresh" && mkdir "$work/fresh"
{
    echo '# No vision core here.'
    echo sample_verilog
    echo 'sample_vhdl identity=newcomer slot=9'
    echo scaler
    echo 'servo fault_i=@B4'
    echo crc32
    echo 'my_port name=port'
    echo 'my_requests clock=6/25'
    echo my_lamps
    echo many
    echo 'probe signals=u_sample_verilog.bus_valid_i,u_sample_verilog.bus_write_i,u_sample_verilog.bus_addr_i:4,u_sample_verilog.bus_wdata_i:32,u_sample_verilog.bus_ready_o,u_sample_verilog.bus_rdata_o:32'
} >"$work/fresh/cores.list"
fresh cores.list
samples=$build/tests/ip/new
foreign=$build/tests/ip/new_foreign
folders="$samples/sample_verilog;$samples/sample_vhdl;$source/tests/e2e/cores/scaler;$source/tests/e2e/cores/servo;$source/tests/e2e/cores/crc32;$source/tests/e2e/cores/many;$foreign/my_port;$foreign/my_requests;$work/my_lamps"
# A core in VHDL, as make new-foreign puts it into a slot. GHDL is fetched once.
GHDL=$build/ghdl/ghdl "$source/ip/new_foreign.py" my_lamps lamps own "$work/fresh/my_lamps" LIBRARY=lights PARAM:lamps_lit=4 read=request_rd write=request_wr address=request_a wdata=request_d rdata=q \
    "$source/tests/ip/new_foreign/lamps.vhd" "$source/tests/ip/new_foreign/lamps_types.vhd" >"$work/log" || { cat "$work/log" && exit 1; }
fresh my_lamps
[ -e "$work/build/ghdl" ] || ln -s "$build/ghdl" "$work/build/ghdl"
# CLK_HZ: the servo core counts in every clock, so no clock is skipped. TRACE: the probe is compared
# with it.
cmake -S "$source" -B "$work/build" -G Ninja -DTRACE=ON -DCLK_HZ=2000000 "-DCORES=$work/cores.list" "-DCORE_FOLDERS=$folders" \
    "-DROOMS=bus;slice;ip;sw;hdl;testbench" >"$work/build.log" 2>&1 &&
    ninja -C "$work/build" icesoc-sim firmware_uav test_ip_servo test_ip_crc32 test_ip_my_lamps >>"$work/build.log" 2>&1 || { tail -40 "$work/build.log" && exit 1; }
ctest --test-dir "$work/build" --output-on-failure --no-tests=error -R '^test_ip_(servo|crc32|my_lamps)[.]' >"$work/log" 2>&1 || { cat "$work/log" && exit 1; }
echo '1000 servo.fault_i 1 # milliseconds' >"$work/pins"
echo '1001 servo.fault_i 0' >>"$work/pins"
echo '500 port.port_in_i 0x83' >>"$work/pins"
"$work/build/testbench/sim/icesoc-sim" --pins "$work/pins" --size 96x64 --image /usr/share/xplanet/images/earth.jpg --out "$work" --seed "${SEED:-1}" --guard 20 -- \
    /usr/bin/python3 "$source/tests/e2e/cores/client.py" '{device}' '{guard}' '{status}' "$build/ground/xbeeat:createXBeeAT" \
    "$work" "$samples/sample_verilog/sample_verilog.ice" "$source/tests/slice/hardware/golden/scaler.ice" "$source/tests/slice/hardware/golden/many.ice" "$source/tests/e2e/cores/servo/servo.ice" "$source/tests/e2e/cores/crc32/crc32.ice" "$samples/sample_vhdl/sample_vhdl.ice" \
    "$source/sw/hw/registers/Registers.ice" "$source/ip/probe/Probe.ice" \
    >"$work/log" 2>&1 || { cat "$work/log" && exit 1; }
# Pulses of 1.5 ms, 20 ms apart, whatever the clock; the fault pin ended at most one of them, and
# moved the later ones.
awk '$2 == "servo.pwm_o" && $3 == 4 { frames += up && $1 - last > 19.999 && $1 - last < 20.001; last = up = $1 }
     $2 == "servo.pwm_o" && $3 == 0 && up { n += $1 - up > 1.499 && $1 - up < 1.501; all++ }
     END { exit !(n > 10 && all - n <= 1 && frames >= n - 2) }' "$work/pins.log" || { tail "$work/pins.log" && echo 'the pulses are not 1.5 ms long, 20 ms apart' && exit 1; }
grep -q "'my_requests' moves in nearly every clock" "$work/log" || { cat "$work/log" && echo 'who keeps the chip from being quiet is not said' && exit 1; }
grep -q 'cores: all as expected' "$work/log" || { cat "$work/log" && exit 1; }

# The probe's capture by radio, read by GTKWave's tools, equals the simulator's trace of the
# replayed flight, as far as that goes.
vcd2fst "$work/probe.vcd" "$work/probe.fst" >"$work/log"
fst2vcd "$work/probe.fst" >"$work/captured.vcd"
span=$(awk '/^#/ { t = substr($1, 2) / 1e9; if (!n++) first = t } END { printf "--from %.6f --to %.6f", first - 2e-5, t + 2e-5 }' "$work/probe.vcd")
mkdir -p "$work/begin" && cp "$work/before.png" "$work/begin"
awk -v end="${span##* }" -F '"ns":' 'NR > 1 && $2 / 1e9 > end + 0.1 { exit } 1' "$work/flight.jsonl" >"$work/begin/flight.jsonl"
# shellcheck disable=SC2086 # options
"$work/build/testbench/sim/icesoc-sim" --replay "$work/begin" --out "$work/again" --wave "$work/trace.fst" $span >"$work/log" 2>&1 || { cat "$work/log" && exit 1; }
fst2vcd "$work/trace.fst" >"$work/trace.vcd"
"$source/tests/e2e/cores/same.py" "$work/captured.vcd" "$work/trace.vcd" 500
# Its inputs, given to the core alone, bring forth its outputs.
"$source/ip/probe/replay.py" "$work/probe.vcd" --scope u_sample_verilog --top sample_verilog --out "$work/replay" -I "$work/build/gen" -I "$source/bus" \
    "$samples/sample_verilog/sample_verilog.v" "$work/build/gen/sample_verilog_wrapper.v"
