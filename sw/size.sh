#!/bin/sh
# SPDX-License-Identifier: MIT
#
# size: bytes of each firmware layer on a Cortex-M3 at -Os, beside the paper's Table II; RAM and stack;
# against the budget, which a layer may not exceed.
#
# minimal: the program that flies (sw/apps/minimal, firmware/minimal.elf), with the minimal run time and link; of each layer what
# is in the image (text and read-only data; the C library and generated code are not counted, as in the paper).
# full: everything that the layer's files hold, linked or not.
#
# Usage: size.sh source-folder generated-folder build-folder output.json

set -eu
[ $# = 4 ] || {
    echo "usage: size.sh source-folder generated-folder build-folder output.json" >&2
    exit 2
}
source=$(cd "$1" && pwd) gen=$(cd "$2" && pwd) build=$(cd "$3" && pwd) json=$4
map=$build/firmware/minimal.map
for tool in arm-none-eabi-gcc awk; do
    command -v $tool >/dev/null || {
        echo "size: $tool is missing; run 'make setup'" >&2
        exit 1
    }
done
[ -f "$gen/slice/Autopilot/Autopilot.h" ] || {
    echo "size: $gen/slice/Autopilot/Autopilot.h is missing; build the target Autopilot_types first" >&2
    exit 1
}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT TERM HUP
target="-mcpu=cortex-m3 -mthumb"
includes="-I$gen -I$gen/slice/Autopilot"
for d in base os os/host fsmc radio crypto link icec icec/endpoints; do includes="$includes -I$source/sw/$d"; done
layers='fsmc radio crypto link icec endpoint'

compile() { # folder, sources and definitions
    mkdir "$work/$1"
    # shellcheck disable=SC2086 # lists of words
    (cd "$work/$1" && shift && arm-none-eabi-gcc -std=c90 $target -Os -ffunction-sections -fdata-sections \
        -fno-merge-constants -fstack-usage $includes -c "$@")
}
for layer in $layers; do
    case $layer in
    endpoint) compile endpoint "$source"/sw/icec/endpoints/xbee_endpoint.c ;;
    *) compile "$layer" "$source/sw/$layer"/*.c ;;
    esac
done
compile open -DLINK_SECURE=0 "$source"/sw/link/*.c
compile keyed -DLINK_MINIMAL -DLINK_SECURE=1 "$source"/sw/link/minimal/*.c "$source"/sw/link/link_wire.c \
    "$source"/sw/link/link_secure.c

# Bytes of the sections whose names match, of a layer's files, in the image.
linked() { # layer, pattern
    awk -v layer="/minimal_$1.arm/" -v wanted="$2" '
        function add(size, file) { if (index(file, layer) && section ~ wanted) sum += hex(size) }
        function hex(text,  i, n) {
            for (i = 3; i <= length(text); ++i) n = n * 16 + index("0123456789abcdef", substr(text, i, 1)) - 1
            return n
        }
        /^Linker script and memory map/ { live = 1 }
        !live { next }
        /^ \.?[A-Za-z_]/ { section = $1; if (NF >= 4) add($3, $4); next }
        /^ +0x/ && NF == 3 { add($2, $3) }
        END { print sum + 0 }' "$map"
}

whole() { # layer, column of size (1 text and read-only data, 2 data, 3 bss)
    arm-none-eabi-size "$work/$1"/*.o | awk -v c="$2" 'NR > 1 {n += $c} END {print n + 0}'
}

deepest() { # layer: the function of the minimal program with the largest frame
    find "$build/sw/apps/" -path "*/minimal_$1.arm/*.su" -exec cat {} + |
        awk -F '\t' '$2 > n {n = $2; split($1, f, ":"); name = f[4]} END {print n + 0, name}'
}

budget() { # configuration, layer
    sed -n "s/.*\"$1\\.$2\": *\\([0-9]*\\).*/\\1/p" "$source/sw/size_budget.json"
}

paper() {
    case $1 in fsmc) echo 1116 ;; radio) echo 1795 ;; link) echo 1307 ;; icec) echo 2622 ;; *) echo 0 ;; esac
}

entries='' over='' paperTotal=0 minimalTotal=0 fullTotal=0
entry() { # name, bytes, limit or 0
    entries="$entries${entries:+,
 }{\"name\": \"$1\", \"value\": $2, \"unit\": \"bytes\"$([ "$3" = 0 ] || echo ", \"limit\": $3"), \"command\": \"make size\"}"
}
check() { # configuration, layer, bytes
    limit=$(budget "$1" "$2")
    [ -n "$limit" ] || {
        over="$over
size: sw/size_budget.json has no \"$1.$2\" (it is $3)"
        return
    }
    [ "$3" -le "$limit" ] || over="$over
size: $1.$2 has grown to $3 bytes, its budget is $limit (sw/size_budget.json)"
}

printf '%-10s %8s %8s %8s %8s %9s %s\n' layer minimal "paper's" full 'RAM min' 'RAM full' 'largest frame (minimal)'
for layer in $layers; do
    small=$(linked $layer '^[.](text|rodata)')
    ram=$(linked $layer '^[.](data|bss)|^COMMON')
    large=$(whole $layer 1)
    largeRam=$(($(whole $layer 2) + $(whole $layer 3)))
    printf '%-10s %8d %8s %8d %8d %9d %s\n' $layer "$small" "$(paper $layer | sed s/^0$/-/)" "$large" "$ram" "$largeRam" \
        "$(deepest $layer)"
    entry "minimal.$layer" "$small" "$(paper $layer)"
    entry "full.$layer" "$large" 0
    check minimal $layer "$small"
    check full $layer "$large"
    minimalTotal=$((minimalTotal + small)) fullTotal=$((fullTotal + large)) paperTotal=$((paperTotal + $(paper $layer)))
done
printf '%-10s %8d %8d %8d\n' all $minimalTotal $paperTotal $fullTotal
entry minimal.all $minimalTotal $paperTotal
open=$(whole open 1) keyed=$(whole keyed 1)
check open link "$open"
check keyed link "$keyed"
entry "full.link without keys" "$open" 0
entry "minimal.link with keys" "$keyed" 0
echo "The full link without keys (LINK_SECURE=0): $open; the minimal one with them (LINK_SECURE=1): $keyed, and crypto"
echo "RAM of the minimal program with all objects: $(linked app '^[.](data|bss)|^COMMON') bytes, of generated code and servants: $(linked app '^[.](text|rodata)') bytes of text"
mkdir -p "$(dirname "$json")"
printf '[%s]\n' "$entries" >"$json"
echo "Written: $json"
[ -z "$over" ] || {
    echo "$over" >&2
    exit 1
}
