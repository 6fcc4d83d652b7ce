#!/bin/sh
# SPDX-License-Identifier: MIT
#
# take: the pictures of README.md from what is in build/: the pages of make regress and make synth, a mission and its page.
# Usage: docs/pictures/take.sh [mission|live|utilisation|regression]...     (all of them, if none is named)
set -eu
cd "$(dirname "$(readlink -f "$0")")/../.."
out=docs/pictures
profile=$(mktemp -d)
trap 'rm -rf "$profile"' EXIT
small() { # file: its colours, no more of them than one sees
    /usr/bin/python3 -c 'import sys; from PIL import Image
Image.open(sys.argv[1]).convert("RGB").quantize(64, dither=Image.Dither.NONE).save(sys.argv[1], optimize=True)' "$1"
    echo "$1"
}
shot() { # picture width height address; the page has three seconds of its own time
    HOME=$profile chromium --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --hide-scrollbars \
        --user-data-dir="$profile/chromium" --virtual-time-budget=3000 --window-size="$2,$3" --screenshot="$PWD/$out/$1.png" "$4" \
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
    echo "file://$PWD/$1"
}
[ $# -gt 0 ] || set -- mission live utilisation regression
for picture in "$@"; do
    case $picture in
    utilisation) shot utilisation 1400 2680 "$(page build/synth/report.html 'make synth')#table1/u_modem" ;;
    regression) shot regression 1180 1180 "$(page build/regress/report.html 'make regress')" ;;
    mission)
        make run SIZE=640x480 OUT="$profile/run" >"$profile/log" 2>&1 || { cat "$profile/log" >&2 && exit 1; }
        cp "$profile/run/after.png" $out/mission.png
        small $out/mission.png
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
        sed -n '4,5s/^# \{0,1\}//p' "$0" >&2
        exit 2
        ;;
    esac
done
