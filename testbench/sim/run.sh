#!/bin/sh
# SPDX-License-Identifier: MIT
#
# run: the mission: simulator and ground station. Usage: run.sh build-folder --image F --size WxH
#      --threshold N --loss P --seed N --out DIR --cpu host|m3 --firmware ELF --port N (of the live page; 0: any)
#      --guard MS (of the modems) --live 1 (the page stays until Ctrl-C) --cores "ascon fir" (also fly these cores' parts, ip/*/ground.py)
#      --sensor 1 (the picture comes through the camera core, which hands it to the vision core; camera's part is flown)

set -eu
build=$1
shift
here=$(cd "$(dirname "$0")/../.." && pwd)
image='' size=320x240 threshold=24 loss=0 seed=1 out=build/run cpu=host guard=1000 port=0 live='' cores='' sensor='' firmware=$build/firmware/uav.elf
while [ $# -gt 0 ]; do
    case $1 in
    --image) image=$2 ;;
    --size) size=$2 ;;
    --threshold) threshold=$2 ;;
    --loss) loss=$2 ;;
    --seed) seed=$2 ;;
    --out) out=$2 ;;
    --cpu) cpu=$2 ;;
    --port) port=$2 ;;
    --guard) guard=$2 ;;
    --live) live=$2 ;;
    --cores) cores=$2 ;;
    --sensor) sensor=${2:+--sensor} ;;
    --firmware) firmware=$2 ;;
    *)
        echo "run: unknown option $1" >&2
        exit 2
        ;;
    esac
    shift 2
done
mkdir -p "$out"
rm -f "$out/after.png" "$out/report.md" "$out/report.json" "$out/calls.jsonl" "$out/status"
parts=''
[ -z "$sensor" ] || case " $cores " in *' camera '*) ;; *) cores="$cores camera" ;; esac
listed=$(sed -n 's/^CORES:[A-Z]*=//p' "$build/CMakeCache.txt")
for core in $cores; do
    # A core that the tree has and the chip does not would be an object that does not exist, minutes from now.
    [ ! -d "$here/ip/$core" ] || grep -Eq "^[[:space:]]*$core([[:space:]#]|\$)" "$listed" || {
        echo "run: the chip has no core '$core': it needs a line '$core' in $listed" >&2
        exit 1
    }
    parts="$parts --core $here/ip/$core"
done
"$build/testbench/live/icesoc-live" --dir "$out" --port "$port" --registers "$build/gen/registers.list" &
page=$!
trap 'kill $page 2>/dev/null || true' EXIT
# The simulator has Ctrl-C, too, and ends first. A shell that a signal ends itself would leave the page behind.
trap 'echo "run: stopped before the mission was over" >&2; exit 130' INT
trap 'echo "run: stopped before the mission was over" >&2; exit 143' TERM
status=0
# shellcheck disable=SC2086 # a list of words
"$build/testbench/sim/icesoc-sim" --image "$image" --size "$size" --loss "$loss" --seed "$seed" --out "$out" --cpu "$cpu" --guard "$guard" --firmware "$firmware" $sensor -- \
    /usr/bin/python3 "$here/sw/ground/clients/mission.py" --device '{device}' --frame '{frame}' \
    --status '{status}' --guard '{guard}' --out "$out" --plugin "$build/ground" --slice "$here/sw/apps/uav/Autopilot.ice" \
    --reference "$build/testbench/sim/vision-reference" --threshold "$threshold" --loss "$loss" $sensor $parts || status=$?
if [ $status = 0 ]; then
    echo "Pictures and report: $out/before.png $out/after.png $out/report.md"
else
    echo "The mission failed (exit status $status)." >&2
fi
if [ -n "$live" ] && [ $status = 0 ]; then
    echo "The page stays until Ctrl-C."
    trap 'echo "The page is closed."; exit 0' INT TERM
    wait $page
fi
exit $status
