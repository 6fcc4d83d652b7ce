#!/bin/sh
# SPDX-License-Identifier: MIT
# equal: ghdl slice2c file.ice work-folder source-folder
# Each interface's VHDL wrapper, and the new core around it, are taken as VHDL-93 and -2008 without
# a warning. The wrapper does what the Verilog one does: from reset on, whatever comes, their
# outputs are the same in every clock (proven, not bounded).
set -eu
ghdl=$1 slice2c=$2 ice=$3 work=$4 source=$5
rm -rf "$work"
mkdir -p "$work"
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
        "$ghdl" -e -Wall -Werror -Wno-binding -Wno-default-binding --std=$standard "${module%_wrapper}"
    done
    "$ghdl" --synth --std=08 --out=verilog "$module" >converted
    # AIGER has flip-flops without enable only; both begin with zeros, as after a reset
    yosys -q -l "$module.log" -p "
        read_verilog converted; hierarchy -top $module; proc; flatten; opt_clean
        select -assert-none t:\$dlatch; rename $module from_vhdl; design -stash vhdl
        read_verilog $file $source/bus/bus_registers.v $source/bus/bus_wrapper.v; hierarchy -top $module
        proc; flatten; opt_clean; rename $module from_verilog; design -copy-from vhdl -as from_vhdl from_vhdl
        miter -equiv -flatten -make_assert from_verilog from_vhdl both; hierarchy -top both; proc; opt_clean
        setundef -zero -init; opt -full; techmap; opt -fast -nosdff -nodffe; dfflegalize -cell \$_DFF_P_ 01
        abc -g AND -fast; opt_clean; delete -output w:*; write_aiger -zinit both.aig"
    # sat: where scorr alone has found the output constant, newer versions of abc have nothing left
    # to prove
    timeout 100 yosys-abc -c 'read_aiger both.aig; fold; strash; scorr; pdr; sat' >proof.log \
        2>&1 || true
    grep -q 'Property proved\|UNSATISFIABLE' proof.log || {
        cat proof.log >&2
        echo "equal: $module: the VHDL wrapper is not shown to do what the Verilog one does" >&2
        exit 1
    }
    echo "$module: equal in both languages, $(head -1 both.aig | cut -d' ' -f4) flip-flops"
done
