#!/bin/sh
# SPDX-License-Identifier: MIT
# columns: folder-of-a-core...   Fails if a file of a core has a line of more than 100 columns.
# Tables of a page, and files that the core's author has written, do not count.
set -eu
[ $# -gt 0 ]
status=0
for folder in "$@"; do
    name=$(basename "$folder")
    for file in "$folder/$name".* "$folder/${name}"_* "$folder"/core.toml "$folder"/*.py; do
        [ ! -e "$file" ] || ! grep -nHE '^.{101}' "$file" || status=1
    done
done
exit $status
