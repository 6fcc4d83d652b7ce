#!/bin/sh
# SPDX-License-Identifier: MIT
# make_in: runs a command with make like a user, in a small tree of a test or in the whole source
# tree. Everything that the command would build and install already exists. Usage: make_in.sh
# source-folder tree build-folder verb variable=value...
set -eu
source=$1 build=$3
ICESOC_TREE=$(cd "$2" && pwd)
export ICESOC_TREE
shift 3
unset MAKEFLAGS MFLAGS MAKELEVEL # the make that runs the tests has set these variables
exec make -s -C "$source" BUILD="$build" BUILT=1 "$@"
