#!/bin/sh
# SPDX-License-Identifier: MIT
# interop: command -- command ...
#
# Starts the commands in order. Each command prints its port, which becomes the last argument of the
# next command. If the last command fails, its exit status is returned. Otherwise the script waits
# for the first command, which the last command must end, and returns its exit status.
set -eu
work=$(mktemp -d)
pids=''
# shellcheck disable=SC2086
trap 'kill $pids 2>/dev/null || true; rm -rf "$work"' EXIT
trap 'exit 130' INT TERM HUP
first='' port='' command=''
start() {
    eval "exec $command $port" >"$work/port" &
    pids="$pids $!"
    first=${first:-$!}
    while [ ! -s "$work/port" ]; do
        kill -0 $! 2>/dev/null || { echo "$command ended before it listened" && exit 1; }
        sleep 0.05
    done
    port=$(head -n 1 "$work/port")
    command='' && rm "$work/port"
}
for word in "$@"; do
    if [ "$word" = -- ]; then
        start
    else
        command="$command '$word'"
    fi
done
eval "$command $port"
wait "$first"
