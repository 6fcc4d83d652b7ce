#!/bin/sh
# SPDX-License-Identifier: MIT
# make_in: runs a command of the Makefile as a user does, in a test's own small tree or in the whole one, where everything that
# it would build and install exists already. Usage: make_in.sh source-folder tree build-folder target variable=value...
set -eu
source=$1 tree=$2 build=$3
shift 3
[ "$tree" -ef "$source" ] || for file in Makefile bus/targets.mk ip/targets.mk synth/targets.mk tests/targets.mk; do
    mkdir -p "$(dirname "$tree/$file")"
    cp "$source/$file" "$tree/$file"
done
unset MAKEFLAGS MFLAGS MAKELEVEL # of the make that runs the tests
exec make -s -C "$tree" BUILD="$build" NINJA=true -o "$build/build.ninja" -o setup-tests -o core-folders "$@"
