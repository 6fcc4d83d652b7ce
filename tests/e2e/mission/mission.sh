#!/bin/sh
# SPDX-License-Identifier: MIT
# mission: source-folder build-folder case out-folder
set -eu
source=$1 build=$2 case=$3 out=$4
rm -rf "$out"
mkdir -p "$out"
image=/usr/share/xplanet/images/earth.jpg
export XDG_CONFIG_HOME="$build/config" # keys of the tests' own
keys=$XDG_CONFIG_HOME/icesoc
# The modem's default guard time of a second passes four times: only cases that test it use it.
guard=20
case $case in plain | stopped) guard=1000 ;; esac
run() { # out-folder, then options
    to=$1
    shift
    "$source/icesoc" run --built --build "$build" --out "$to" --size 96x64 --guard $guard "$@"
}
# A flight's description for a ground without a simulator.
describe() {
    printf '{"threshold": 24, "loss": 0, "guard": 20, "patience": 300, "key": "", "camera": false, "cores": [], "out": "%s"}' "$out" >"$out/flight.json"
}
check_output() {
    [ -s "$1/after.png" ] && [ -s "$1/before.png" ] && grep -q 'isAlive' "$1/report.md"
}
# The command fails, with this text and no Python traceback.
fails_with() {
    text=$1
    shift
    if "$@" >"$out/log" 2>&1; then
        cat "$out/log"
        echo "it succeeded; expected: $text"
        exit 1
    fi
    grep -q -- "$text" "$out/log" && ! grep -q Traceback "$out/log" || {
        cat "$out/log"
        echo "expected: $text"
        exit 1
    }
}
# Repeats the flight in a folder from its recording; further words are options.
replay() {
    "$build/testbench/sim/icesoc-sim" --out "$out/replay" --replay "$@"
}
# The same; its output contains this text.
replays_with() {
    text=$1
    shift
    replay "$@" >"$out/replay.log" 2>&1 && grep -q -- "$text" "$out/replay.log" || { cat "$out/replay.log" && exit 1; }
}
case $case in
plain) # secure by default; only the user may read its recording and its key
    "$source/tests/regress/test/make_in.sh" "$source" "$source" "$build" run IMAGE=$image SIZE=96x64 OUT="$out" >"$out/log" 2>&1 || { cat "$out/log" && exit 1; }
    check_output "$out"
    grep -q '121 corners leave much of the core untried: make ip-test IP=vision' "$out/log" || { cat "$out/log" && exit 1; }
    # It waits for the modem's set-up first, then for the vehicle.
    grep -o 'modem ready on .* after [0-9]* ms\|link connecting\|link up, secure\|the UAV has .* s to answer' "$out/log" | sed 's/ .*//' | tr '\n' ' ' | grep -q '^the modem link link ' || { cat "$out/log" && exit 1; }
    grep -q "\"key\":\"$keys/demo.key\"" "$out/flight.jsonl"
    [ "$(stat -c %a "$out/flight.jsonl" "$keys/demo.key" | sort -u)" = 600 ]
    ;;
open) # without encryption, by an option
    run "$out" --image $image --open; check_output "$out"
    grep -q '"key":""' "$out/flight.jsonl"
    : >"$out/any.key"
    fails_with "give one of them" run "$out" --image $image --open --key "$out/any.key"
    ;;
keys) # messages of the ground, the vehicle and their start about unfit keys
    umask 077
    echo 000102030405060708090a0b0c0d0e0f >"$out/a.key"
    echo 000102030405060708090a0b0c0d0e0e >"$out/b.key"
    echo 0001020304 >"$out/short.key" && cp "$out/a.key" "$out/others.key" && chmod 644 "$out/others.key"
    fails_with "32 hexadecimal digits" run "$out" --image $image --key "$out/short.key"
    fails_with "chmod 600" run "$out" --image $image --key "$out/others.key"
    fails_with "icesoc key '$out/no.key' makes one" run "$out" --image $image --key "$out/no.key"
    # No session with this vehicle begins with another key, or with none.
    for ground in "--XBeeAT.KeyFile=$out/b.key" --XBeeAT.KeyFile=; do
        fails_with 'Timeout' "$build/testbench/sim/icesoc-sim" --image $image --size 96x64 --out "$out" --guard $guard --key "$out/a.key" -- \
            "$build/sw/ground/ground_ping" 'hwengine1:xbee-at -d "{device}" -a 0x0001 -g {guard} -t 3000' 1 "$ground" --Ice.RetryIntervals=-1
    done
    fails_with "chmod 600" "$build/sw/ground/ground_ping" 'hwengine1:xbee-at -d /dev/null' 1 "--XBeeAT.KeyFile=$out/others.key"
    fails_with "openssl rand" "$build/sw/ground/ground_ping" 'hwengine1:xbee-at -d /dev/null' 1 "--XBeeAT.KeyFile=$out/no.key"
    ;;
loss) # again from its recording, in which a user looks for the cause
    run "$out" --image $image --loss 0.1 --seed "${SEED:-1}"; check_output "$out"
    replays_with 'bit by bit the flight that was recorded' "$out" --from 0.5 --to 0.51
    # Recordings cut short by a kill, altered, of another file, repeated into their own folder; waveforms need another build.
    mkdir "$out/cut" "$out/other"
    cp "$out/before.png" "$out/cut" && cp "$out/before.png" "$out/other"
    head -c "$(($(wc -c <"$out/flight.jsonl") / 2))" "$out/flight.jsonl" >"$out/cut/flight.jsonl"
    replays_with 'the recording ends here' "$out/cut"
    sed 's/"up":"2b/"up":"2c/' "$out/flight.jsonl" >"$out/other/flight.jsonl"
    fails_with 'not the flight that was recorded: it departs between' replay "$out/other"
    echo '{"no": "flight"}' >"$out/other/flight.jsonl"
    fails_with 'is no recording of a flight: line 1' replay "$out/other"
    fails_with 'the replay needs a folder of its own' "$build/testbench/sim/icesoc-sim" --replay "$out" --out "$out"
    fails_with "flown by the firmware's host build" replay "$out" --gdb 0
    fails_with 'writes no waveforms' replay "$out" --wave "$out/wave.fst"
    fails_with 'no flight was recorded in' "$source/icesoc" replay --built --build "$build" "$out/nowhere" --out "$out/replay"
    ;;
cores) # every core that has a part in a mission
    parts=$(cd "$source/ip" && awk '/^[^#]/ { print $1 }' cores.list | while read -r core; do [ ! -f "$core/ground.py" ] || echo "$core"; done)
    run "$out" --image $image --cores "$parts"; check_output "$out"
    for part in $parts; do grep -q "$part\." "$out/report.md" || { echo "nothing was called of $part" && exit 1; }; done
    fails_with "has no part in a mission" run "$out/none" --image $image --cores nonesuch
    ;;
sensor) # the picture goes through the camera's pins and the vision core, and never through the processor
    run "$out" --image $image --camera --cpu m3; check_output "$out"
    grep -q 'camera.capture(96, 64)' "$out/report.md"
    ;;
m3) # the ARM binary; its replay shows the program's tasks in the 2 ms around the first event of a core
    run "$out" --image $image --cpu m3; check_output "$out"
    grep -q '"task":"UAV_radioTask"' "$out/events.jsonl"
    from=$(sed -n 's/{"events":[0-9]*,"ns":\([0-9]*\)[0-9],"slot":[2-9]}/\1/p' "$out/events.jsonl" | head -1)
    export WAVE="$out/wave" WAVE_FROM="$((from - 20000))" WAVE_TO="$((from + 200000))"
    replays_with 'bit by bit the flight that was recorded' "$out" --from 0.5 --to 0.51
    for row in EXTI0_Handler.program.interrupt PendSV_Handler.program.function UAV_coresTask.program.task FSMC_read.*.program.function; do
        grep -q "^s$row$" "$WAVE.program.vcd" || { cat "$WAVE.program.vcd" && echo "expected: $row" && exit 1; }
    done
    ;;
other_chip) # firmware built for other registers of the vision core: it does not serve the core and tells the ground why
    cp "$build/firmware/uav.elf" "$out/other.elf"
    # Its line in the table, from 1 on; a row has 20 bytes, the hash is its last four.
    row=$(sed -n '/hw_contracts\[/,$p' "$build/gen/soc_cores.c" | sed 1d | grep -n '"vision"' | cut -d: -f1)
    at=$(arm-none-eabi-nm "$out/other.elf" | sed -n 's/ [RT] hw_contracts$//p')
    from=$(arm-none-eabi-objdump -h "$out/other.elf" | awk '$2 == ".text" { print "0x" $6 " - 0x" $4 }')
    printf '\377\377\377\377' | dd of="$out/other.elf" bs=1 seek=$((0x$at + $from + 20 * row - 4)) conv=notrunc 2>/dev/null
    "$build/sw/target/stamp_image" "$out/other.elf"
    fails_with "no object 'hwengine1'; vision: its registers have the hash 0x.* in the chip, 0xFFFFFFFF in the firmware: build both anew from one ip/cores.list, the firmware by make firmware" \
        run "$out" --image $image --cpu m3 --firmware "$out/other.elf"
    ;;
update) # new firmware: a wrong file, a vehicle with another key, a loss of power during it, a slot that must be erased, a crash; good and bad bitstreams
    send() { run "$out" --image $image --cpu m3 --update "$build/firmware/uav.elf"; }
    says() { grep -q -- "$1" "$out/log" || { cat "$out/log" && echo "expected: $1" && exit 1; }; }
    fails_with 'no 32-bit ARM ELF file' run "$out" --image $image --cpu m3 --update "$source/Makefile"
    "$build/sw/target/pack_update" vehicle "$build/firmware/loader.elf" "$build/firmware/uav.elf" 1 "$out/other.key" "$out/flash.bin"
    cp "$out/flash.bin" "$out/flash.was"
    fails_with "not signed with this vehicle's key" send
    cmp "$out/flash.bin" "$out/flash.was"
    head -c 50000 "$out/new.update" >"$out/cut.update"
    fails_with 'is cut short' "$source/sw/ground/clients/update.py" "$out/cut.update" --slice "$source/sw/apps/uav/Update.ice"
    "$build/sw/target/pack_update" vehicle "$build/firmware/loader.elf" "$build/firmware/uav.elf" 1 "$keys/update.key" "$out/flash.bin"
    "$build/testbench/sim/icesoc-sim" --image $image --size 96x64 --out "$out" --cpu m3 --flash "$out/flash.bin" --duration 8 -- \
        "$source/sw/ground/clients/update.py" "$out/new.update" --device '{device}' --plugin "$build/ground" \
        --slice "$source/sw/apps/uav/Update.ice" >"$out/log" 2>&1 || true
    says 'the vehicle runs version 1$'
    ! cmp -s "$out/flash.bin" "$out/flash.was" || { echo "nothing was written" && exit 1; }
    for runs in 1 2; do
        send >"$out/log" 2>&1 || { cat "$out/log" && exit 1; }
        says 'runs and is confirmed'
        says '1 software, 0 watchdog'
    done
    # 256 KiB into three full sectors, within 30 s of air.
    "$source/tests/e2e/mission/big_firmware.sh" "$build" "$out/big.elf" 262144
    "$build/sw/target/pack_update" vehicle "$build/firmware/loader.elf" "$build/firmware/uav.elf" 1 "$keys/update.key" "$out/flash.bin"
    dd if=/dev/urandom of="$out/flash.bin" bs=128K seek=4 count=3 conv=notrunc 2>/dev/null
    run "$out" --image $image --cpu m3 --update "$out/big.elf" >"$out/log" 2>&1 || { cat "$out/log" && exit 1; }
    says 'runs and is confirmed'
    awk '/sent 262144 bytes in/ { air = $7 } END { exit !(air && air <= 30) }' "$out/log" || { cat "$out/log" && exit 1; }
    # Firmware that crashes at its start: the vehicle returns to the one before by itself.
    cp "$build/firmware/uav.elf" "$out/crashes.elf"
    at=$(arm-none-eabi-nm "$out/crashes.elf" | sed -n 's/ T Firmware_run$//p')
    from=$(arm-none-eabi-objdump -h "$out/crashes.elf" | awk '$2 == ".text" { print "0x" $6 " - 0x" $4 }')
    printf '\377\336' | dd of="$out/crashes.elf" bs=1 seek=$((0x$at + $from)) conv=notrunc 2>/dev/null # UDF
    "$build/sw/target/stamp_image" "$out/crashes.elf"
    ! run "$out" --image $image --cpu m3 --update "$out/crashes.elf" >"$out/log" 2>&1 || { cat "$out/log" && exit 1; }
    says 'is signed and whole; it starts'
    says 'was started and went back'
    says '2 software, 0 watchdog'
    # Bitstreams: no bitstream at all, one that the FPGA refuses, one that nobody confirms, and one of full size.
    fails_with 'has a sync word, AA 99 55 66' run "$out" --image $image --cpu m3 --update "$build/firmware/uav.bin"
    "$build/testbench/cpu/stand_in_bitstream" "$out/new.bin" 2 10000
    cp "$out/new.bin" "$out/damaged.bin"
    printf x | dd of="$out/damaged.bin" bs=1 seek=9000 conv=notrunc 2>/dev/null
    fails_with 'the FPGA did not take it' run "$out" --image $image --cpu m3 --update "$out/damaged.bin"
    "$build/sw/target/pack_update" bitstream "$out/new.bin" "$(date +%s)" "$keys/update.key" "$out/new.update"
    "$build/testbench/sim/icesoc-sim" --image $image --size 96x64 --out "$out" --cpu m3 --flash "$out/flash.bin" --fpga-flash "$out/fpga.bin" -- \
        "$source/sw/ground/clients/update.py" "$out/new.update" --rehearse --device '{device}' --plugin "$build/ground" \
        --slice "$source/sw/apps/uav/Update.ice" >"$out/log" 2>&1 || { cat "$out/log" && exit 1; }
    says 'runs, and is not confirmed'
    says 'the vehicle runs version 1$'
    "$build/testbench/cpu/stand_in_bitstream" "$out/full.bin" 3
    for bits in new full; do
        run "$out" --image $image --cpu m3 --update "$out/$bits.bin" >"$out/log" 2>&1 || { cat "$out/log" && exit 1; }
        says 'runs and is confirmed'
    done
    ;;
cpp) # the C++11 library of the plugin, a C++ client, and a proxy that goes through its string form
    "$build/testbench/sim/icesoc-sim" --image $image --size 96x64 --out "$out" --guard $guard -- \
        "$build/sw/ground/ground_ping" 'hwengine1:xbee-at -d "{device}" -a 0x0001 -p 2 -g {guard} -t 300000' 3 >"$out/log" 2>&1 || { cat "$out/log" && exit 1; }
    grep -q 'it is a ::Autopilot::HwProcessingEngine' "$out/log"
    grep -q -- '-a 0x1 .*-p 2' "$out/log"
    ;;
slow) # a machine that is four times too slow: the ground uses the simulator's clock, so it finds the modem as fast
    run "$out" --image $image >"$out/log" 2>&1 || { cat "$out/log" && exit 1; } # for its flight.json
    rm "$out/after.png"
    "$build/testbench/sim/icesoc-sim" --flight "$out/flight.json" --speed 0.25 -- \
        /usr/bin/python3 "$source/sw/ground/clients/mission.py" "$out/flight.json" --device '{device}' --frame '{frame}' --status '{status}' \
        --plugin "$build/ground" --slice "$source/sw/apps/uav/Autopilot.ice" --trace 2 >"$out/log" 2>&1 || { cat "$out/log" && exit 1; }
    [ "$(grep -c '+++ at' "$out/log")" = 2 ] || { cat "$out/log" && exit 1; }
    check_output "$out"
    ;;
stopped) # the ground's program is stopped for four seconds during the set-up: simulated time waits for it
    "$build/testbench/sim/icesoc-sim" --image $image --size 96x64 --out "$out" --guard $guard -- \
        "$build/sw/ground/ground_ping" 'hwengine1:xbee-at -d "{device}" -a 0x0001 -t 300000' 3 --XBeeAT.Trace=2 >"$out/log" 2>&1 &
    sim=$!
    while ! grep -q '+++ at 9600 baud: OK' "$out/log"; do
        kill -0 $sim || { cat "$out/log" && exit 1; }
        sleep 0.02
    done
    ground=$(pgrep -P $sim)
    kill -STOP "$ground"
    sleep 4
    kill -CONT "$ground"
    wait $sim || { cat "$out/log" && exit 1; }
    simulated=$(sed -n 's/.*: \([0-9.]*\) s simulated.*/\1/p' "$out/log")
    awk "BEGIN { exit !($simulated < 5) }" || { cat "$out/log" && exit 1; }
    ;;
encrypted) # both modems by the same AES key: the controller sets one, the endpoint's -k the other
    key=00112233445566778899AABBCCDDEEFF
    "$build/testbench/sim/icesoc-sim" --image $image --size 96x64 --out "$out" --modem-key $key --guard $guard -- \
        "$build/sw/ground/ground_ping" "hwengine1:xbee-at -d \"{device}\" -a 0x0001 -k $key -g {guard} -t 60000" 3 >"$out/log" 2>&1 || { cat "$out/log" && exit 1; }
    grep -q 'it is a ::Autopilot::HwProcessingEngine' "$out/log"
    ! grep -q $key "$out/log" || { echo "the key is in the output" && exit 1; }
    ;;
new_key) # a key follows another over the link, and the old one opens nothing any more
    (umask 077 && echo 0x0001 000102030405060708090a0b0c0d0e0f >"$out/the.key")
    "$build/testbench/sim/icesoc-sim" --image $image --size 96x64 --out "$out" --guard $guard --key "$out/the.key" -- \
        /usr/bin/python3 "$source/sw/ground/clients/change_key.py" --device '{device}' --guard '{guard}' --key "$out/the.key" \
        --plugin "$build/ground" --slice "$source/sw/apps/uav/Autopilot.ice" >"$out/log" 2>&1 || { cat "$out/log" && exit 1; }
    grep -q 'have a new key' "$out/log" && [ "$(stat -c %a "$out/the.key")" = 600 ]
    grep -Eq '^0x0001 [0-9a-f]{32}$' "$out/the.key" && ! grep -q 000102030405 "$out/the.key"
    ;;
gateway) # two stock clients at once, through TCP
    "$build/testbench/sim/icesoc-sim" --image $image --size 96x64 --out "$out" --guard $guard -- \
        "$source/tests/e2e/mission/gateway.sh" "$build" '{device}' '{guard}' "$out" >"$out/log" 2>&1 || { cat "$out/log" && exit 1; }
    ;;
twice)
    run "$out/a" --image $image >"$out/a.log" 2>&1 &
    first=$!
    run "$out/b" --image $image --threshold 50
    wait $first || { cat "$out/a.log" && exit 1; }
    check_output "$out/a" && check_output "$out/b"
    ;;
odd_names) # a folder's name has special characters of the shell, of make and of the simulator
    odd="$out/a'b \"c\" {device} {out}x \`touch $out/oops\` \$(touch $out/oops)"
    run "$odd" --image $image; check_output "$odd"
    [ ! -e "$out/oops" ]
    ;;
picture_bad)
    mkdir "$out/mine" && echo mine >"$out/mine/report.md" && ln -s "$out/mine/report.md" "$out/calls.jsonl" && cp "$out/mine/report.md" "$out"
    echo "this is no picture" >"$out/bad.png"
    fails_with "is no picture that can be read" run "$out" --image "$out/bad.png"
    if grep 127.0.0.1 "$out/log"; then echo "a page's address before what is refused" && exit 1; fi
    # A refused start changes nothing in the folder.
    [ "$(cat "$out/report.md" "$out/calls.jsonl")" = "$(printf 'mine\nmine')" ]
    fails_with "WIDTHxHEIGHT, 8x8 to 1024x4096, WIDTH a multiple of 8, not '333x111'" run "$out" --image $image --size 333x111
    fails_with "not '96x64k'" run "$out" --image $image --size 96x64k
    ;;
device_missing)
    describe
    fails_with "cannot open serial port '/dev/no-such-port'" /usr/bin/python3 "$source/sw/ground/clients/mission.py" "$out/flight.json" \
        --device /dev/no-such-port --plugin "$build/ground" --slice "$source/sw/apps/uav/Autopilot.ice" --frame none
    ;;
modem_silent)
    # Only this shell's sleep holds the pty: no modem answers.
    describe
    fails_with "no modem answers on" /usr/bin/python3 -c '
import os, pty, subprocess, sys
master, slave = pty.openpty()
sys.exit(subprocess.call(sys.argv[1:] + ["--device", os.ttyname(slave)]))' \
        /usr/bin/python3 "$source/sw/ground/clients/mission.py" "$out/flight.json" --plugin "$build/ground" \
        --slice "$source/sw/apps/uav/Autopilot.ice" --frame none
    ;;
interrupted)
    run "$out" --image $image >"$out/log" 2>&1 &
    pid=$!
    while ! grep -q "setting the ground" "$out/log" 2>/dev/null; do
        kill -0 $pid || { cat "$out/log" && exit 1; }
        sleep 0.1
    done
    if run "$out" --image $image >"$out/second" 2>&1; then echo "a second flight in one folder" && exit 1; fi
    grep -q 'another flight is under way' "$out/second" || { cat "$out/second" && exit 1; }
    pkill -INT -f "icesoc-sim.*$out" # the simulator; Ctrl-C would reach all of them
    status=0
    wait $pid || status=$?
    [ $status = 130 ] || { cat "$out/log"; echo "exit status $status; expected 130"; exit 1; }
    # The command that it prints shows its end.
    span=$(sed -n "s#^Its end as a waveform: make run REPLAY='$out' FROM=\([0-9.]*\) TO=\([0-9.]*\)\$#\1 --to \2#p" "$out/log")
    # shellcheck disable=SC2086 # words
    replays_with 'the recording ends here\|bit by bit' "$out" --from ${span:?nothing is offered}
    ! pgrep -f "mission.py.*$out" || { echo "the ground station still runs" && exit 1; }
    ;;
esac
