#!/bin/sh
# SPDX-License-Identifier: MIT
# received: slice2c sw-folder work-folder   A class that a file only declares, and an interface by
# value, are received.
set -eu
slice2c=$1 sw=$2 work=$3
here=$(cd "$(dirname "$0")" && pwd)
rm -rf "$work"
mkdir -p "$work"
for file in Declared Definer; do "$slice2c" "$here/$file.ice" --output-dir "$work" 2>/dev/null; done
cd "$work"
# shellcheck disable=SC2046 # a list of words
gcc -std=c90 -pedantic -Wall -Wextra -Werror -ffunction-sections -fdata-sections -Wl,--gc-sections \
    -I. -I"$sw/base" -I"$sw/icec" \
    "$here/received.c" ./*_types.c "$sw"/icec/ice_value*.c "$sw"/icec/ice_stream.c \
    "$sw"/icec/ice_slice.c \
    "$sw"/icec/ice_option.c -o received
./received
