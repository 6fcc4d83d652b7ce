#!/bin/sh
# SPDX-License-Identifier: MIT
# draw: draws every waveform of this folder. Usage: draw.sh wavesvg
set -eu
cd "$(dirname "$0")"
for wave in *.json; do "$1" "$wave" "${wave%.json}.svg"; done
