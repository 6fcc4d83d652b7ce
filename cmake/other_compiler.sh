#!/bin/sh
# SPDX-License-Identifier: MIT
#
# other_compiler.sh: runs another compiler than the one that CMake names, as launcher of a target.
#
#     other_compiler.sh WORD... -- COMPILER ARGUMENT...    runs WORD... ARGUMENT...
words=
while [ "$1" != -- ]; do
    words="$words $1"
    shift
done
shift 2
exec $words "$@"
