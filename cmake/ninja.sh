#!/bin/sh
# SPDX-License-Identifier: MIT
# ninja: builds in a folder, one at a time: two would spoil each other's files. Usage: ninja.sh build-folder argument...
set -eu
build=$1
shift
flock -n "$build" true || echo "waiting for another build in $build ..." >&2
exec flock -o "$build" ninja -C "$build" "$@"
