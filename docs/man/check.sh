#!/bin/sh
# SPDX-License-Identifier: MIT
#
# check: the plugin's manual page is formatted without a warning, and names every option that the
# plugin's source knows, and its properties and no others.
# Usage: check.sh PAGE source-folder
set -eu
page=$1 source=$2 status=0
say() {
    echo "$page: $*" >&2
    status=1
}
warnings=$(LC_ALL=C.UTF-8 MANWIDTH=100 man --warnings -l "$page" 2>&1 >/dev/null || true)
[ -z "$warnings" ] || say "$warnings"
properties=$(grep -ho 'XBeeAT\.[A-Z][A-Za-z]*' "$source"/*.cpp "$source"/*.h | sort -u)
options=$(sed -n 's/.*find(option).*/&/p' "$source"/*.cpp "$source"/*.h |
    grep -o '"-[-a-z]*"' | head -1 | grep -o -- '-[a-z]')
[ -n "$properties" ] && [ -n "$options" ] || say "no options found in $source"
for word in $properties $options; do
    grep -q -- "$word\b" "$page" || say "'$word' is missing"
done
for word in $(grep -o 'XBeeAT\.[A-Z][A-Za-z]*' "$page" | sort -u); do
    echo "$properties" | grep -qx -- "$word" || say "'$word' is in the page only"
done
exit $status
