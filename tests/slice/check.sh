#!/bin/sh
# SPDX-License-Identifier: MIT
# check: golden|hardware|errors|compile slice2c file.ice-or-folder work-folder source-folder
# What is expected stands at the end of the file: the compiler's messages behind `//> `, and behind
# `//= ` lines of the generated header, then of the server's C, or of the registers, in their order.
# golden: the C has no warnings.
# hardware: the wrappers and new cores are Verilog without warnings, and without latches.
# errors: nothing is written.
# A message's source line and caret are compared where the file has them.
# UPDATE_GOLDENS=1 rewrites messages.
set -eu
kind=$1 slice2c=$2 ice=$3 work=$4 source=$5
rm -rf "$work"
mkdir -p "$work"
flags="-std=c90 -pedantic -Wall -Wextra -Wconversion -Wstrict-prototypes -Wmissing-prototypes \
-Wdeclaration-after-statement -Werror -fsyntax-only -I$source/sw/base -I$source/sw/icec"
out=$work/out
hardware="--hw-verilog $out --hw-vhdl $out --hw-regs $out --hw-c $out --hw-cpp $out \
--hw-new-verilog $out --hw-new-vhdl $out"

has_lines() { # the lines behind `//= `, in the files
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
    # The registers are a contract; test_slice_hardware runs wrappers, servants and proxies,
    # test_ip_sample new cores.
    has_lines "$out"/*.regs.json
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
errors)
    cd "$(dirname "$ice")"
    status=0
    "$slice2c" "$(basename "$ice")" --output-dir "$work" $hardware 2>"$work/messages" || status=$?
    [ $status = 1 ] || { echo "exit status $status; expected 1" && exit 1; }
    [ "$(ls "$work")" = messages ] || { echo "files were written in spite of errors" && exit 1; }
    sed -i "s|^/[^:]*/||" "$work/messages"
    has_messages
    ;;
compile) # every file of a folder compiles without a message, and its C without a warning
    find "$ice" -name '*.ice' | sort >"$work/list"
    while read -r file; do
        folder=${file#"$ice"/}
        "$slice2c" -I "$ice" "$file" --output-dir "$out/$(dirname "$folder")" \
            2>"$work/messages" || { echo "$file:" && cat "$work/messages" && exit 1; }
        ! grep ': warning: ' "$work/messages" | grep -v deprecated || exit 1
    done <"$work/list"
    # The sources of a file in one go: a compiler's start takes longer than its work.
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
