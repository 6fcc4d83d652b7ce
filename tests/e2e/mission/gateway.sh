#!/bin/sh
# SPDX-License-Identifier: MIT
#
# gateway: checks that stock Ice clients in C++ and Python can call the UAV through icesoc-gateway.
# The simulator starts this script.
# Usage: gateway.sh build-folder device guard-time out-folder [options of the gateway]
set -eu
build=$1 device=$2 guard=$3 out=$4
shift 4
"$build/ground/icesoc-gateway" --device "$device" --guard "$guard" --listen 127.0.0.1:0 --trace 1 \
    "$@" >"$out/gateway" 2>&1 &
gateway=$!
trap 'kill $gateway 2>/dev/null || true' EXIT
port=''
while [ -z "$port" ]; do
    kill -0 $gateway || { cat "$out/gateway" && exit 1; }
    sleep 0.1
    port=$(sed -n 's/.*port \([0-9]*\) leads.*/\1/p' "$out/gateway")
done
proxy="hwengine1:tcp -h 127.0.0.1 -p $port -t 120000"
"$build/sw/ground/ground_ping" "$proxy" 5 >"$out/cpp" 2>&1 &
first=$!
/usr/bin/python3 - "$proxy" <<'EOF'
import sys
import Ice
with Ice.initialize(["--Ice.Default.InvocationTimeout=300000"]) as communicator:
    proxy = communicator.stringToProxy(sys.argv[1])
    for i in range(5):
        proxy.ice_ping()
    assert proxy.ice_id() == "::Autopilot::HwProcessingEngine", proxy.ice_id()
EOF
wait $first || { cat "$out/cpp" && exit 1; }
grep -q 'type: ::Autopilot::HwProcessingEngine' "$out/cpp"
kill -INT $gateway
wait $gateway
grep -q 'messages out' "$out/gateway"
trap - EXIT
