#!/bin/sh
# SPDX-License-Identifier: MIT
# fuzz: fuzzer work-folder seeds-folder...   RUNS inputs from SEED, beginning with the tests' own Slice files.
set -eu
fuzzer=$1 work=$2
shift 2
here=$(dirname "$0")
rm -rf "$work"
mkdir -p "$work/corpus"
# Cases of the agreement test are many in one file.
for folder in "$@"; do
    find "$folder" -name '*.ice' | while read -r file; do
        awk -v to="$work/corpus/$(basename "$file" .ice)" '/^\/\/ (ok|warning|error): / { n++ } { print > (to "_" n ".ice") }' "$file"
    done
done
cd "$work"
echo "SEED=${SEED:-1}"
exec "$fuzzer" -dict="$here/slice.dict" -seed="${SEED:-1}" -runs="${RUNS:-20000}" -max_len=3000 -timeout=60 -print_final_stats=1 corpus
