#!/bin/sh
# SPDX-License-Identifier: MIT
# check: golden|hardware|equal|errors|compile slice2c file.ice-or-folder work-folder source-folder
#        [ghdl]
# Checks the output of slice2c for a Slice file. The end of the file contains the expected results:
# after `//> ` the messages of the compiler; after `//= ` lines of the generated header, of the
# server's C code, or of the registers. The messages must be equal and in this order. The other
# lines must occur in this order, possibly with more lines between them. The source line and the
# caret of a message are compared only if the file contains them. UPDATE_GOLDENS=1 rewrites the
# messages.
#
# golden: the generated C causes no warnings.
# hardware: wrappers and new cores are Verilog without warnings and without latches.
# equal: the VHDL wrapper of each interface, and the new core around it, compile as VHDL-93 and
# VHDL-2008 without warnings. The VHDL wrapper behaves like the Verilog wrapper: after reset, for
# any inputs, their outputs are the same in every clock (an unbounded proof).
# errors: the compiler writes no files.
set -eu
kind=$1 slice2c=$2 ice=$3 work=$4 source=$5
rm -rf "$work"
mkdir -p "$work"
flags="-std=c90 -pedantic -Wall -Wextra -Wconversion -Wstrict-prototypes -Wmissing-prototypes \
-Wdeclaration-after-statement -Werror -fsyntax-only -I$source/sw/base -I$source/sw/icec"
out=$work/out
hardware="--hw-verilog $out --hw-vhdl $out --hw-regs $out --hw-c $out --hw-cpp $out \
--hw-new-verilog $out --hw-new-vhdl $out"

has_lines() { # checks the lines after `//= ` in the files
    grep -q '^//= ' "$ice" || return 0
    sed -n 's/^\/\/= //p' "$ice" | awk 'BEGIN { i = 0 } NR == FNR { wanted[n++] = $0; next }
        $0 == wanted[i] { i++ }
        END { if (i < n) { print FILENAME ": not there, or too early: " wanted[i]; exit 1 } }' \
        - "$@"
}
has_messages() {
    grep -q '^//>  *^' "$ice" || sed -Ei '/^[^ ]+:[0-9]+|^[0-9]+ error/!d' "$work/messages"
    [ -z "${UPDATE_GOLDENS:-}" ] || {
        sed -i '/^\/\/> /d' "$ice" && sed 's/^/\/\/> /' "$work/messages" >>"$ice"
    }
    sed -n 's/^\/\/> //p' "$ice" | diff -u - "$work/messages"
}

# shellcheck disable=SC2086 # lists of words
case $kind in
golden)
    "$slice2c" "$ice" --output-dir "$work" 2>"$work/messages" || { cat "$work/messages" && exit 1; }
    for cc in gcc clang; do
        $cc $flags -I"$work" "$work"/*.c
    done
    g++ -Wall -Wextra -Werror -I"$source/sw/base" -I"$source/sw/icec" -fsyntax-only \
        -include "$work"/*.h -x c++ /dev/null
    sed -i "s|^.*/||" "$work/messages"
    has_messages
    has_lines "$work"/*.h "$work"/*_server.c
    ;;
hardware)
    "$slice2c" "$ice" --output-dir "$work/c" $hardware
    # The registers are a contract, so they are compared with the file: this program prints one line
    # for each register, field or event. test_slice_hardware runs wrappers, servants and proxies;
    # test_ip_sample runs new cores.
    /usr/bin/python3 - "$out"/*.regs.json >"$work/registers" <<'PYTHON'
import json, sys
for path in sys.argv[1:]:
    for key, value in json.load(open(path)).items():
        for one in value if key in ("registers", "events") else [{key: value}]:
            fields = one.pop("fields", [])
            print(*map(json.dumps, [one, *fields]), sep="\n")
PYTHON
    has_lines "$work/registers"
    folders="-y $source/bus -y $source/hdl/ddr -y $out"
    for file in "$out"/*.v; do
        module=$(basename "$file" .v)
        verilator --lint-only -Wall $folders --top-module "$module" "$file"
        iverilog -g2005 -Wall -Wno-timescale -t null -I "$source/bus" -I "$source/hdl/ddr" \
            $folders -s "$module" "$file"
        yosys -q -p "read_verilog -I$source/bus -I$source/hdl/ddr $out/*.v \
            $source/bus/bus_registers.v $source/bus/bus_wrapper.v $source/hdl/ddr/npi_stream.v; \
            hierarchy -check -top $module; proc; opt; check -assert; select -assert-none t:\$dlatch"
    done
    ;;
equal)
    ghdl=$6
    "$slice2c" "$ice" --output-dir "$work/c" --hw-verilog "$work" --hw-vhdl "$work" \
        --hw-new-vhdl "$work"
    cd "$work"
    for file in *_wrapper.v; do
        module=$(basename "$file" .v)
        for standard in 93 08; do
            rm -f ./*.cf
            "$ghdl" -a -Wall -Werror -Wno-default-binding --std=$standard \
                "$source/hdl/ddr/npi_stream_pkg.vhd" \
                "$module.vhd" "${module%_wrapper}.vhd"
            "$ghdl" -e -Wall -Werror -Wno-binding -Wno-default-binding --std=$standard \
                "${module%_wrapper}"
        done
        "$ghdl" --synth --std=08 --out=verilog "$module" >converted
        # AIGER has only flip-flops without enable; all of them begin with zeros, as after a reset
        yosys -q -l "$module.log" -p "
            read_verilog converted; hierarchy -top $module; proc; flatten; opt_clean
            select -assert-none t:\$dlatch; rename $module from_vhdl; design -stash vhdl
            read_verilog $file $source/bus/bus_registers.v $source/bus/bus_wrapper.v
            hierarchy -top $module; proc; flatten; opt_clean; rename $module from_verilog
            design -copy-from vhdl -as from_vhdl from_vhdl
            miter -equiv -flatten -make_assert from_verilog from_vhdl both
            hierarchy -top both; proc; opt_clean; setundef -zero -init; opt -full; techmap
            opt -fast -nosdff -nodffe; dfflegalize -cell \$_DFF_P_ 01
            abc -g AND -fast; opt_clean; delete -output w:*; write_aiger -zinit both.aig"
        # sat: scorr may already find that the output is constant; newer versions of abc then have
        # nothing left to prove
        timeout 100 yosys-abc -c 'read_aiger both.aig; fold; strash; scorr; pdr; sat' >proof.log \
            2>&1 || true
        grep -q 'Property proved\|UNSATISFIABLE' proof.log || {
            cat proof.log >&2
            echo "equal: $module: the VHDL wrapper is not shown to do what the Verilog one does" >&2
            exit 1
        }
        echo "$module: equal in both languages, $(head -1 both.aig | cut -d' ' -f4) flip-flops"
    done
    ;;
errors)
    cd "$(dirname "$ice")"
    status=0
    "$slice2c" "$(basename "$ice")" --output-dir "$work" $hardware 2>"$work/messages" || status=$?
    [ $status = 1 ] || { echo "exit status $status; expected 1" && exit 1; }
    [ "$(ls "$work")" = messages ] || { echo "files were written in spite of errors" && exit 1; }
    sed -i "s|^/[^:]*/||" "$work/messages"
    has_messages
    ;;
# every file of a folder must compile without a message, and the generated C without a warning
compile)
    find "$ice" -name '*.ice' | sort >"$work/list"
    while read -r file; do
        folder=${file#"$ice"/}
        "$slice2c" -I "$ice" "$file" --output-dir "$out/$(dirname "$folder")" \
            2>"$work/messages" || { echo "$file:" && cat "$work/messages" && exit 1; }
        ! grep ': warning: ' "$work/messages" | grep -v deprecated || exit 1
    done <"$work/list"
    # All sources of a file are compiled at once, because starting a compiler takes longer than
    # compiling.
    find "$out" -name '*_types.c' | while read -r types; do
        for part in types client async server; do
            echo "#include \"${types%_types.c}_$part.c\""
        done >"${types%_types.c}_whole.c"
    done
    for cc in gcc clang 'arm-none-eabi-gcc -mcpu=cortex-m3 -mthumb'; do
        find "$out" -name '*_whole.c' -exec $cc $flags -I"$out" {} +
    done
    wc -l <"$work/list"
    ;;
esac
