#!/bin/sh
# SPDX-License-Identifier: MIT
# run_vhdl: GHDL vectors-program folder file.vhd ...   Runs entity vision_tb; it stops with a failure.
# COVERAGE_DIR: GHDL counts the lines that ran into a file there.
set -eu
ghdl=$1 vectors=$2 work=$3
shift 3
rm -rf "$work"
mkdir -p "$work"
"$vectors" "$work" "${SEED:-1}"
"$ghdl" -a --std=08 --workdir="$work" "$@"
cd "$work"
# numeric_std warns of every value that is undefined before the pipeline is full.
status=0
"$ghdl" --elab-run --std=08 --workdir="$work" ${COVERAGE_DIR:+--coverage} vision_tb --assert-level=error >log 2>&1 || status=$?
grep -v metavalue log || true
[ -z "${COVERAGE_DIR:-}" ] || mv coverage-*.json "$COVERAGE_DIR/vision-vhdl.json"
exit $status
