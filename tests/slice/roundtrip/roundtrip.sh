#!/bin/sh
# SPDX-License-Identifier: MIT
# roundtrip: slice2c sw-folder work-folder test-folder-of-IceC
# Sends values of random Slice types (SEED) from stock ZeroC Ice through generated C proxies and
# servants to stock Ice and back. The C code is built with sanitizers. Wireshark's ICEP dissector
# must find nothing malformed on either side of the C code.
set -eu
slice2c=$1 sw=$2 work=$3 icec=$4
here=$(dirname "$0")
seed=${SEED:-1}
echo "SEED=$seed"
rm -rf "$work"
mkdir -p "$work"
/usr/bin/python3 "$here/echo.py" generate "$seed" "$work"
"$slice2c" "$work/Random.ice" "$work/Definer.ice" --output-dir "$work"
"$icec/bridge.py" "$work/Random.h" >"$work/bridged.c"
# With COVERAGE_DIR, the program also counts lines. The limits of IceC are large enough for graphs
# and long sequences. -O0 is used because most of the time is spent compiling. Variables without a
# value contain a pattern instead of zeros.
# shellcheck disable=SC2046
cc -O0 -w -ftrivial-auto-var-init=pattern ${COVERAGE_DIR:+--coverage} -fsanitize=address,undefined \
    -fno-sanitize-recover=undefined -DICE_ARENA_BYTES=262144 -DICE_MESSAGE_MAX=65536 \
    -DICE_REPLY_MAX=262144 -DICE_VALUES_MAX=64 -DICE_VALUE_TYPES_MAX=64 \
    -DICE_IDENTITY_MAX=255 -I"$sw/base" -I"$sw/icec" -I"$sw/icec/endpoints" -I"$work" -I"$icec" \
    -o "$work/bridge" "$icec/server.c" "$icec/bridge.c" "$work/bridged.c" "$work"/*_types.c \
    "$work/Random_server.c" "$work/Random_client.c" \
    "$sw"/icec/*.c "$sw"/icec/values/*.c "$sw"/icec/extra/*.c "$sw"/icec/endpoints/tcp_*.c
echo="/usr/bin/python3 $here/echo.py"
# shellcheck disable=SC2086
"$icec/interop.sh" $echo server "$seed" "$work" -- "$here/relay.py" "$work/client.pcap" \
    -- "$work/bridge" -- "$here/relay.py" "$work/server.pcap" -- $echo client "$seed" "$work"
for file in client server; do
    messages=$(tshark -r "$work/$file.pcap" -Y icep -T fields -e icep.message_type 2>/dev/null |
        tr ',' '\n' | grep -c .)
    bad=$(tshark -r "$work/$file.pcap" -Y '_ws.malformed || _ws.unreassembled ||
        (icep && _ws.expert.severity >= error)' 2>/dev/null | head)
    echo "$file: $messages ICEP messages"
    [ -z "$bad" ] || { echo "malformed, according to tshark: $bad" && exit 1; }
    [ "$messages" -ge 1000 ] || exit 1
done
