#!/bin/sh
# SPDX-License-Identifier: MIT
# c90: source-folder   IceC and its portable transports are C90 to gcc, clang and the Cortex-M3's gcc, with every
# warning an error, in the full and the minimal configuration and with each option turned off alone.
set -eu
sw=$1/sw
warnings='-std=c90 -pedantic -Wall -Wextra -Wconversion -Wno-sign-conversion -Wstrict-prototypes -Wmissing-prototypes
-Wdeclaration-after-statement -Werror -fsyntax-only'
check() { # flags: compiler first
    # shellcheck disable=SC2086
    "$@" $warnings -I"$sw/base" -I"$sw/icec" -I"$sw/link" -I"$sw/icec/endpoints" "$sw"/icec/*.c \
        "$sw/icec/endpoints/xbee_endpoint.c" "$sw/icec/endpoints/loop_endpoint.c"
    echo "C90: $*"
}
for compiler in gcc clang 'arm-none-eabi-gcc -mcpu=cortex-m3 -mthumb -Os'; do
    # shellcheck disable=SC2086
    check $compiler
    # shellcheck disable=SC2086
    check $compiler -DICEC_MINIMAL
done
for option in TASKS CATEGORIES CONTEXTS BATCH ASYNC DETAILS IDS; do
    check gcc -DICEC_$option=0
    check gcc -DICEC_MINIMAL -DICEC_$option=1
done
check gcc -DICEC_NESTING=1
check gcc -DICE_CALLS=1
