#!/bin/sh
# SPDX-License-Identifier: MIT
# unchanged: tests that an edit of RTL does not change the times of files of Verilator with
# unchanged content. Usage: unchanged.sh path-of-unchanged.sh work-folder
set -eu
unchanged=$1 work=$2
rm -rf "$work"
mkdir -p "$work"
cd "$work"
# made TEXT...: writes a model of a module with this expression
made() {
    printf 'module m (input wire a_i, input wire b_i, output wire q_o);\nassign q_o = ' >m.v
    printf '%s\n;\nendmodule\n' "$1" >>m.v
    "$unchanged" save "$PWD/model"
    verilator --cc --Mdir model m.v
    "$unchanged" restore "$PWD/model"
}
# newer: lists the files that are newer than the mark
newer() { find model \( -name "*.cpp" -o -name "*.h" \) -newer mark | sort; }
fail() { echo "unchanged: $*" >&2 && newer >&2 && exit 1; }
mark() { touch -d "1 hour ago" model/*.cpp model/*.h && touch -d "1 minute ago" mark; }
made 'a_i & b_i'
[ "$(find model -name "*.cpp")" ] || fail 'no model'
mark
made 'a_i & b_i // a comment'
[ ! "$(newer)" ] || fail 'these files are new after a comment'
made 'a_i | b_i'
[ "$(newer)" ] || fail 'no file is new after another expression'
! newer | grep 'h$' || fail 'a header is new after another expression'
mark
made '~a_i | b_i' && mv mark kept && touch mark
made '~a_i | b_i'
[ ! "$(newer)" ] || fail 'these files are new the second time'
mv kept mark && [ "$(newer)" ] || fail 'the files of an earlier change have lost their times'
[ ! -e model.before ] || fail 'a folder is left'
