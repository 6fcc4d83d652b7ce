#!/bin/sh
# SPDX-License-Identifier: MIT
#
# table: flash and RAM of a firmware by layer, from the linker's map; stacks by analysis of the call graph.
# Usage: table.sh firmware.map folder-of-objects output.json

set -eu
[ $# = 3 ] || {
    echo "usage: table.sh firmware.map folder-of-objects output.json" >&2
    exit 2
}
map=$1 objects=$2 json=$3
mkdir -p "$(dirname "$json")"
awk -v json="$json" '
function number(hex,   i, n) { # mawk has no strtonum
    n = 0
    for (i = 3; i <= length(hex); ++i)
        n = n * 16 + index("0123456789abcdef", tolower(substr(hex, i, 1))) - 1
    return n
}
function layerOf(file,   n, part, folder) {
    if (file !~ /\.arm\//)
        return "C library"
    n = split(file, part, "/")
    folder = part[n - 1]
    if (folder in title)
        return title[folder]
    return folder
}
BEGIN {
    title["uav"] = "application"; title["Autopilot"] = "generated stubs"; title["endpoints"] = "icec, xbee-at endpoint"
    title["m3"] = "os"; title["GNU"] = title["Source"] = title["ARMv7-M"] = "uC/OS-II"
}
/^Linker script and memory map/ { begun = 1 }
begun && /^ \.(text|rodata|data|bss|vectors|noinit)/ {
    section = $1
    if (NF == 1) { getline; at = 1 } else at = 2
    address = number($at); size = number($(at + 1)); file = $(at + 2)
    if (address == 0 || size == 0) next
    layer = layerOf(file)
    if (!(layer in seen)) { seen[layer] = 1; names[++count] = layer }
    if (section !~ /^\.(bss|noinit)/) flash[layer] += size
    if (section ~ /^\.(bss|noinit|data)/) ram[layer] += size
}
END {
    printf "%-26s %8s %8s\n", "layer", "flash", "RAM"
    printf "[" >json
    for (i = 1; i <= count; ++i) {
        layer = names[i]
        printf "%-26s %8d %8d\n", layer, flash[layer], ram[layer]
        printf "%s{\"name\": \"flash: %s\", \"value\": %d, \"unit\": \"bytes\", \"command\": \"make firmware\"},\n", (i > 1 ? ",\n" : ""), layer, flash[layer] >json
        printf "{\"name\": \"RAM: %s\", \"value\": %d, \"unit\": \"bytes\", \"command\": \"make firmware\"}", layer, ram[layer] >json
        allFlash += flash[layer]; allRam += ram[layer]
    }
    printf "]\n" >json
    printf "%-26s %8d %8d   bytes, stacks of tasks included in RAM\n", "all", allFlash, allRam
}' "$map"
echo
# Deepest stack below each task: frames (-fstack-usage) along the call graph (-fcallgraph-info).
find "$objects" -name '*.ci' -exec cat {} + | awk '
function tail(s) { sub(/.*:/, "", s); return s }
/^node:/ {
    match($0, /title: "[^"]*"/); t = tail(substr($0, RSTART + 8, RLENGTH - 9))
    if (match($0, /[0-9]+ bytes/)) { split(substr($0, RSTART, RLENGTH), b, " "); bytes[t] = b[1] }
}
/^edge:/ {
    match($0, /sourcename: "[^"]*"/); s = tail(substr($0, RSTART + 13, RLENGTH - 14))
    match($0, /targetname: "[^"]*"/); d = tail(substr($0, RSTART + 13, RLENGTH - 14))
    if (!((s, d) in edge)) { edge[s, d] = 1; out[s] = out[s] " " d }
}
function depth(f,   i, n, part, most, d, name) {
    if (f in known) return known[f]
    if (f in busy) { loops[f] = 1; return 0 }
    busy[f] = 1
    most = 0
    n = split(out[f], part, " ")
    for (i = 1; i <= n; ++i) {
        if (part[i] == "__indirect_call") { indirect[f] = 1; continue }
        d = depth(part[i])
        if (d > most) { most = d; deepest[f] = part[i] }
    }
    delete busy[f]
    return known[f] = bytes[f] + most
}
END {
    printf "%-26s %8s   %s\n", "stack, by analysis", "bytes", "deepest way (calls through pointers and of the C library are not followed)"
    m = split("UAV_radioTask appMainTask clientTask watchTask idleTask EXTI0_Handler SysTick_Handler", entry, " ")
    for (i = 1; i <= m; ++i) {
        way = ""
        total = depth(entry[i])
        for (f = entry[i]; f in deepest; f = deepest[f]) way = way " > " deepest[f]
        printf "%-26s %8d   %s\n", entry[i], total, substr(way, 4)
    }
}'
echo "Written: $json"
