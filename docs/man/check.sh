#!/bin/sh
# SPDX-License-Identifier: MIT
#
# check: a manual page is formatted without a warning, and names every option of its program (and no
# other), or every option and property that the plugin's source knows.
# Usage: check.sh PAGE program|source-folder
set -eu
page=$1 subject=$2 status=0
say() {
    echo "$page: $*" >&2
    status=1
}
warnings=$(LC_ALL=C.UTF-8 MANWIDTH=100 man --warnings -l "$page" 2>&1 >/dev/null || true)
[ -z "$warnings" ] || say "$warnings"
if [ -d "$subject" ]; then
    wanted=$(sed -n 's/.*find(option).*/&/p' "$subject"/*.cpp "$subject"/*.h |
        grep -o '"-[-a-z]*"' | head -1 | grep -o -- '-[a-z]'
        grep -ho 'XBeeAT\.[A-Z][A-Za-z]*' "$subject"/*.cpp "$subject"/*.h | sort -u)
    found=$(grep -o 'XBeeAT\.[A-Z][A-Za-z]*' "$page" | sort -u)
else
    wanted=$("$subject" --help 2>&1 | grep -o -- '--[a-z-]*' | sort -u)
    found=$(grep -o -- '--[a-z-]*[a-z]' "$page" | sort -u)
fi
[ -n "$wanted" ] || say "no options found in $subject"
for word in $wanted; do
    grep -q -- "$word\\b" "$page" || say "'$word' is missing"
done
for word in $found; do
    echo "$wanted" | grep -qx -- "$word" || say "'$word' is in the page only"
done
exit $status
