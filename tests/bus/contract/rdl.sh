#!/bin/sh
# SPDX-License-Identifier: MIT
# rdl: source-folder generated-folder work-folder
# Tests that the chip's SystemRDL can be converted back to the register descriptions that it was
# made from, and that the chip's IP-XACT has the same registers. Also tests which SystemRDL the
# reader accepts, and its error messages for all other SystemRDL.
set -eu
source=$1 gen=$2 work=$3
rm -rf "$work"
mkdir -p "$work/old/ip" "$work/new"
fail() { echo "rdl: $*" && exit 1; }
rdl() { "$source/tools/python" -m icesoc.regs.rdl "$@" >"$work/log" 2>&1; }

rdl "$gen/icesoc.rdl" "$work/new/ip" || { cat "$work/log" && fail 'the chip was not read'; }
for block in "$work"/new/ip/*.regs.json; do
    name=$(basename "$block")
    old=$work/old/ip/${name%.regs.json}
    mkdir -p "$old"
    for file in $(find "$source/hdl" "$source/ip" "$gen" -name "$name"); do
        cp "$file" "$old"
        [ ! -e "${file%/*}/core.toml" ] || cp "${file%/*}/core.toml" "$old" # has memory_bytes
    done
    [ -f "$old/$name" ] || fail "no block $name"
done
said=$("$source/tools/python" -m icesoc.chip.contract_diff true "$work/old" "$work/new" 2>&1) ||
    true
[ "$said" = 'no breaking change' ] || fail "the result differs from the source: $said"
for file in icesoc.svd icesoc.ipxact.xml; do xmllint --noout "$gen/$file" ||
    fail "$file is not XML"; done
registers=$(grep -c ' @ 0x[0-9A-F]\{1,2\};' "$gen/icesoc.rdl")
[ "$registers" -gt 50 ] &&
    [ "$(xmllint --xpath 'count(//*[local-name()="register"])' "$gen/icesoc.ipxact.xml")" = \
    "$registers" ] ||
    fail "IP-XACT has not the $registers registers of SystemRDL"

cat >"$work/lamp.rdl" <<'RDL'
/* A lamp /* of */
addrmap lamp {
    name = "Lamp // not a comment"; default regwidth = 16; default sw = rw; default hw = r;
    enum colour { red = 0; green = 1; };
    reg state_r { desc = "State"; field { sw = r; hw = w; } BUSY;
        field { sw = r; hw = w; } MODE[2] = 2'b01; };
    reg { field { desc = "Level
        of light"; } LEVEL[7:0] = 8'hFF; field { encode = colour; } COLOUR[10:8]; } CTRL @ 0x2;
    state_r STATE @ 4;
    reg { field { sw = w; hw = r; } W[7:0]; field { sw = r; hw = w; } R[7:0]; } DATA;
    reg { field { woclr; hw = w; } DONE[0:0] = 0;
        field { onwrite = woclr; } OVER[1:1]; } EVENTS @ 8;
};
RDL
"$source/tests/regress/make_in.sh" "$source" "$source" none from-rdl RDL="$work/lamp.rdl" \
    OUT="$work" >"$work/log" 2>&1 || { cat "$work/log" && fail 'the lamp was not read'; }
/usr/bin/python3 - "$work/lamp.regs.json" <<'PYTHON' || fail 'the lamp has other registers'
import json, sys
block = json.load(open(sys.argv[1]))
found = [(r["word"], r["name"], r["access"], r.get("width", 32),
          [(f["name"], f["lsb"], f["width"]) for f in r.get("fields", [])])
         for r in block["registers"]]
wanted = [(4, "CTRL", "rw", 32, [("LEVEL", 0, 8), ("COLOUR", 8, 3)]),
          (5, "STATE", "ro", 32, [("BUSY", 0, 1), ("MODE", 1, 2)]),
          (6, "DATA", "rw", 8, []), (7, "EVENTS", "w1c", 32, [("DONE", 0, 1), ("OVER", 1, 1)])]
if found != wanted or block["type"] != "0x4C41" or block["doc"] != "Lamp // not a comment" \
        or block["registers"][0]["fields"][0]["doc"] != "Level of light":
    sys.exit("%s\nand not\n%s" % (block, wanted))
PYTHON
refused() { # message, SystemRDL
    printf '%b' "$2" >"$work/wrong.rdl"
    ! rdl "$work/wrong.rdl" "$work/wrong" || fail "accepted: $2"
    grep -q -- "$1" "$work/log" || { cat "$work/log" && fail "'$1' is not said: $2"; }
    [ ! -e "$work/wrong" ] || fail "files were written in spite of: $1"
}
refused 'wrong.rdl:2: error: regfile is not part of the flat subset' \
    'addrmap a {\n regfile { } x; };'
refused 'wrong.rdl:1: error: arrays are not' 'addrmap a { reg { field {} b; } x[4]; };'
refused 'parameters are not part of the flat subset' \
    'addrmap a { reg t #(longint N = 1) { field {} b; }; };'
refused 'expected a number, got N' 'addrmap a { reg { field {} b[N:0]; } x; };'
refused 'expected more text, got the end of the text' 'addrmap a { reg { field {} b; } x;'
refused 'x: expected a word from 0 to 15, got 16' 'addrmap a { reg { field {} b; } x @ 0x34; };'
refused 'x has no field' 'addrmap a { reg { } x; };'
refused 'x.b is at bits 39 to 0' 'addrmap a { reg { field {} b[40]; } x; };'
refused 'expected an addrmap' '// nothing\n'
refused 'regwidth: expected' 'addrmap a { reg { regwidth = 0x 16; field {} b; } x; };'
refused "expected a number, got 2'b3" "addrmap a { reg { field {} b = 2'b3; } x; };"
refused 'an addrmap of the file has no name' 'addrmap { reg { field {} b; } x; };'
refused 'two addrmaps have the same name' \
    'addrmap a { reg { field {} b; } x; }; addrmap A { reg { field {} b; } x; };'
refused 'expected a name, got' 'addrmap { reg { field {} b; } x; } "../a";'
refused 'b: duplicate name, first on line 1' 'addrmap a { reg { field {} b; field {} b; } x; };'
refused 'has no address' 'addrmap A_PAGES { reg { field {} b; } x; };
    addrmap top { addrmap { reg { field {} b; } x; } A; };'
refused "expected text in UTF-8" "\\0377"
refused 'nested too deeply' "$(printf 'addrmap a {%.0s' $(seq 1500))"
! rdl "$work/none.rdl" "$work" && grep -q 'No such file' "$work/log" ||
    fail 'a file that is not there is not said'
echo 'rdl: all as expected'
