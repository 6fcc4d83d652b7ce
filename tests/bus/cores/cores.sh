#!/bin/sh
# SPDX-License-Identifier: MIT
# cores: coremap regmap source-folder generated-folder work-folder   Lists of cores: what the chip is with them, lint of soc.v
# with each, and errors.
set -eu
coremap=$1 regmap=$2 source=$3 gen=$4 work=$5
data=$(cd "$(dirname "$0")/data" && pwd)
rm -rf "$work"
mkdir -p "$work"
fail() { echo "cores: $*" && exit 1; }

chip() { # name, the list: the chip in $work/name
    out=$work/$1
    mkdir -p "$out"
    printf '%b' "$2" >"$out/cores.list"
    "$coremap" "$out/cores.list" --base "$source/bus/map.regs.json" --core "led=$data/led.regs.json" \
        --core "adder=$data/adder.regs.json" --core "mover=$data/mover.regs.json" \
        --block "0=system=$source/hdl/system/system.regs.json" --output-dir "$out" 2>"$out/messages"
}
accepted() {
    chip "$@" || { cat "$out/messages" && fail "refused: $2"; }
    "$regmap" "$out/map.regs.json" --output-dir "$out"
    # shellcheck disable=SC2086 # a list of folders
    verilator --lint-only -Wall -I"$out" $(for f in "$out" "$data" "$source"/bus "$source"/hdl/* "$gen"; do [ ! -d "$f" ] || echo "-y $f"; done) \
        -I"$gen" --top-module soc "$source/hdl/soc.v"
    gcc -std=c90 -pedantic -Wall -Wextra -Wmissing-prototypes -Werror -fsyntax-only -I"$out" -I"$data" -I"$source/sw/hw" \
        -I"$source/sw/icec" -I"$source/sw/base" "$out/soc_cores.c"
}
refused() { # words of the message, the list
    ! chip refused "$2" || fail "accepted: $2"
    grep -q -- "$1" "$work/refused/messages" || { cat "$work/refused/messages" && fail "'$1' is not said: $2"; }
    [ ! -f "$work/refused/soc_cores.vh" ] || fail "files were written in spite of: $1"
}
is() { grep -q "^#define MAP_$1 $2U" "$out/map_regs.h" || { grep "$1" "$out/map_regs.h" || true; fail "$1 is not $2"; }; }

accepted none '# nothing\n\n'
is SLOT_COUNT 0x2
is NPI_PORT_COUNT 0x2
accepted one 'led\n'
is SLOT_LED 0x2
is SLOT_COUNT 0x3
accepted several 'adder identity=eye # a comment\nled slot=5 button_i=camera.seen_o\nmover\nmover name=camera\n adder name=adder2\n'
is SLOT_ADDER 0x2
is SLOT_LED 0x5
is SLOT_MOVER 0x3
is SLOT_CAMERA 0x4
is SLOT_ADDER2 0x6
is NPI_PORT_COUNT 0x4
is NPI_PORT_MOVER 0x2
is NPI_PORT_CAMERA 0x3
is MEMORY_MOVER 0x1000000
is MEMORY_CAMERA 0x1000500
# The pages are XML and HTML that others read; the registers are where the map has them.
# CMSIS-SVD.xsd: ARM's schema 1.3.9 (CMSIS_5, commit 51f8f89), Apache-2.0 as its header says.
xmllint --noout --schema "$(dirname "$0")/CMSIS-SVD.xsd" "$out/icesoc.svd" 2>"$work/svd" || { cat "$work/svd" && fail 'icesoc.svd is not as ARM wants it'; }
address=$(xmllint --xpath 'string(//peripheral[name="CAMERA"]/baseAddress)' "$out/icesoc.svd")
[ "$address" = 0x64000100 ] || fail "CAMERA is at $address in the SVD file"
[ "$(xmllint --xpath 'string(//peripheral[name="SYSTEM"]/registers/register[name="EVENT"]/modifiedWriteValues)' "$out/icesoc.svd")" = oneToClear ] ||
    fail 'EVENT is not cleared by writing 1 in the SVD file'
[ "$(xmllint --xpath 'count(//peripheral)' "$out/icesoc.svd")" = 6 ] || fail 'the SVD file has not six peripherals'
xmllint --html --noout "$out/registers.html" 2>"$work/html" || { cat "$work/html" && fail 'registers.html'; }
is PIN_CAMERA_SEEN_O 0xB
grep -q '"eye"' "$out/soc_cores.c" || fail 'the identity is not in the table'
accepted hole 'led slot=63\n'
is SLOT_COUNT 0x40

refused "1: error: there is no core 'nobody'" 'nobody\n'
refused "2: error: 'led' is on line 1 already; name=" 'led\nled\n'
refused "3: error: slot 7 is taken on line 2" '#\nled slot=7\nadder slot=7\n'
refused "slot=1: 2..63" 'led slot=1\n'
refused "slot=64: 2..63" 'led slot=64\n'
refused "slot=x" 'led slot=x\n'
refused "'modem' is a name of the platform's" 'led name=modem\n'
refused "name=Led: small letters" 'led name=Led\n'
refused "identity 'a' is taken" 'led identity=a\nadder identity=a\n'
refused "'slot' is given twice" 'led slot=3 slot=4\n'
refused "'as' *: after the core's folder" 'led as\n'
refused "has no input pin 'colour'" 'led colour=red\n'
refused "no core's output of 1 bits" 'led button_i=mover.nothing_o\n'
refused "pins of a direction" 'mover\nmover name=a\nmover name=b\nmover name=c\n'
"$coremap" --help | grep -q 'a core a line' || fail 'no help'
! "$coremap" "$work/missing" --base "$source/bus/map.regs.json" 2>"$work/messages" || fail 'a missing list is accepted'
grep -q 'cannot read' "$work/messages" || fail 'a missing list is not said'
echo 'cores: all as expected'
