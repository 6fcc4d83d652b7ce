#!/bin/sh
# SPDX-License-Identifier: MIT
# set: gives variables of a build folder new values; where CMake refuses them, it prints the reason and keeps the old values.
# Usage: set.sh build-folder -DNAME=value...
set -eu
build=$1
shift
cache=$build/CMakeCache.txt
cp "$cache" "$cache.before"
cmake "$@" "$build" >"$build/set.log" 2>&1 || {
    mv "$cache.before" "$cache"
    sed -n '/^CMake Error/,/^$/p' "$build/set.log" >&2
    exit 1
}
rm "$cache.before"
