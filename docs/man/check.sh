#!/bin/sh
# SPDX-License-Identifier: MIT
#
# check: the plugin's manual page is formatted without a warning, and names every option and
# property that the plugin's source knows, and no other. Usage: check.sh PAGE source-folder
set -eu
page=$1 subject=$2 status=0
say() {
    echo "$page: $*" >&2
    status=1
}
warnings=$(LC_ALL=C.UTF-8 MANWIDTH=100 man --warnings -l "$page" 2>&1 >/dev/null || true)
[ -z "$warnings" ] || say "$warnings"
wanted=$(sed -n 's/.*find(option).*/&/p' "$subject"/*.cpp "$subject"/*.h |
    grep -o '"-[-a-z]*"' | head -1 | grep -o -- '-[a-z]'
    grep -ho 'XBeeAT\.[A-Z][A-Za-z]*' "$subject"/*.cpp "$subject"/*.h | sort -u)
found=$(grep -o 'XBeeAT\.[A-Z][A-Za-z]*' "$page" | sort -u)
[ -n "$wanted" ] || say "no options found in $subject"
for word in $wanted; do
    grep -q -- "$word\\b" "$page" || say "'$word' is missing"
done
for word in $found; do
    echo "$wanted" | grep -qx -- "$word" || say "'$word' is in the page only"
done
exit $status
