#!/bin/sh
# SPDX-License-Identifier: MIT
# lint: module source-folder generated-folder. Runs Verilator -Wall, Icarus, Yosys' check, and the
# search for latches. A variant is a parameter with its value, or several of them separated by
# commas. The elaboration of the variants in `refused` must fail.
set -eu
module=$1 source=$2 gen=$3
folders=$source/bus
for room in fsmc ddr modem system cdc bringup; do folders="$folders $source/hdl/$room"; done
core=$(ls "$source"/ip/*/"$module.v" 2>/dev/null || true)
[ -z "$core" ] || folders="$folders $(dirname "$core")"
file=$(for f in $folders "$gen"; do ls "$f/$module.v" 2>/dev/null || true; done)
refused='' says=$module # start of the error message
case $module in
bus_decoder) variants='SLOTS=1 SLOTS=4 SLOTS=64' ;;
npi_select) variants="PORTS=2 PORTS=3 PORTS=4 PORTS=5 PORTS=6 PORTS=7 PORTS=8 URGENT=2'd1" ;;
npi_arbiter | memory_mcb)
    variants="PORTS=2 PORTS=3 PORTS=4 PORTS=5 PORTS=6 PORTS=7 PORTS=8 URGENT=2'd1 READ_FIFO=2'd1"
    variants="$variants BYTES=2'd2 MERGE=2'd1 BLOCK_RAM=0 ADDR_WIDTH=30"
    [ "$module" != npi_arbiter ] || refused='PORTS=1 PORTS=9 URGENT_RUN=0 ADDR_WIDTH=33' ;;
mcb_backend) variants='ADDR_WIDTH=9 ADDR_WIDTH=30' refused='ADDR_WIDTH=31' ;;
npi_queue) variants='PORT_BITS=2 PORT_BITS=3' ;;
npi_stream) variants='ADDR_BITS=7 WORD_BITS=4 WORD_BITS=32' ;;
axis_filter) variants='WIDTH=16 WIDTH=32 WIDTH=64 LAST=0' ;;
bus_wrapper) variants='EVENTS=1 EVENTS=32' ;;
bus_window)
    variants='ADDR_WIDTH=3 ADDR_WIDTH=5 ADDR_WIDTH=6 ADDR_WIDTH=32'
    refused='ADDR_WIDTH=2 ADDR_WIDTH=33 TIMEOUT=0 TIMEOUT=256'
    ;;
bus_to_axi4lite) variants='ADDR_WIDTH=3 ADDR_WIDTH=32' ;;
bus_to_wishbone) variants='ADDR_WIDTH=3 ADDR_WIDTH=32 PIPELINED=1' ;;
async_fifo) variants='LOG2=2 LOG2=6' ;;
npi_fifo) variants='LOG2=2 LOG2=24,BLOCK=1 LOG2=5 BLOCK=1 LANES=8 LANES=8,BLOCK=1' ;;
npi_write_fifo) variants='BYTES=0 BYTES=1 BYTES=1,BLOCK=1 MERGE=1 MERGE=1,BLOCK=1' ;;
modem) variants='CLK_HZ=2000000 CLK_HZ=100000000 API=1' ;;
fsmc_bridge | fsmc_sync_bridge)
    variants='MUXED=1 WAIT_HIGH=1,TIMEOUT_LOG2=24 TIMEOUT_LOG2=1 POST_LOG2=2,BLOCK_LOG2=4'
    variants="$variants POST_LOG2=3,BLOCK_LOG2=1 POST_LOG2=5,BLOCK_LOG2=2"
    says='FSMC bridge' # fsmc_parameter_rules.v
    refused='MUXED=2 WAIT_HIGH=2 POST_LOG2=1 POST_LOG2=6 BLOCK_LOG2=0 BLOCK_LOG2=5 TIMEOUT_LOG2=0'
    ;;
system_slot) variants='SLOTS=2 SLOTS=63' ;;
core_gate | core_clock) # BUFGCE.v, DCM_CLKGEN.v
    folders="$folders $source/tests/hdl/lint"
    variants=GATED=1
    [ $module = core_gate ] || variants=MULTIPLY=5,DIVIDE=7
    ;;
*) variants='' ;;
esac
search=$(for f in $folders "$gen"; do echo "-y $f -I$f"; done)
libraries=$(for f in $folders "$gen"; do echo "-libdir $f"; done)
each() { echo "$1" | tr , ' '; }
# The script `verilator` only starts this program, and takes as long as the lint of a small module.
verilate() { # variant [switches]
    # shellcheck disable=SC2086,SC2046
    verilator_bin --lint-only -Wall ${2-} $search --top-module "$module" \
        $(for p in $(each "$1"); do echo "-G$p"; done) "$file"
}
# elaboration VARIANT: prints the commands with which Yosys elaborates one variant. Modules below
# the top are found by their names.
elaboration() { # variant
    set_parameter=$(for p in $(each "$1"); do echo "-set ${p%%=*} ${p#*=}"; done)
    echo "${set_parameter:+chparam $(echo $set_parameter) $module;}"
    echo "hierarchy -top $module $(echo $libraries);"
}
read_file="verilog_defaults -add -I$gen -I$source/bus -I$source/hdl/ddr; read_verilog $file;"
elaborate() { yosys -q -p "$read_file $(elaboration "$1")"; } # variant
checks=''
for variant in '' $variants; do
    verilate "$variant"
    checks="$checks log variant $(each "$variant"); design -load read; $(elaboration "$variant")
        proc; opt_clean; check -assert; select -assert-none t:\$dlatch;"
done
# The design is also linted with the cover points of coverage builds. It is linted without them as
# well, because each signal must be used even without cover points.
verilate '' '-DCOVER_POINTS --coverage --assert -Wno-SYNCASYNCNET'
# One process for all variants, in which the files below the top are read once: starting Yosys and
# reading takes longer than the checks of a variant. Without optimisations, Yosys checks more logic
# than with them, in less time.
yosys -q -p "$read_file hierarchy $(echo $libraries); design -save read; $checks"
icarus() { # [variant]
    # shellcheck disable=SC2086,SC2046
    iverilog -g2005 -Wall -Wno-timescale -t null $search -s "$module" \
        $(for p in $(each "${1-}"); do echo "-P$module.$p"; done) "$file"
}
for variant in $refused; do
    for tool in verilate elaborate icarus; do
        said=$($tool "$variant" 2>&1) && { echo "$module: $tool takes $variant" >&2; exit 1; }
        # the variant must be rejected with the message of wrong_parameter.vh
        echo "$said" | grep -qE "$says: [A-Z].*[0-9][.][.][0-9]|Unknown module type: wrong_par" || {
            echo "$said" >&2
            exit 1
        }
    done
done
icarus
