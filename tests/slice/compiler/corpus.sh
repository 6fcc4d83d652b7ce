#!/bin/sh
# SPDX-License-Identifier: MIT
# corpus: writes the inputs for the fuzzer of the compiler: every Slice file of the tests, and each
# case of the agreement test as a file. Also writes <folder>.dict next to the folder, with the words
# of Slice. Usage: corpus.sh output-folder source-folder
set -eu
rm -rf "$1"
mkdir -p "$1"
grep -o '"[A-Za-z][A-Za-z]*"' "$2/../../slice/front/symbols.cpp" >"$1.dict"
find "$2" -name '*.ice' | while read -r file; do
    awk -v to="$1/$(basename "$file" .ice)" \
        '/^\/\/ (ok|warning|error): / { n++ } { print > (to "_" n ".ice") }' "$file"
done
