#!/bin/sh
# SPDX-License-Identifier: MIT
# diff: source-folder slice2c work-folder
# Tests which changes of registers are reported as breaking, and which as compatible.
set -eu
source=$1 slice2c=$2 work=$3
rm -rf "$work"
mkdir -p "$work/old/ip/a" "$work/old/ip/b" "$work/new/ip/a" "$work/bad/ip/a"
cat >"$work/old/ip/a/a.regs.json" <<'END'
{"block": "a", "doc": "old", "type": "0x4141", "version": "0x0100", "memory_bytes": 1024,
 "registers": [
  {"word": 3, "name": "CONTROL", "access": "ws", "doc": "", "fields": [
    {"name": "START", "lsb": 0, "width": 1, "doc": ""},
    {"name": "MODE", "lsb": 1, "width": 3, "doc": ""}]},
  {"word": 4, "name": "STATUS", "access": "ro", "doc": ""},
  {"word": 5, "name": "LIMIT", "access": "rw", "width": 16, "doc": ""},
  {"word": 8, "page": 32, "name": "KEY", "access": "rw", "doc": ""}],
 "events": [{"name": "DONE", "bit": 0, "doc": ""}, {"name": "LOST", "bit": 1, "doc": ""}]}
END
cat >"$work/old/ip/b/b.ice" <<'END'
module M { [":hw"] interface Gone { void run(int value); }; };
END
run() { # runs contract_diff. Arguments: expected exit status, the two trees
    wanted=$1
    shift
    status=0
    "$source/tools/python" -m icesoc.chip.contract_diff "$slice2c" "$@" >"$work/out" 2>&1 ||
        status=$?
    [ "$status" = "$wanted" ] && ! grep Traceback "$work/out" || { cat "$work/out" &&
        echo "exit status $status" && exit 1; }
}
prints() { printf '%s\n' "$@" | cmp -s - "$work/out" || { cat "$work/out" && echo "is not: $*" &&
    exit 1; }; }

run 0 "$work/old" "$work/old"
prints 'no breaking change'

# Makes every change that breaks the contract.
sed -e 's/0x4141/0x4142/' -e 's/1024/512/' -e 's/"lsb": 1, "width": 3/"lsb": 2, "width": 2/' \
    -e 's/"START"/"BEGIN"/' \
    -e 's/"width": 16/"width": 8/' -e 's/"page": 32/"page": 64/' \
    -e 's/"LIMIT", "access": "rw"/"LIMIT", "access": "ro"/' \
    -e 's/"LOST", "bit": 1/"LOST", "bit": 2/' "$work/old/ip/a/a.regs.json" \
    >"$work/new/ip/a/a.regs.json"
run 1 "$work/old" "$work/new"
prints 'breaking   a: type 0x4141 is 0x4142' \
    'breaking   a: memory_bytes 1024 is 512' \
    'breaking   a: CONTROL.START (word 3, from bit 0) is gone' \
    'breaking   a: CONTROL.MODE moved from word 3, from bit 1 to word 3, from bit 2' \
    'breaking   a: CONTROL.MODE has 2 bits, and had 3' \
    'breaking   a: LIMIT has 8 bits, and had 16' \
    'breaking   a: LIMIT is ro, and was rw' \
    'breaking   a: KEY moved from word 8, PAGE 0x20 to word 8, PAGE 0x40' \
    'breaking   a: EVENT.LOST moved from bit 1 to bit 2' \
    'compatible a: CONTROL.BEGIN (word 3, from bit 0) is new' \
    'breaking   gone: the block is gone' \
    '10 breaking changes'

# Makes every change that is compatible with the contract.
mkdir -p "$work/new/ip/b"
cp "$work/old/ip/b/b.ice" "$work/new/ip/b"
sed -e 's/"old"/"new"/' -e 's/1024/2048/' -e 's/"width": 16/"width": 17/' \
    -e 's/"STATUS", "access": "ro"/"STATUS", "access": "rw"/' \
    -e 's/^  {"word": 4/  {"word": 6, "name": "MORE", "access": "ro", "doc": ""},\n&/' \
    "$work/old/ip/a/a.regs.json" >"$work/new/ip/a/a.regs.json"
run 0 "$work/old" "$work/new"
prints 'compatible a: memory_bytes 1024 is 2048' \
    'compatible a: STATUS is rw, and was ro' \
    'compatible a: LIMIT has 17 bits, and had 16' \
    'compatible a: MORE (word 6) is new' \
    'no breaking change'

# An interface in Slice is also a contract.
sed -i 's/int value/short value/' "$work/new/ip/b/b.ice"
run 1 "$work/old" "$work/new"
grep -q 'breaking   gone: RUN_IN0.VALUE has 16 bits, and had 32' "$work/out" ||
    { cat "$work/out" && exit 1; }

echo '{' >"$work/bad/ip/a/a.regs.json"
run 2 "$work/old" "$work/bad"
grep -q '^contract-diff: ip/a/a.regs.json: ' "$work/out" || { cat "$work/out" && exit 1; }
git -C "$work" init -q
run 2 "$work" nothing
grep -q '^contract-diff: BASE=nothing: expected a commit' "$work/out" ||
    { cat "$work/out" && exit 1; }
git -C "$work" add old && git -C "$work" mv old/ip ip && rm -rf "$work/old"
git -C "$work" -c user.name=t -c user.email=t@t commit -qm old
sed -i 's/"STATUS"/"STATE"/' "$work/ip/a/a.regs.json"
run 1 "$work" HEAD
prints 'breaking   a: STATUS (word 4) is gone' 'compatible a: STATE (word 4) is new' \
    '1 breaking change'
mkdir -p "$work/build/slice"
ln -s "$slice2c" "$work/build/slice"
! "$source/tests/regress/make_in.sh" "$source" "$work" build contract-diff BASE=HEAD \
    >"$work/made" 2>&1 && grep -q '^1 breaking change' "$work/made" ||
    { cat "$work/made" && exit 1; }
echo 'diff: all as expected'
