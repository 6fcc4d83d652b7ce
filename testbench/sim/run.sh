#!/bin/sh
# SPDX-License-Identifier: MIT
#
# run: the mission: simulator and ground station. Usage: run.sh build-folder --image F --size WxH
#      --threshold N --loss P --seed N --out DIR --cpu host|m3 --firmware ELF --port N (of the live page; 0: any)
#      --guard MS (of the modems) --patience S (for the first answer of the UAV) --live 1 (the page stays until Ctrl-C) --cores "ascon fir" (also fly these cores' parts, ip/*/ground.py)
#      --pins FILE (drives the inputs of cores, docs/simulation.md; outputs go to DIR/pins.log)
#      --update ELF|BIT|BIN (sends this firmware, or this bitstream, to a vehicle whose flash is DIR/flash.bin, and its
#      FPGA's DIR/fpga.bin; both are made if there are none; by --cpu m3)
#      --app uav|minimal (the program of Table II, by --cpu m3)
#      --key FILE (the link's, of vehicle and ground; none: that of build/demo.key, made once) --open 1 (in the clear)
#      --sensor 1 (the picture comes through the camera core, which hands it to the vision core; camera's part is flown)

set -eu
build=$1
shift
here=$(cd "$(dirname "$0")/../.." && pwd)
image='' size=320x240 threshold=24 loss=0 seed=1 out=build/run cpu=host app=uav guard=1000 patience=300 port=0 live='' cores='' sensor='' pins='' key='' open='' update='' firmware=$build/firmware/uav.elf
while [ $# -gt 0 ]; do
    case $1 in
    --image) image=$2 ;;
    --size) size=$2 ;;
    --threshold) threshold=$2 ;;
    --loss) loss=$2 ;;
    --seed) seed=$2 ;;
    --out) out=$2 ;;
    --cpu) cpu=$2 ;;
    --app) app=$2 ;;
    --port) port=$2 ;;
    --guard) guard=$2 ;;
    --patience) patience=$2 ;;
    --live) live=$2 ;;
    --cores) cores=$2 ;;
    --sensor) sensor=${2:+--sensor} ;;
    --pins) pins=$2 ;;
    --key) key=$2 ;;
    --open) open=$2 ;;
    --firmware) firmware=$2 ;;
    --update) update=$2 ;;
    *)
        echo "run: unknown option $1" >&2
        exit 2
        ;;
    esac
    shift 2
done
refuse() {
    echo "run: $*" >&2
    exit 2
}
number() { expr "x$1" : 'x[0-9]\{1,18\}$' >/dev/null; }
number "$threshold" && [ "$threshold" -le 255 ] || refuse "THRESHOLD is 0..255 grey levels, not '$threshold'"
number "$seed" || refuse "SEED is a whole number, not '$seed'"
number "$port" && [ "$port" -le 65535 ] || refuse "PORT is 0..65535, and 0 is any, not '$port'"
echo "$loss" | grep -Eqx '0?\.[0-9]+|[01](\.0*)?' || refuse "LOSS is the share of packets that is lost, 0..1, not '$loss'"
case $cpu in host | m3) ;; *) refuse "CPU is host or m3, not '$cpu'" ;; esac
[ -z "$open" ] || [ -z "$key" ] || refuse "OPEN=1 flies in the clear, KEY='$key' does not: give one of them"
if [ -z "$open$key" ] && [ "$app" = uav ]; then
    key=$(dirname "$build")/demo.key
    if [ ! -e "$key" ]; then
        new=$(mktemp "$key.XXXXXX") # mode 0600
        od -An -vtx1 -N16 /dev/urandom | tr -d ' \n' >"$new"
        ! ln "$new" "$key" 2>/dev/null || echo "run: made a demo key, $key: ground and vehicle share it; KEY=file takes yours, OPEN=1 none"
        rm -f "$new"
    fi
fi
case $pins in '') ;; *) [ -r "$pins" ] || refuse "cannot read PINS='$pins'" ;; esac
mkdir -p "$out" 2>/dev/null && [ -w "$out" ] || refuse "OUT='$out' is no folder into which a flight can be written"
exec 9>"$out/lock" # until the last program of this flight has ended
flock -n 9 || { echo "run: another flight is under way in $out; give this one a folder of its own: OUT=build/other" >&2 && exit 1; }
case $app:$cpu in
uav:*) ;;
minimal:m3)
    exec setpriv --pdeathsig TERM "$build/testbench/sim/icesoc-sim" --image "$image" --size "$size" --loss "$loss" --seed "$seed" --out "$out" --cpu m3 \
        --guard "$guard" --firmware "$build/firmware/minimal.elf" -- /usr/bin/python3 "$here/sw/apps/minimal/ground.py" '{device}' \
        --frame '{frame}' --reference "$build/testbench/sim/vision-reference" "--Ice.Plugin.XBeeAT=$build/ground/xbeeat:createXBeeAT" \
        '--XBeeAT.Guard={guard}'
    ;;
minimal:*) refuse "the minimal program is an ARM binary: give CPU=m3" ;;
*) refuse "there is no program '$app': uav, minimal" ;;
esac
if [ -n "$update" ]; then
    pack=$build/sw/target/pack_update
    signing=$build/update.key # private, made at first use
    [ -f "$out/flash.bin" ] || "$pack" vehicle "$build/firmware/loader.elf" "$firmware" 1 "$signing" "$out/flash.bin"
    if [ ! -f "$out/fpga.bin" ]; then # no ISE here: the golden bitstream stands in for one
        "$build/testbench/cpu/stand_in_bitstream" "$out/golden.bin" 1 10000
        "$pack" fpga "$out/golden.bin" 1 "$signing" "$out/fpga.bin"
    fi
    case $update in
    *.bit | *.bin) kind=bitstream ;;
    *) kind=image ;;
    esac
    "$pack" $kind "$update" "$(date +%s)" "$signing" "$out/new.update"
    exec setpriv --pdeathsig TERM "$build/testbench/sim/icesoc-sim" --image "$image" --size "$size" --loss "$loss" --seed "$seed" --out "$out" \
        --cpu m3 --firmware "$firmware" --flash "$out/flash.bin" --fpga-flash "$out/fpga.bin" ${key:+--key "$key"} -- /usr/bin/python3 "$here/sw/ground/clients/update.py" "$out/new.update" \
        --device '{device}' --status '{status}' --plugin "$build/ground" --slice "$here/sw/apps/uav/Update.ice" --patience "$patience" ${key:+--key "$key"}
fi
parts=''
[ -z "$sensor" ] || case " $cores " in *' camera '*) ;; *) cores="$cores camera" ;; esac
case ${PROBE:+x}" $cores " in x*' probe '* | ' '*) ;; *) refuse "PROBE='$PROBE' is a trigger of a probe: CORES=probe" ;; esac
listed=$(sed -n 's/^CORES:[A-Z]*=//p' "$build/CMakeCache.txt")
for core in $cores; do
    [ -f "$here/ip/$core/ground.py" ] || refuse "core '$core' has no part in a mission: there is no ip/$core/ground.py"
    # A core that is in the tree and not in the chip would be a missing object, minutes from now.
    grep -Eq "^[[:space:]]*$core([[:space:]#]|\$)" "$listed" || {
        echo "run: the chip has no core '$core': it needs a line '$core' in $listed" >&2
        exit 1
    }
    parts="$parts --core $here/ip/$core"
done
# Each process ends with the one that started it, however that ends.
serve() { exec setpriv --pdeathsig TERM /usr/bin/python3 "$here/testbench/live/live.py" --dir "$out" --port "$port" --registers "$build/gen/registers.list" "$@"; }
(serve --try) || exit 1
flown() { stat -c '%i %z' "$out/status" 2>/dev/null || true; }
before=$(flown)
# shellcheck disable=SC2086 # a list of words
setpriv --pdeathsig TERM "$build/testbench/sim/icesoc-sim" --image "$image" --size "$size" --loss "$loss" --seed "$seed" --out "$out" --cpu "$cpu" --guard "$guard" --firmware "$firmware" $sensor ${pins:+--pins "$pins"} ${key:+--key "$key"} -- \
    /usr/bin/python3 "$here/sw/ground/clients/mission.py" --device '{device}' --frame '{frame}' \
    --status '{status}' --guard '{guard}' --out '{out}' --patience "$patience" --plugin "$build/ground" --slice "$here/sw/apps/uav/Autopilot.ice" \
    --reference "$build/testbench/sim/vision-reference" --threshold "$threshold" --loss "$loss" ${key:+--key "$key"} $sensor $parts &
sim=$!
stop() { # exit status
    echo "run: stopped before the mission was over" >&2
    kill $sim 2>/dev/null || true
    wait $sim || true
    exit "$1"
}
trap 'stop 130' INT
trap 'stop 143' TERM HUP
# The page begins when the simulator has accepted its options: an address would hide its error.
while [ "$(flown)" = "$before" ] && kill -0 $sim 2>/dev/null; do sleep 0.05; done
page=''
trap 'kill $page 2>/dev/null || true' EXIT
if kill -0 $sim 2>/dev/null; then
    serve &
    page=$!
fi
status=0
wait $sim || status=$?
if [ $status = 0 ]; then
    echo "Pictures and report: $out/before.png $out/after.png $out/report.md"
elif [ $status -gt 128 ]; then
    echo "The mission failed: the simulator, or the ground's program, was ended by signal $((status - 128))." >&2
else
    echo "The mission failed (exit status $status)." >&2
fi
if [ $status != 0 ] && [ "$(flown)" != "$before" ]; then # the last checkpoint that is 10 ms before its end, or more
    span=$(sed -n 's/.*"digest".*"ns":\([0-9]*\).*/\1 checkpoint/p; s/.*"ns":\([0-9]*\).*/\1/p' "$out/flight.jsonl" |
        awk '{ end = $1 } $2 { before = last; last = $1 } END { if (end - last > 1e7) before = last; printf "FROM=%.3f TO=%.3f", before / 1e9, end / 1e9 }')
    echo "Its end as a waveform: make run REPLAY='$out' $span" >&2
    [ "$cpu" != m3 ] || echo "Its end, and backwards from there: make gdb REPLAY='$out'" >&2
fi
if [ -n "$live" ] && [ $status = 0 ]; then
    echo "The page stays until Ctrl-C."
    trap 'echo "The page is closed."; exit 0' INT TERM
    wait $page
fi
exit $status
