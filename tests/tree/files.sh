#!/bin/sh
# SPDX-License-Identifier: MIT
# files: what editors and other tools read. The list of a model's Verilog files is enough to
# elaborate its top, and the list of C and C++ compilations is there.
# Usage: files.sh BUILD
set -eu
seen=0
for list in "$1"/files/*.f; do
    top=$(sed -n 's,^// top: ,,p' "$list")
    verilator --lint-only --no-timing -Wno-lint -Wno-style -Wno-fatal -f "$list" \
        --top-module "$top" || {
        echo "$list does not elaborate $top" && exit 1
    }
    seen=$((seen + 1))
done
grep -q sw/icec "$1/compile_commands.json"
echo "$seen lists"
