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
    for old in "$before"/*; do
        [ -f "$old" ] || continue # at the first build, the folder is empty
        file=$2/${old##*/}
        if cmp -s "$old" "$file"; then touch -r "$old" "$file"; fi
    done
    rm -rf "$before"
fi
