#!/bin/sh
# SPDX-License-Identifier: MIT
#
# build: builds a bitstream from soc.edf with Xilinx ISE 14.7: XST for the wrapper, ngdbuild, map,
# par, trce, bitgen.
# Usage: synth/ise/build.sh [--xst] [--part xc6slx16-2-csg324] soc.edf mig-folder output-folder
# core_pins.ucf board.ucf
#   soc.edf      from `./icesoc synth edif`
#   mig-folder   user_design of a MIG core called "mig": its rtl/*.v and par/mig.ucf are used
#   *.ucf        build/main/gen/core_pins.ucf, and your board's (./icesoc board make NAME)
#   --xst        XST also synthesises soc, from the folder `verilog` (soc.edf is unused); needed for
#                a board with multiplexed address and data
set -eu
usage() {
    sed -n 's/^# \{0,1\}//; 6,12p' "$0"
    exit "$1"
}
part=xc6slx16-2-csg324 whole='' xst_includes=''
while [ $# -gt 0 ]; do
    case $1 in
    --help | -h) usage 0 ;;
    --xst) whole=1 ;;
    --part) part=${2:?--part needs a name} && shift ;;
    -*) echo "build: unknown option $1" >&2 && usage 2 >&2 ;;
    *) break ;;
    esac
    shift
done
[ $# -eq 5 ] || usage 2 >&2
source=$(cd "$(dirname "$0")" && pwd)
soc=$1 mig=$2 output=$3
for needed in "$soc" "$mig/par/mig.ucf" "$4" "$5"; do
    [ -e "$needed" ] || { echo "build: $needed is not there" >&2 && exit 2; }
done
for program in xst ngdbuild map par trce bitgen; do
    command -v $program >/dev/null 2>&1 || {
        echo "build: $program is not in the PATH; source ISE's settings64.sh first" >&2
        exit 2
    }
done
[ -z "$whole" ] || ! grep -q hierconn "$soc"/*.vh || {
    echo "build: the chip has a probe, and XST does not support its hierarchical names;" \
        "leave --xst out" >&2
    exit 2
}
muxed=''
! grep -q 'PERIOD "fsmc_nadv"' "$5" || muxed=1
[ -z "$muxed" ] || [ -n "$whole" ] || {
    echo "build: $5 belongs to a board with multiplexed address and data: add --xst, because" \
        "soc.edf contains the bridge for other boards" >&2
    exit 2
}
mkdir -p "$output"
"$source/../../tools/python" -m icesoc.synth.merge_ucf "$mig/par/mig.ucf" "$source/chip.ucf" \
    "$4" "$5" >"$output/all.ucf"
soc=$(cd "$(dirname "$soc")" && pwd)/$(basename "$soc") mig=$(cd "$mig" && pwd)
cd "$output"
: >chip.prj
for file in "$source/chip.v" "$mig"/rtl/*.v "$mig"/rtl/*/*.v; do
    [ ! -e "$file" ] || echo "verilog work \"$file\"" >>chip.prj
done
if [ -n "$whole" ]; then
    xst_includes="-vlgincdir $soc"
    [ -z "$muxed" ] || xst_includes="$xst_includes
-define {FSMC_MUXED}"
    for file in "$soc"/*.v; do echo "verilog work \"$file\"" >>chip.prj; done
fi
cat >chip.xcf <<XCF
BEGIN MODEL "chip"
NET "sys_clk_i" PERIOD = 10 ns;
NET "clk" PERIOD = 10 ns;
END;
XCF
cat >chip.xst <<XST
run
-ifn chip.prj
-ofn chip.ngc
-top chip
-p $part
-uc chip.xcf
-opt_mode Area
-read_cores optimize
${xst_includes:--sd $(dirname "$soc")}
XST
xst -ifn chip.xst -ofn chip.syr
ngdbuild -p "$part" -sd "$(dirname "$soc")" -uc all.ucf chip.ngc chip.ngd
map -w -p "$part" -ol high -o chip_map.ncd chip.ngd chip.pcf
par -w -ol high chip_map.ncd chip.ncd chip.pcf
trce -v 20 chip.ncd chip.pcf -o chip.twr
bitgen -w chip.ncd chip.bit chip.pcf
grep -E 'Number of (Slice Registers|Slice LUTs|occupied Slices)' chip_map.mrp
grep -E 'constraints? (were|was) (not )?met|Minimum period' chip.twr chip.par || true
