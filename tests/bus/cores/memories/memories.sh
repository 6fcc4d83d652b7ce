#!/bin/sh
# SPDX-License-Identifier: MIT
# memories: slice2c source-folder work-folder
# Tests that three cores get separate buffers, each aligned to its size, in every order of
# ip/cores.list. Also proves that the buffers of two generated wrappers with such addresses never
# overlap, whatever is written to the wrappers.
set -eu
slice2c=$1 source=$2 work=$3
here=$(cd "$(dirname "$0")" && pwd)
rm -rf "$work"
mkdir -p "$work"
cat >"$work/fillers.ice" <<'ICE'
module Fill {
    sequence<byte> Bytes;
    [":hw"] interface Little { ["hw:long", "hw:max:128"] Bytes fill(byte value); };
    [":hw"] interface Middle { ["hw:long", "hw:max:4096"] Bytes fill(byte value); };
    [":hw"] interface Big { ["hw:long", "hw:max:16384"] Bytes fill(byte value); };
};
ICE
"$slice2c" "$work/fillers.ice" --output-dir "$work/c" --hw-verilog "$work" --hw-regs "$work"
for core in little middle big; do
    printf 'interface = "fillers.ice"\nverilog = ["%s_wrapper.v"]\n' "$core" >"$work/$core.toml"
done
for order in 'little middle big' 'little big middle' 'middle little big' 'middle big little' \
    'big little middle' 'big middle little'; do
    echo "$order" | tr ' ' '\n' >"$work/cores.list"
    "$source/tools/python" -m icesoc.chip.coremap "$work/cores.list" \
        --base "$source/bus/map.regs.json" \
        --core "little=$work/little.toml=$work/little.regs.json" \
        --core "middle=$work/middle.toml=$work/middle.regs.json" \
        --core "big=$work/big.toml=$work/big.regs.json" --output-dir "$work"
    /usr/bin/python3 - "$work/map.regs.json" "$order" <<'PYTHON'
import json, sys
constants = {c["name"]: c["value"] for c in json.load(open(sys.argv[1]))["constants"]}
end = constants["BUFFERS"]
for base, size in sorted((constants["MEMORY_" + name], size) for name, size in (
        ("LITTLE", 128), ("MIDDLE", 4096), ("BIG", 16384))):
    if base < end or base % size:
        sys.exit(f"{sys.argv[2]}: the buffers of {size} bytes are at 0x{base:X}")
    end = base + size
PYTHON
done
# The modules' own assertions are proven elsewhere (formal.bus_*).
yosys -q -l "$work/proof.log" -p "read_verilog $work/little_wrapper.v $work/middle_wrapper.v \
    $source/bus/bus_registers.v $source/bus/bus_wrapper.v; \
    read_verilog -formal -sv $here/memories_proof.v; prep -top memories_proof -nordff; flatten;
    async2sync; dffunmap; chformal -early; setundef -anyseq -undriven; chformal -cover -remove;
    opt_clean; sat -verify -tempinduct -prove-asserts -set-assumes -seq 1 -maxsteps 4" >/dev/null ||
    { tail -40 "$work/proof.log" && exit 1; }
grep -q 'Induction step proven' "$work/proof.log" || { tail -20 "$work/proof.log" && exit 1; }
echo 'memories: apart in every order, and by proof'
