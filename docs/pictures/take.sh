#!/bin/sh
# SPDX-License-Identifier: MIT
#
# take: the pictures of README.md and docs/ from what is in build/: the pages of make regress and make synth, a mission and its page.
# Each has as many colours as fit into 100 KB, at most 64.
# Usage: docs/pictures/take.sh [--from build-folder] [--to folder] [mission|live|utilisation|regression|failure]...
# `make pictures` takes all but the failure, for which a test must have failed.
set -eu
from=build out=docs/pictures
while :; do
    case ${1:-} in
    --from) from=$(readlink -f "$2") ;;
    --to) out=$(readlink -f "$2") ;;
    *) break ;;
    esac
    shift 2
done
script=$(readlink -f "$0")
cd "${script%/*}/../.."
profile=$(mktemp -d)
trap 'rm -rf "$profile"' EXIT
small() { # file
    /usr/bin/python3 - "$1" <<'END'
import os, sys
from PIL import Image
picture = Image.open(sys.argv[1]).convert("RGB")
for colours in (64, 48, 32, 24, 16, 8):
    picture.quantize(colours, dither=Image.Dither.NONE).save(sys.argv[1], optimize=True)
    if os.path.getsize(sys.argv[1]) < 100000:
        sys.exit(print(sys.argv[1], colours, "colours"))
sys.exit(f"take: {sys.argv[1]} has 100 KB with eight colours: show less of it")
END
}
shot() { # picture width height address; the page has three seconds of its own time
    HOME=$profile chromium --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --hide-scrollbars \
        --user-data-dir="$profile/chromium" --virtual-time-budget=3000 --window-size="$2,$3" --screenshot="$(readlink -f "$out")/$1.png" "$4" \
        >"$profile/log" 2>&1 && [ -s "$out/$1.png" ] || {
        cat "$profile/log" >&2
        echo "take: no picture of $4" >&2
        exit 1
    }
    small "$out/$1.png"
}
page() { # file command
    [ -s "$1" ] || {
        echo "take: there is no $1: $2" >&2
        exit 1
    }
    echo "file://$(readlink -f "$1")"
}
[ $# -gt 0 ] || set -- mission live utilisation regression
for picture in "$@"; do
    case $picture in
    utilisation) shot utilisation 1400 1500 "$(page "$from/synth/report.html" 'make synth')#table1/u_modem" ;;
    regression) shot regression 1180 1180 "$(page "$from/regress/report.html" 'make regress')" ;;
    failure) shot failure 1180 900 "$(page "$from/regress/report.html" 'make regress')" ;;
    mission)
        make run SIZE=640x480 OUT="$profile/run" >"$profile/log" 2>&1 || { cat "$profile/log" >&2 && exit 1; }
        cp "$profile/run/after.png" "$out/mission.png"
        small "$out/mission.png"
        ;;
    live) # once the mission has flown; its page stays until it is stopped
        setsid make run LIVE=1 CPU=m3 OUT="$profile/live" >"$profile/live.log" 2>&1 &
        group=$!
        until grep -q 'stays until' "$profile/live.log"; do
            kill -0 $group 2>/dev/null || { cat "$profile/live.log" >&2 && exit 1; }
            sleep 1
        done
        shot live 1280 1300 "$(sed -n 's/^The mission as it runs: //p' "$profile/live.log")"
        kill -- -$group
        ;;
    *)
        sed -n '6,7s/^# \{0,1\}//p' "$script" >&2
        exit 2
        ;;
    esac
done
