#!/bin/sh
# SPDX-License-Identifier: MIT
# names: source-folder work-folder slice2c
# Tests that `./icesoc core new` and `core remove` reject wrong names without changing the tree.
# This is a shell script because each case is a command and its output.
set -eu
source=$1 ip=$1/ip work=$2 slice2c=$3
rm -rf "$work"
mkdir -p "$work/bus" "$work/hdl/modem" "$work/ip/old" "$work/sw" "$work/testbench" "$work/synth"
export ICESOC_TREE="$work"
new() { "$source/icesoc" core new --built --build build "$@"; }
remove() { "$source/icesoc" core remove --built --build build "$@"; }
: >"$work/ip/cores.list"
echo '{}' >"$work/hdl/modem/modem.regs.json"
echo 'module bus_thing (' >"$work/bus/other.v"
echo 'entity Vhdl_Thing is' >"$work/ip/old/other.vhd"
# The commands must not use a repository that contains the work folder.
export GIT_CEILING_DIRECTORIES="$(dirname "$work")"
before=$(ls "$work/ip")
refused() { # message, arguments
    words=$1
    shift
    status=0
    new "$@" >"$work/log" 2>&1 || status=$?
    [ $status = 1 ] || [ $status = 2 ] || { echo "exit status $status: $*" && exit 1; }
    grep -q -- "$words" "$work/log" || { cat "$work/log" && echo "'$words' is not said: $*" &&
        exit 1; }
    [ "$(ls "$work/ip")" = "$before" ] || { echo "files were written: $*" && exit 1; }
}
refused './icesoc core new low_pass'
refused './icesoc core new low_pass' '' --lang verilog
refused '--lang: expected verilog or vhdl' fir
refused "got 'c'" fir --lang c
refused 'small letters' Fir --lang verilog
refused 'small letters' 2fir --lang verilog
refused 'small letters' a_b --lang verilog
refused 'small letters' ../fir --lang verilog
refused 'small letters' 'fir x' --lang verilog
refused 'reserved' signal --lang vhdl
refused 'reserved' module --lang verilog
refused 'reserved' template --lang verilog
refused 'already exists' old --lang verilog
refused 'modem.regs.json' modem --lang verilog
refused 'a module' bus_thing --lang verilog
refused 'a module' vhdl_thing --lang verilog
# An interface that a user has written.
mkdir -p "$work/build/slice"
printf '#!/bin/sh\nexec "%s" "$@"\n' "$slice2c" >"$work/build/slice/slice2c"
chmod +x "$work/build/slice/slice2c"
refused "cannot read .*none.ice" fir --lang verilog --ice "$work/none.ice"
printf '#include <b.ice>\n #  include "c/d.ice"\n' >"$work/a.ice"
refused 'a.ice includes b.ice c/d.ice: expected a Slice file without' fir --lang verilog \
    --ice "$work/a.ice"
echo 'module M { interface Fir { void f(); }; };' >"$work/a.ice"
refused 'no core could be generated because of the errors above' fir --lang verilog \
    --ice "$work/a.ice"
echo 'module M { [":hw"] interface Fir { void f(string s); }; };' >"$work/a.ice"
refused "^$work/a.ice:1:" fir --lang verilog --ice "$work/a.ice"
echo 'module M { [":hw"] interface Iir { void f(); }; };' >"$work/a.ice"
refused 'core fir: expected the interface Fir, got the interface of a core iir; rename' fir \
    --lang verilog --ice "$work/a.ice"
echo 'module M { [":hw"] interface Fir {void f();}; [":hw"] interface Iir {void f();}; };' \
    >"$work/a.ice"
refused 'expected one interface with \[":hw"\], got those of fir iir' fir --lang verilog \
    --ice "$work/a.ice"
echo '/* [":hw"] interface X */ module M { module N { [":hw"] interface LowPass {
    ["hw:long"] int f(short a); }; }; };' >"$work/a.ice"
for language in verilog vhdl; do
    new low_pass --lang $language --ice "$work/a.ice" >/dev/null
    grep -q "low_pass_wrapper" "$work"/ip/low_pass/low_pass.v* &&
        grep -q 'import M  #' "$work/ip/low_pass/ground.py" &&
        grep -qF 'core = M.N.LowPassPrx.checkedCast(proxy("low_pass"))' \
            "$work/ip/low_pass/ground.py" &&
        grep -q 'core.f(a)' "$work/ip/low_pass/low_pass_test.cpp" ||
        { echo 'ip/low_pass is not made from its interface' && exit 1; }
    echo 'low_pass identity=a' >"$work/ip/cores.list"
    [ $language = vhdl ] || echo 'fir b_i=low_pass.c_o' >>"$work/ip/cores.list"
    [ $language = vhdl ] || { ! remove low_pass 2>"$work/log" &&
        grep -q 'inputs of fir' "$work/log" && sed -i 2d "$work/ip/cores.list"; }
    remove low_pass >/dev/null
    [ ! -e "$work/ip/low_pass" ] && [ ! -s "$work/ip/cores.list" ] ||
        { echo 'rm-ip left something' && exit 1; }
done
# A core that drives inputs of another core can be removed only if these inputs are marked as
# internal, because otherwise they would become pins.
new low_pass --lang verilog --ice "$work/a.ice" >/dev/null
mkdir -p "$work/ip/taker"
touch "$work/ip/taker/taker.v" "$work/ip/taker/taker.regs.json"
cat >"$work/ip/taker/core.toml" <<'END'
registers = "taker.regs.json"
verilog = ["taker.v"]
pins = [{name = "b_i", internal = true}, {name = "c_i", width = 2}]
END
# A byte order mark, which editors of Windows add, and a form feed do not change the list.
printf '\357\273\277taker c_i=low_pass.c_o b_i=low_pass.b_o # a\ftaker\nlow_pass\n' \
    >"$work/ip/cores.list"
! remove low_pass 2>"$work/log" && grep -q 'inputs of taker' "$work/log" ||
    { echo 'rm-ip makes a pin of an input' && exit 1; }
printf '# Jos\351\nlow_pass\n' >"$work/ip/cores.list"
! remove low_pass 2>"$work/log" && grep -q 'cores.list: expected text in UTF-8' "$work/log" ||
    { echo 'rm-ip reads a list in Latin-1' && exit 1; }
printf '\357\273\277low_pass\ntaker b_i=low_pass.b_o\n' >"$work/ip/cores.list"
remove low_pass >/dev/null
[ "$(cat "$work/ip/cores.list")" = 'taker b_i=low_pass.b_o' ] ||
    { echo 'rm-ip keeps the core, or takes another line' && exit 1; }
rm -r "$work/ip/taker"
for wrong in '' missing template ../bus; do
    ! remove "$wrong" 2>"$work/log" &&
        grep -q 'expected the name of a core\|ip/.* not found' "$work/log" ||
        { echo "rm-ip takes '$wrong'" && exit 1; }
done
# A core with uncommitted changes is not removed, unless this is forced.
(cd "$work" && git init -q . && new fir --lang verilog >"$work/log")
grep -q './icesoc core test fir' "$work/log" && [ -f "$work/ip/fir/fir.v" ] &&
    ! grep -rq '@[A-Z]*@' "$work/ip/fir" || { echo 'ip/fir is not what it should be' && exit 1; }
! remove fir 2>"$work/log" && grep -q 'uncommitted' "$work/log" && [ -d "$work/ip/fir" ] ||
    { echo 'rm-ip loses work' && exit 1; }
remove fir --force >/dev/null
[ ! -e "$work/ip/fir" ] || { echo 'rm-ip FORCE=1 left it' && exit 1; }
rm -rf "$work/.git" "$work/build"
# If the build cannot be configured with a new core, the core is removed again.
mkdir "$work/build"
touch "$work/build/build.ninja"
refused 'nothing was changed' fir --lang verilog
# The same after Ctrl-C while CMake runs; the fake CMake sends the signal.
mkdir "$work/bin"
printf '#!/bin/sh\nkill -INT $PPID\nsleep 60\n' >"$work/bin/cmake"
chmod +x "$work/bin/cmake"
status=0
(PATH=$work/bin:$PATH; cd "$work" && new fir --lang verilog >/dev/null 2>&1) || status=$?
[ $status = 130 ] && [ ! -e "$work/ip/fir" ] ||
    { echo "after Ctrl-C (exit status $status) ip/fir is left" && exit 1; }
rm -r "$work/build" "$work/bin"
echo 'names: all as expected'
