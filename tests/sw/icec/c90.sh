#!/bin/sh
# SPDX-License-Identifier: MIT
# c90: source-folder
# Checks that gcc, clang and the Cortex-M3's gcc compile IceC and its portable transports as C90
# without warnings, for the full and the minimal run time.
set -eu
sw=$(realpath "$1/sw")
warnings='-std=c90 -pedantic -Wall -Wextra -Wconversion -Wno-sign-conversion -Wstrict-prototypes
-Wmissing-prototypes -Wdeclaration-after-statement -Werror -fsyntax-only'
full=$(echo "$sw"/icec/*.c "$sw"/icec/values/*.c "$sw"/icec/extra/*.c)
minimal=@minimal/sources.txt # paths relative to $sw
cd "$sw"
check() { # check SOURCES FLAGS: compiles the sources; the first of FLAGS is the compiler
    sources=$1
    shift
    # shellcheck disable=SC2086
    "$@" $warnings -I"$sw/base" -I"$sw/icec" -I"$sw/minimal" -I"$sw/link" \
        -I"$sw/icec/endpoints" $sources "$sw/icec/endpoints/xbee_endpoint.c"
    echo "C90: $*"
}
for compiler in gcc clang 'arm-none-eabi-gcc -mcpu=cortex-m3 -mthumb -Os'; do
    # shellcheck disable=SC2086
    check "$full" $compiler
    # shellcheck disable=SC2086
    check "$minimal" $compiler -DICEC_MINIMAL
done
check "$full" gcc -DICE_NESTING=1 -DICE_RESULT_MAX=512 -DICE_REQUEST_MAX=300
check "$full" gcc -DICE_CALLS=1
check "$full" gcc -DICE_TRANSPORTS=2
