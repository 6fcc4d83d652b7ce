#!/bin/sh
# SPDX-License-Identifier: MIT
# interop: server-command -- client-command   The server prints its port; the client gets it appended.
set -eu
server=''
while [ "$1" != -- ]; do
    server="$server '$1'"
    shift
done
shift
port=$(mktemp)
trap 'kill $pid 2>/dev/null || true; rm -f "$port"' EXIT
eval "exec $server" >"$port" &
pid=$!
while [ ! -s "$port" ]; do
    kill -0 $pid 2>/dev/null || { echo "the server ended before it listened" && exit 1; }
    sleep 0.05
done
"$@" "$(cat "$port")"
wait $pid
