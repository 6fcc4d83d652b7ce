#!/bin/sh
# SPDX-License-Identifier: MIT
# make_in: runs a command by make, as a user does, in a test's own small tree or in the whole one;
# what it would build and install is there already.
# Usage: make_in.sh source-folder tree build-folder verb variable=value...
set -eu
source=$1 build=$3
ICESOC_TREE=$(cd "$2" && pwd)
export ICESOC_TREE
shift 3
unset MAKEFLAGS MFLAGS MAKELEVEL # of the make that runs the tests
exec make -s -C "$source" BUILD="$build" BUILT=1 "$@"
