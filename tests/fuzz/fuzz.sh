#!/bin/sh
# SPDX-License-Identifier: MIT
#
# fuzz: runs a libFuzzer target for a fixed number of inputs. Usage: fuzz.sh program seed-folder
# RUNS=1000000 goes on for longer, SEED=7 takes other inputs; a failing input is left in the build folder.
set -eu
cd "$(dirname "$1")"
mkdir -p "$1.found"
exec "$1" -runs="${RUNS:-20000}" -seed="${SEED:-1}" -max_len=1024 -verbosity=0 -print_final_stats=1 \
    -artifact_prefix="$1.failed-" "$1.found" "$2"
