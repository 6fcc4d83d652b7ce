#!/bin/sh
# SPDX-License-Identifier: MIT
# lint: module source-folder generated-folder. Verilator -Wall, Icarus, Yosys check and latches.
set -eu
module=$1 source=$2 gen=$3
folders="$source/bus $source/hdl/fsmc $source/hdl/ddr $source/hdl/modem $source/hdl/system"
core=$(ls "$source"/ip/*/"$module.v" 2>/dev/null || true)
[ -z "$core" ] || folders="$folders $(dirname "$core")"
file=$(for f in $folders; do ls "$f/$module.v" 2>/dev/null || true; done)
case $module in
bus_decoder) variants='SLOTS=1 SLOTS=3 SLOTS=64' ;;
npi_select) variants="PORTS=2 PORTS=3 PORTS=4 PORTS=5 PORTS=6 PORTS=7 PORTS=8 URGENT=2'd1" ;;
npi_arbiter | memory_mcb | memory_litedram)
    variants="PORTS=2 PORTS=3 PORTS=4 PORTS=5 PORTS=6 PORTS=7 PORTS=8 URGENT=2'd1 READ_FIFO=2'd1 BLOCK_RAM=0 ADDR_WIDTH=30" ;;
litedram_backend) variants='ADDR_WIDTH=9 ADDR_WIDTH=32' ;;
mcb_backend) variants='ADDR_WIDTH=9 ADDR_WIDTH=30' ;;
npi_queue) variants='PORT_BITS=2 PORT_BITS=3' ;;
npi_stream) variants='ADDR_BITS=7 WORD_BITS=4 WORD_BITS=32' ;;
litedram_backend) variants='ADDR_WIDTH=9 ADDR_WIDTH=32' ;;
mcb_backend) variants='ADDR_WIDTH=9 ADDR_WIDTH=30' ;;
bus_wrapper) variants='EVENTS=1 EVENTS=32' ;;
bus_window | bus_to_axi4lite) variants='ADDR_WIDTH=6 ADDR_WIDTH=32' ;;
bus_to_wishbone) variants='ADDR_WIDTH=6 ADDR_WIDTH=32 PIPELINED=1' ;;
npi_fifo) variants='LOG2=1 LOG2=5 BLOCK=1' ;;
modem) variants='CLK_HZ=2000000 CLK_HZ=100000000 API=1' ;;
fsmc_bridge) variants='MUXED=1 SYNC=1 WAIT_HIGH=1 POST_LOG2=2 POST_LOG2=5 BLOCK_LOG2=1 BLOCK_LOG2=2 BLOCK_LOG2=4' ;;
system_slot) variants='SLOTS=2 SLOTS=63' ;;
*) variants='' ;;
esac
search=$(for f in $folders ${core:+"$gen"}; do echo "-y $f"; done)
verilogs=$(for f in $folders; do ls "$f"/*.v; done; [ -z "$core" ] || ls "$gen/$(basename "$(dirname "$core")")"*.v 2>/dev/null || true)
for variant in '' $variants; do
    # shellcheck disable=SC2086
    verilator --lint-only -Wall $search -I"$gen" --top-module "$module" ${variant:+-G$variant} "$file"
    set_parameter=''
    [ -z "$variant" ] || set_parameter="chparam -set ${variant%=*} ${variant#*=} $module;"
    yosys -q -p "read_verilog -I$gen $(echo $verilogs); $set_parameter hierarchy -top $module; proc; opt; check -assert; select -assert-none t:\$dlatch"
done
# shellcheck disable=SC2086
iverilog -g2005 -Wall -Wno-timescale -I"$gen" -t null $search -s "$module" "$file"
