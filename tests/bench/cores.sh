#!/bin/sh
# SPDX-License-Identifier: MIT
#
# cores: what the cores' block tests measure, beside what a memory port gives. Usage: cores.sh build-folder output.json [--brief]
# A port moves 8 bytes a clock in each direction (docs/memory.md); the fabric's clock is 100 MHz.
set -eu
case ${1:-} in -h | --help | '') sed -n '4,5s/^# //p' "$0" && exit 0 ;; esac
build=$1 json=$2
entries=''
# name, test, case, pattern of the figure, bytes a clock for that figure
measure() {
    [ -x "$build/$2" ] || return 0 # a core that is not there
    value=$("$build/$2" --gtest_filter="$3" | sed -n "$4" | head -1)
    [ -n "$value" ] || { echo "cores: $2 says nothing of $1" >&2 && exit 1; }
    bytes=$(echo "$value" | awk "{printf \"%.3f\", $5}")
    line=$(echo "$bytes" | awk '{printf "%.1f MB/s at 100 MHz, %.1f %% of the port", $1 * 100, $1 / 8 * 100}')
    printf '%-34s %s bytes a clock: %s\n' "$1" "$bytes" "$line"
    entries="$entries${entries:+, }{\"name\": \"$1\", \"value\": $bytes, \"unit\": \"bytes a clock\", \"limit\": 8, \"share\": $(echo "$bytes" | awk '{print $1 / 8}'), \"command\": \"make bench\"}"
}
measure 'vision core, frame read' ip/vision/test_ip_vision '*OnePixelAClock*' 's/^\([0-9.]*\) clocks a pixel.*/\1/p' '1 / $1'
measure 'Ascon-AEAD128, each direction' ip/ascon/test_ip_ascon '*Speed*' 's/.*AEAD128 \([0-9.]*\) bytes.*/\1/p' '$1'
measure 'Ascon-Hash256, read' ip/ascon/test_ip_ascon '*Speed*' 's/.*Hash256 \([0-9.]*\).*/\1/p' '$1'
measure 'FIR filter, each direction' ip/fir/test_ip_fir '*OneSampleAClock*' 's/^\([0-9.]*\) clocks a sample.*/\1/p' '2 / $1'
measure 'camera, written' ip/camera/test_ip_camera '*APixelEach*' 's/^\([0-9.]*\) pixels a clock.*/\1/p' '$1'
mkdir -p "$(dirname "$json")"
echo "[$entries]" >"$json"
echo "Written: $json"
