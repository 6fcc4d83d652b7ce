#!/bin/sh
# SPDX-License-Identifier: MIT
# new: name verilog|vhdl build-folder [file.ice]   Writes ip/<name>: interface, core, test; of the given interface, or of an
# example, or prints the error. `check` in place of the language: only whether the name is a reserved word.
set -eu
usage='usage: make new-ip NAME=low_pass LANG=verilog|vhdl [ICE=file.ice]'
case ${1:-} in -h | --help) echo "$usage" && exit 0 ;; esac
name=${1:-} lang=${2:-} build=${3:-build/main} ice=${4:-}
case $ice in '' | /*) ;; *) ice=$PWD/$ice ;; esac
cd "$(dirname "$0")/.."
fail() { echo "new-ip: $*" >&2 && exit 1; }
[ -n "$name" ] || fail "$usage"
[ -n "$lang" ] || fail "LANG says the core's language: LANG=verilog or LANG=vhdl"
case $lang in verilog | vhdl | check) ;; *) fail "LANG is verilog or vhdl, not '$lang'" ;; esac
[ "$lang" = check ] || echo "$name" | grep -Eq '^[a-z][a-z0-9]*$|^[a-z][a-z0-9]+(_[a-z][a-z0-9]+)+$' ||
    fail "'$name': words of small letters and digits, joined by _, such as mixer or low_pass"
reserved=' abs access after alias all always and architecture array assert assign attribute automatic begin block body buf buffer
 bus case casex casez cell class cmos component config configuration const constant context cover deassign default defparam design disable
 disconnect double downto edge else elsif end enum event exit false file float for force forever fork function generate generic genvar
 group guarded highz0 highz1 if ifnone impure in inertial inout input instance int integer interface is join label large
 liblist library linkage literal local localparam long loop macromodule map medium mod module nand negedge new next nmos nor
 noshowcancelled not notif0 notif1 null object of on open operation or others out output package parameter pmos port posedge
 postponed primitive private procedure process property protected public pull0 pull1 pulldown pullup pure range rcmos real
 realtime record reg register reject release rem repeat report restrict return rnmos rol ror rpmos select sequence severity
 shared short showcancelled signal signed sla sll small specify specparam sra srl string strong strong0 strong1 struct subtype
 supply0 supply1 table task template test then throws time to tran transport tri type union unaffected units unsigned until
 use value variable vectored void wait wand weak weak0 weak1 when while wire with wor work xnor xor '
case $(echo "$reserved" | tr '\n' ' ') in *" $name "*) fail "'$name' is a reserved word of Verilog, VHDL, C, Slice or this project" ;; esac
[ "$lang" != check ] || exit 0
[ ! -e "ip/$name" ] || fail "ip/$name is there already"
taken=$(find bus hdl ip sw testbench -name "$name.regs.json" -o -name "${name}_wrapper.v")
[ -z "$taken" ] || fail "$taken has the name '$name'"
taken=$(grep -rliE --include='*.v' --include='*.vhd' "^ *(module|entity) +${name}(_wrapper)?\b" bus hdl ip synth || true)
[ -z "$taken" ] || fail "there is a module '$name' in $taken"
type=$(echo "$name" | sed -E 's/(^|_)([a-z])/\U\2/g')
# The folder is moved to its place when it is complete.
mkdir -p "$build"
work=$(mktemp -d "$build/new-ip.XXXXXX")
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT TERM HUP
folder=$work/$name
mkdir "$folder"
fill() { # template, target
    sed "s/@NAME@/$name/g; s/@TYPE@/$type/g; s/@MODULE@/Cores/g" "$1" >"$folder/$2"
}
if [ -n "$ice" ]; then
    [ -f "$ice" ] || fail "there is no file '$ice'"
    included=$(sed -n 's/^ *# *include *[<"]\([^>"]*\).*/\1/p' "$ice" | tr '\n' ' ')
    [ -z "$included" ] || fail "$ice includes ${included% }: a core has one Slice file; write into it what it needs of others"
    slice2c=$build/slice/slice2c
    [ -x "$slice2c" ] || fail "there is no $slice2c: make build"
    "$slice2c" -I"$(dirname "$ice")" "$ice" --output-dir "$work/c" --hw-regs "$work/regs" --hw-new-"$lang" "$work/new" ||
        fail "$ice is not an interface in hardware (above)"
    [ "$(ls "$work/regs")" = "$name.regs.json" ] ||
        fail "$ice has the cores $(basename -s .regs.json "$work"/regs/* | tr '\n' ' '): NAME is that of the only one"
    cp "$work"/new/* "$folder"
    cp "$ice" "$folder/$name.ice"
    fill "ip/template/$lang/CMakeLists.txt.in" CMakeLists.txt
    fill ip/template/README.md.in README.md
    fill ip/template/interface/ground.py.in ground.py
    sed -i 's/^Adds an offset, and sums 1..count:/Answers every call with zeros:/' "$folder/README.md"
else
    for file in ip/template/*.in "ip/template/$lang"/*.in; do
        fill "$file" "$(basename "$file" .in | sed "s/^NAME/$name/")"
    done
fi
mv "$folder" ip
folder=ip/$name
# A build folder finds the new one by itself; it runs now, while the folder can still be removed.
if [ -f "$build/build.ninja" ] && ! cmake "$build" >"$build/new-ip.log" 2>&1; then
    rm -r "$folder"
    cmake "$build" >/dev/null 2>&1 || true
    grep -A4 'CMake Error' "$build/new-ip.log" >&2 || true
    fail "the build does not take '$name' (above); nothing was changed"
fi
echo "$folder: $(ls "$folder" | tr '\n' ' ')"
echo "Next: make ip-test IP=$name; a line '$name' in ip/cores.list puts it into the chip; make run CORES=$name calls it by radio"
