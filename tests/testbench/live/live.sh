#!/bin/sh
# SPDX-License-Identifier: MIT
# live: source-folder build-folder case out-folder   The page of a mission in headless Chromium, or its errors.
set -eu
source=$1 build=$2 case=$3 out=$4
rm -rf "$out"
mkdir -p "$out"
live=$source/testbench/live/live.py
fail() {
    cat "$out/log" 2>/dev/null || true
    echo "live: $*" >&2
    exit 1
}
has() { grep -q -- "$1" "$out/dom.html" || fail "the page lacks '$1' (see $out/dom.html)"; }
case $case in
mission)
    "$source/icesoc" run --built --build "$build" --size 96x64 --guard 20 --cpu m3 --out "$out" --live >"$out/log" 2>&1 &
    run=$!
    trap 'kill $(ps -o pid= --ppid $run) $run 2>/dev/null || true' EXIT
    while ! grep -q 'The page stays' "$out/log"; do
        kill -0 $run 2>/dev/null || fail "the mission failed"
        sleep 0.2
    done
    url=$(sed -n 's,.*\(http://127.0.0.1:[0-9]*/\).*,\1,p' "$out/log")
    # No name is resolved: resources of other hosts would be missing, and reported in the log.
    HOME=$out timeout 120 chromium --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --user-data-dir="$out/chromium" \
        --host-resolver-rules='MAP * ~NOTFOUND, EXCLUDE 127.0.0.1' --window-size=1280,1500 --virtual-time-budget=4000 \
        --enable-logging=stderr --dump-dom "$url" >"$out/dom.html" 2>"$out/chromium.log" || fail "chromium: $(tail -3 "$out/chromium.log")"
    ! grep -E 'CONSOLE.*(rror|NOT_RESOLVED)' "$out/chromium.log" || fail "the page has errors"
    has 'the mission is over'
    has '<p id="flight">size 96x64, cpu m3, guard 20</p>'
    has 'hwengine1.getResult()'
    has 'Station.vehicleState(uptimeMs'
    has '<td>THRESHOLD</td><td class="n">0x00000018</td>'
    has '>WIDTH 96</span>.*>HEIGHT 64</span>' # fields of the vision core's FRAME_SIZE
    has '>DONE cleared</span>' # an event of the vision core, to which the firmware wrote a one
    has 'y="[0-9]*">UAV_radioTask</text>'
    has 'the result equals the C++ reference, bit by bit'
    has 'corners, the strongest'
    has '<text x="0" y="[0-9]*">vision</text>'
    has '<title>hwengine1.getResult(): until [0-9.]* s</title>'
    has 'id="phase" role="status" class="good"'
    # The flight as JSON Lines: all packets, and the core's end as an event.
    python3 - "$out" <<'PY' || fail "events.jsonl is not the flight"
import json, sys
events = [json.loads(line) for line in open(sys.argv[1] + "/events.jsonl")]
whole = json.loads(open(sys.argv[1] + "/flight.jsonl").readlines()[-1])["end"]
packets = [e for e in events if "packet" in e]
assert (len(packets), sum(e["lost"] for e in packets)) == (whole["packets"], whole["lost"]), (len(packets), whole)
assert {e["from"] for e in packets} == {"ground", "uav"}
assert any(e.get("slot", 0) >= 2 and e["events"] for e in events), "no core's event"
assert sum(sum(e["accesses"].values()) for e in events if "accesses" in e) > 100
PY
    drawn=$(sed -n 's/.*data-features="\([0-9]*\)".*/\1/p' "$out/dom.html")
    wanted=$(python3 -c 'import json,sys; print([len(r["features"]) for r in map(json.loads, open(sys.argv[1])) if "features" in r][-1])' "$out/calls.jsonl")
    [ "$drawn" = "$wanted" ] || fail "$drawn corners drawn, $wanted were found"
    # As it stands, without its script.
    cp "$source"/testbench/live/page/live.css "$source"/testbench/page/common.css "$out"
    sed 's,<script.*</script>,,' "$out/dom.html" >"$out/still.html"
    "$source/tests/look.py" "$out/still.html" || fail "the page's looks"
    ! grep -En '(https?:)?//[a-z]' "$source"/testbench/live/page/*.html "$source"/testbench/live/page/*.css || fail "the page names another host"
    ;;
errors)
    expect() { # text, then the command
        text=$1
        shift
        ! timeout 20 "$@" >"$out/log" 2>&1 || fail "it succeeded; expected: $text"
        grep -q -- "$text" "$out/log" || fail "expected: $text"
    }
    "$live" --help | grep -q -- --registers
    expect 'cannot read' "$live" --dir "$out" --registers "$out/none"
    expect 'required' "$live" --dir "$out"
    "$live" --dir "$out" --registers "$build/gen/registers.list" >"$out/first" &
    first=$!
    trap 'kill $first 2>/dev/null || true' EXIT
    while ! grep -q 127.0.0.1 "$out/first" 2>/dev/null; do kill -0 $first || fail "the page has ended"; sleep 0.1; done
    port=$(sed -n 's,.*127.0.0.1:\([0-9]*\)/.*,\1,p' "$out/first")
    expect 'is the port taken' "$live" --dir "$out" --registers "$build/gen/registers.list" --port "$port"
    expect 'is the port taken' "$source/icesoc" run --built --build "$build" --size 96x64 --out "$out/unflown" --port "$port"
    [ ! -e "$out/unflown/status" ] || fail "it flies without its page"
    # Nothing has run in this folder yet: the page still answers; and only on the loopback interface.
    python3 - "$port" "$out" <<'PY'
import json, sys, urllib.request, urllib.error
base = "http://127.0.0.1:%s/" % sys.argv[1]
state = json.load(urllib.request.urlopen(base + "state"))
assert state["calls"] == [] and state["slots"] == [] and not state["frame"], state
# Other names of this address, malformed rows, and clients that are slow, endless or say nothing.
import http.client, socket
port = int(sys.argv[1])
def status(headers):
    c = http.client.HTTPConnection("127.0.0.1", port, timeout=60)
    c.request("GET", "/live.js", headers=headers)
    return c.getresponse().status
ours = "127.0.0.1:%d" % port
assert status({}) == 200
assert status({"Host": "evil.example:%d" % port}) == 403
assert status({"Host": ours, "HOST": "evil.example"}) == 403
assert status({"Range": "bytes=" + ",".join("0-%d" % i for i in range(400, 800))}) == 200, "the whole of it"
def talk(data):
    with socket.create_connection(("127.0.0.1", port), timeout=60) as s:
        s.sendall(data)
        return s.recv(1000)
assert b" 400 " in talk(b"EHLO\r\n\r\n")
assert b" 405 " in talk(b"POST /state HTTP/1.1\r\nHost: %s\r\n\r\n" % ours.encode())
endless = socket.create_connection(("127.0.0.1", port))
try:
    for i in range(10000):
        endless.sendall(b"GET / HTTP/1.1\r\n" + b"A: b\r\n" * 1000)
    assert False, "a request without an end"
except ConnectionError:
    pass
with open(sys.argv[2] + "/calls.jsonl", "wb") as f:
    f.write(b'7\n[1, 2]\n"text"\n{"what": "\xff"}\n{"at": 1.0, "who": "a", "what": "b"}\n{"half')
state = json.load(urllib.request.urlopen(base + "state"))
assert [c["who"] for c in state["calls"]] == ["a"], state
crowd = [socket.create_connection(("127.0.0.1", port)) for i in range(400)]
for s in crowd[-20:]:
    s.send(b"GET / HTTP/1.1\r\nHost: ")
assert status({}) == 200
for s in crowd:
    s.close()
for path, status in (("", 200), ("live.js", 200), ("frame.png", 404), ("../main.cpp", 404)):
    try:
        got = urllib.request.urlopen(base + path).status
    except urllib.error.HTTPError as e:
        got = e.code
    assert got == status, (path, got)
PY
    kill -TERM $first
    wait $first
    trap - EXIT
    ;;
esac
