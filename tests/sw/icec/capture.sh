#!/bin/sh
# SPDX-License-Identifier: MIT
# capture: file least   Wireshark's ICEP dissector finds at least `least` messages in the capture,
#                       and nothing malformed. Compressed ones (which IceC refuses) it cannot look
#                       into.
set -eu
file=$1 least=$2
command -v tshark >/dev/null || { echo "capture: tshark is missing; run 'make setup'" >&2 &&
    exit 1; }
messages=$(tshark -r "$file" -Y icep -T fields -e icep.message_type 2>/dev/null | tr ',' '\n' |
    grep -c . || true)
bad=$(tshark -r "$file" \
    -Y 'icep.compression_status != 2 && (_ws.malformed || _ws.unreassembled || (icep && _ws.expert.severity >= error))' 2>/dev/null)
echo "capture: $messages ICEP messages"
[ -z "$bad" ] || { echo "malformed, says tshark:" && echo "$bad" | head && exit 1; }
[ "$messages" -ge "$least" ] || { echo "fewer than the $least expected" && exit 1; }
