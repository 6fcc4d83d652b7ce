#!/bin/sh
# SPDX-License-Identifier: MIT
# configure: makes a build folder for the tree in the current folder, unless there is one. CMake refuses a folder that was made
# for another place (the tree was moved, renamed or copied): it is removed first. Usage: configure.sh build-folder [cmake-argument...]
set -eu
build=$1
shift
mkdir -p "$build" 2>/dev/null || true
[ -w "$build" ] || {
    echo "you may not write in $build, where the build goes: take a clone of your own, or BUILD=a folder that is yours" >&2
    exit 1
}
kept=${XDG_CACHE_HOME:-${HOME-}/.cache}
mkdir -p "$kept" 2>/dev/null && [ -w "$kept" ] || {
    echo "you may not write in $kept, where what is fetched and compiled is kept: set XDG_CACHE_HOME to a folder that is yours" >&2
    exit 1
}
cache=$build/CMakeCache.txt
if [ -f "$cache" ]; then
    home=$(sed -n 's/^CMAKE_HOME_DIRECTORY:INTERNAL=//p' "$cache")
    if ! [ "$home" -ef . ]; then
        echo "$build was made for the tree in $home: made anew" >&2
        rm -rf "$build"
    fi
fi
[ -f "$build/build.ninja" ] || exec cmake -S . -B "$build" -G Ninja "$@"
