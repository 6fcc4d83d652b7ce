#!/bin/sh
# SPDX-License-Identifier: MIT
# kinds: source-folder ghdl work-folder
# Tests the register block of kinds.regs.json, which has every kind of register: the block is
# proven, causes no warnings, and behaves the same in VHDL. If a fault is put into the block, its
# proof must fail.
set -eu
source=$1 ghdl=$2 work=$3
here=$source/tests/regs
fail() { echo "kinds: $*" && exit 1; }
rm -rf "$work"
mkdir -p "$work/vhdl" "$work/wrong"
"$source/tools/python" -m icesoc.regs.generate "$here/kinds.regs.json" --block --output-dir "$work"
verilator --lint-only -Wall -I"$source/bus" -I"$work" --top-module kinds_regs "$work/kinds_regs.v"
iverilog -g2005 -Wall -Wno-timescale -I"$source/bus" -I"$work" -t null "$work/kinds_regs.v" \
    >"$work/iverilog" 2>&1
[ ! -s "$work/iverilog" ] || { cat "$work/iverilog" && fail 'iverilog warns'; }
printf '#include "kinds_regs.h"\nint main(void) { return 0; }\n' >"$work/kinds.c"
gcc -std=c90 -pedantic -Wall -Wextra -Werror -fsyntax-only "$work/kinds.c"
prove() { # folder with the block, options
    folder=$1
    shift
    "$source/tools/python" -m icesoc.proof.prove kinds_regs 4 "$source" "$folder/proof" \
        --generated "$folder" "$@"
}
prove "$work" >"$work/log" || { cat "$work/log" && fail 'not proven'; }

# A block with LUT RAM and with words in a memory of the core.
mkdir "$work/memory"
sed 's/"block": "kinds"/"block": "memory"/
    s/"name": "SHOWN", "access": "ro"/"name": "SHOWN", "access": "rw", "storage": "memory"/
    s/, "strobes": \["read"\], "doc": "of the core"/, "doc": "in the core"/' \
    "$here/kinds.regs.json" >"$work/memory/memory.regs.json"
"$source/tools/python" -m icesoc.regs.generate "$work/memory/memory.regs.json" --block \
    --output-dir "$work/memory"
verilator --lint-only -Wall -I"$source/bus" -I"$work/memory" --top-module memory_regs \
    "$work/memory/memory_regs.v"

# The register block in VHDL must give the same results as the block in Verilog, word by word.
"$source/cmake/vhdl_to_verilog.sh" "$ghdl" "$work/vhdl" kinds_regs "$work/vhdl/kinds_regs.v" \
    "$work/kinds_regs_pkg.vhd" "$work/kinds_regs.vhd"
"$source/cmake/no_latches.sh" "$work/vhdl" kinds_regs "$work/vhdl/kinds_regs.v"
same() { # vhdl folder
    yosys -q -p "
        verilog_defaults -add -I$source/bus -I$work
        read_verilog $work/kinds_regs.v
        rename kinds_regs gold
        read_verilog $1/kinds_regs.v
        rename kinds_regs gate
        proc; flatten; memory; opt -full
        equiv_make gold gate equiv
        hierarchy -top equiv
        equiv_simple -undef; equiv_induct -undef; equiv_status -assert" >"$work/log" 2>&1
}
same "$work/vhdl" || { cat "$work/log" && fail 'VHDL and Verilog differ'; }
mkdir "$work/other"
sed 's/& *clear/\& ~clear/; s/~ *clear/clear/' "$work/vhdl/kinds_regs.v" >"$work/other/kinds_regs.v"
cmp -s "$work/vhdl/kinds_regs.v" "$work/other/kinds_regs.v" || ! same "$work/other" ||
    fail 'a difference between VHDL and Verilog is not seen'

# arguments: error, sed command that makes the error; the bounded proof must find each error. With
# --mutant, a failed proof does not spend time on a waveform.
wrong() {
    sed "$2" "$work/kinds_regs.v" >"$work/wrong/kinds_regs.v"
    ! cmp -s "$work/kinds_regs.v" "$work/wrong/kinds_regs.v" || fail "nothing is changed: $1"
    cp "$work"/*.vh "$work/wrong"
    ! prove "$work/wrong" --bounded --mutant "# $1" >"$work/log" 2>&1 || fail "proven although $1"
    grep -q 'an assertion fails\|assert' "$work/log" || { cat "$work/log" && fail "$1"; }
}
wrong 'word 8 exists' "s/WORDS = 16'hDEFF/WORDS = 16'hDFFF/"
wrong 'an event is lost in the clock of its clear' \
    's/events <= (events & ~clear) | raised/events <= (events | raised) \& ~clear/'
wrong 'the mask is ignored' 's/irq_o = |(events & mask)/irq_o = |events/'
wrong 'a lock is ignored' 's/\(wire mode_write .*\) && !busy_i/\1/'
wrong 'the core cannot clear' 's/if (mode_on_clear_i)/if (1'"'"'b0)/'
wrong 'a reset value is another' "s/whole_o <= 32'hDEADBEEF/whole_o <= 32'hDEADBEE0/"
wrong 'a flag is cleared by 0' 's/(flags_a_o & ~(/(flags_a_o \& (/'
wrong 'a bit that is set while it is cleared is lost' \
    's/ask_o <= (ask_o & ~ask_clear_i) | \(.*\);/ask_o <= (ask_o | \1) \& ~ask_clear_i;/'
wrong 'an unreadable word is readable' 's/default: *rdata = 32.d0/default: rdata = 32'"'"'d1/'
wrong 'a pulse comes at once' 's/if (!later_write || rst_i)/if (rst_i)/'
echo 'kinds: all as expected'
