#!/bin/sh
# SPDX-License-Identifier: MIT
#
# unchanged: gives C++ files that a generator wrote again with the same content their earlier time,
# so that only what depends on a changed file is compiled again.
#
#   unchanged.sh save FOLDER
#   (the generator writes files in FOLDER)
#   unchanged.sh restore FOLDER
set -e
before=$2.before
if [ "$1" = save ]; then
    rm -rf "$before"
    mkdir -p "$2" "$before"
    find "$2" -maxdepth 1 \( -name "*.cpp" -o -name "*.h" \) -exec cp -p -t "$before" {} +
else
    # Three programs for all files; two for each file took 0.1 s after an edit of the chip.
    LC_ALL=C diff -qs "$before" "$2" |
        sed -n 's/^Files \(.*\) and .* are identical$/\1/p' | xargs -r mv -t "$2"
    rm -rf "$before"
fi
