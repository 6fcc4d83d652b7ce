#!/bin/sh
# SPDX-License-Identifier: MIT
# orders: list folder-of-a-core...   Tests these cores. For each of the ORDERS (listed, backwards,
# shuffled by SEED), builds a chip with the cores in this order and flies it: Python calls every
# core by radio. CHIP=1: also prints the cost of each core in the listed chip.
set -eu
case ${1:-} in '' | -h | --help) sed -n '3,5s/^# //p' "$0" && exit 0 ;; esac
here=$(cd "$(dirname "$0")" && pwd)
cd "$here/../.."
source=$PWD build=build/foreign jobs=${JOBS:-$(nproc)} seed=${SEED:-1}
list=$1 tested=''
shift
names='' folders='' slices=''
for folder in "$@"; do
    folder=$(cd "$folder" && pwd) name=$(basename "$folder")
    names="$names $name"
    folders="$folders;$folder"
    [ ! -f "$folder/$name.ice" ] || slices="$slices $folder/$name.ice"
done
mkdir -p "$build"
pins=''
case "$names " in *' servo '*)
    echo "1 servo.fault_i 0" >"$build/pins" # the simulator then logs the outputs
    pins="--pins $build/pins"
    ;;
esac
cp "$list" "$build/listed.list"
tac "$build/listed.list" >"$build/backwards.list"
awk -v seed="$seed" 'BEGIN { srand(seed) } { print rand() "\t" $0 }' "$build/listed.list" |
    sort | cut -f2- >"$build/shuffled.list"
for order in ${ORDERS:-listed}; do
    echo "$order: $(cut -d' ' -f1 "$build/$order.list" | tr '\n' ' ')"
    cmake -S . -B "$build" -G Ninja "-DROOMS=bus;slice;sw;hdl;ip;testbench;synth" -DCLK_HZ=2000000 \
        "-DCORES=$source/$build/$order.list" "-DCORE_FOLDERS=${folders#;}" \
        "-DFOREIGN_CORES=$source/build/foreign-cores" >"$build/log" ||
        { cat "$build/log" && exit 1; }
    # shellcheck disable=SC2046,SC2086 # lists of words
    [ "$tested" ] || {
        tested=yes
        ninja -C "$build" -j "$jobs" --quiet $(printf 'test_ip_%s ' $names)
        ctest --test-dir "$build" --output-on-failure --no-tests=error \
            -R "^test_ip_($(echo $names | tr ' ' '|'))[.]"
    }
    ninja -C "$build" -j "$jobs" --quiet vehicle
    # shellcheck disable=SC2086 # lists of words
    "$build/testbench/sim/icesoc-sim" --size 96x64 --image "$IMAGE" --seed "$seed" --guard 20 \
        $pins --out "$build/flight" -- /usr/bin/python3 "$here/call.py" \
        '{device}' '{guard}' '{status}' "$build/ground/xbeeat:createXBeeAT" "$names" \
        sw/hw/registers/Registers.ice $slices
    [ "$pins" ] || continue
    # Measures the servo's signal at the pins: frames of 20 ms, with pulses of 1.5 ms on pin 2.
    awk '$2 != "servo.pwm_o" { next }
         $3 == 4 { frames += up && $1 - up > 19.999 && $1 - up < 20.001; up = $1 }
         $3 == 0 && up { pulses += $1 - up > 1.499 && $1 - up < 1.501; all++ }
         END { printf "servo: %d pulses, %d of 1.5 ms, %d frames of 20 ms at the pins\n",
                   all, pulses, frames
               exit pulses < 5 || pulses != all || frames < all - 2 }' "$build/flight/pins.log"
done
[ -z "${CHIP:-}" ] || {
    ninja -C "$build" -j "$jobs" --quiet synth_inputs
    # shellcheck disable=SC2046,SC2086 # lists of words
    "$build/synth/utilisation" --generated "$build/gen" --output "$build/report" --jobs "$jobs" \
        --design soc $(printf -- '--core %s ' $names)
}
