#!/bin/sh
# SPDX-License-Identifier: MIT
# check: golden|errors slice2c file.ice work-folder source-folder
# UPDATE_GOLDENS=1 rewrites what is expected; a new golden begins as an empty file of a generated file's name.
set -eu
kind=$1 slice2c=$2 ice=$3 work=$4 source=$5
rm -rf "$work"
mkdir -p "$work"
hardware="--hw-verilog $work/out --hw-vhdl $work/out --hw-regs $work/out --hw-c $work/out --hw-cpp $work/out \
          --hw-new-verilog $work/out --hw-new-vhdl $work/out"
cd "$(dirname "$ice")"
case $kind in
golden)
    # shellcheck disable=SC2086
    "$slice2c" "$ice" --output-dir "$work/c" $hardware
    # The registers are a contract; wrappers, servants and proxies run in test_slice_hardware, new cores in test_ip_sample.
    for file in "${ice%.ice}"/*.regs.json; do
        [ -e "$file" ] || continue
        [ -z "${UPDATE_GOLDENS:-}" ] || cp "$work/out/${file##*/}" "$file"
        diff -u "$file" "$work/out/${file##*/}"
    done
    # Of many registers those of `lines`, in that order: the first and the last of each page.
    [ ! -e "${ice%.ice}/lines" ] || awk 'BEGIN { i = 0 } NR == FNR { wanted[n++] = $0; next } $0 == wanted[i] { i++ }
        END { if (i < n) { print FILENAME ": not there, or too early: " wanted[i]; exit 1 } }' "${ice%.ice}/lines" "$work"/out/*.regs.json
    for file in "$work"/out/*.v; do
        module=$(basename "$file" .v)
        verilator --lint-only -Wall -y "$source/bus" -y "$source/hdl/ddr" -y "$work/out" --top-module "$module" "$file"
        iverilog -g2005 -Wall -Wno-timescale -t null -I "$source/bus" -I "$source/hdl/ddr" -y "$source/bus" -y "$source/hdl/ddr" -y "$work/out" -s "$module" "$file"
        yosys -q -p "read_verilog -I$source/bus -I$source/hdl/ddr $work/out/*.v $source/bus/bus_registers.v $source/bus/bus_wrapper.v \
                     $source/hdl/ddr/npi_stream.v; hierarchy -check -top $module; proc; opt; check -assert; select -assert-none t:\$dlatch"
    done
    ;;
errors)
    status=0
    # shellcheck disable=SC2086
    "$slice2c" "$(basename "$ice")" --output-dir "$work/c" $hardware 2>"$work/messages" || status=$?
    sed -i "s/^[^:]*\///" "$work/messages"
    [ $status = 1 ] || { echo "exit status $status; expected 1" && exit 1; }
    [ "$(ls "$work")" = messages ] || { echo "files were written in spite of errors" && exit 1; }
    [ -z "${UPDATE_GOLDENS:-}" ] || { sed -i '/^\/\/> /d' "$ice" && sed 's/^/\/\/> /' "$work/messages" >>"$ice"; }
    sed -n 's/^\/\/> //p' "$ice" | diff -u - "$work/messages"
    ;;
esac
