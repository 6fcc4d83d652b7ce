#!/bin/sh
# SPDX-License-Identifier: MIT
#
# bench: speed of the simulator: clocks of the SoC a second, three runs. Usage: bench.sh icesoc-sim output.json
set -eu
sim=$1 json=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
best=0
for run in 1 2 3; do
    speed=$("$sim" --image /usr/share/xplanet/images/earth.jpg --speed max --duration 5 --out "$work" |
        sed -n 's/.* \([0-9.]*\) million clocks.*/\1/p')
    echo "run $run: $speed million clocks/s"
    best=$(echo "$best $speed" | awk '{print ($1 > $2) ? $1 : $2}')
done
mkdir -p "$(dirname "$json")"
echo "[{\"name\": \"simulator speed\", \"value\": $best, \"unit\": \"million clocks/s, at least\", \"limit\": 1.5, \"share\": $(echo "$best" | awk '{print $1 / 1.5}'), \"command\": \"make bench\"}]" >"$json"
echo "best $best million clocks/s; 1.5 is wanted, 2.0 is real time. Written: $json"
