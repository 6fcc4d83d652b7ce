#!/bin/sh
# SPDX-License-Identifier: MIT
# make_in: runs a command with make, as a user does, in a test's small tree or in the whole one; the
# files that it would build and install already exist.
# Usage: make_in.sh source-folder tree build-folder verb variable=value...
set -eu
source=$1 build=$3
ICESOC_TREE=$(cd "$2" && pwd)
export ICESOC_TREE
shift 3
unset MAKEFLAGS MFLAGS MAKELEVEL # set by the make that runs the tests
exec make -s -C "$source" BUILD="$build" BUILT=1 "$@"
