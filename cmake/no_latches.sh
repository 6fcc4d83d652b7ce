#!/bin/sh
# SPDX-License-Identifier: MIT
#
# no_latches: checks that Verilog from vhdl_to_verilog.sh has no latches.
# Usage: no_latches.sh work-folder entity file.v
set -eu
yosys -q -p "read_verilog $3; hierarchy -top $2; proc
    select -assert-none t:\$dlatch t:\$_DLATCH_*" >"$1/yosys.log" 2>&1 || {
    cat "$1/yosys.log" >&2
    echo "no_latches: $2 has latches, or is not valid Verilog" >&2
    exit 1
}
