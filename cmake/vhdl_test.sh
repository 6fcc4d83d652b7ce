#!/bin/sh
# SPDX-License-Identifier: MIT
# vhdl_test: runs the entity <core>_tb under GHDL, and stops at its first failure.
# Usage: vhdl_test.sh core GHDL vectors-program folder file.vhd...
# vectors-program: gets the folder and SEED as arguments, and writes the test bench's input into
# the folder
# COVERAGE_DIR: folder for GHDL's coverage file, which lists the lines that ran
# WAVE: file for a waveform (*.fst)
set -eu
core=$1 ghdl=$2 vectors=$3 work=$4
shift 4
rm -rf "$work"
mkdir -p "$work"
"$vectors" "$work" "${SEED:-1}"
"$ghdl" -a --std=08 --workdir="$work" "$@"
cd "$work"
# numeric_std would warn about every value that is undefined until the pipeline is full.
status=0
"$ghdl" --elab-run --std=08 --workdir="$work" ${COVERAGE_DIR:+--coverage} "${core}_tb" \
    ${WAVE:+"--fst=$WAVE"} --assert-level=error --ieee-asserts=disable || status=$?
[ $status = 0 ] || echo "$core: vectors of SEED=${SEED:-1}"
[ -z "${COVERAGE_DIR:-}" ] || mv coverage-*.json "$COVERAGE_DIR/$core-vhdl.json"
exit $status
