#!/bin/sh
# SPDX-License-Identifier: MIT
# make: what is set up and fetched, and what a test needs of a build. Usage: make.sh source-folder build-folder
set -eu
cd "$1"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT TERM HUP
# A user's name may have an apostrophe.
mkdir "$work/it's" && ln -s "${XDG_CACHE_HOME:-$HOME/.cache}/icesoc" "$work/it's/icesoc"
XDG_CACHE_HOME="$work/it's" cmake/fetch.py ghdl "$work/ghdl" && "$work/ghdl/ghdl" --version >/dev/null
# The pages' libraries: without a network, or with a file of another checksum, the build goes on, says so, and keeps no
# partial file.
page() { XDG_CACHE_HOME="$work/empty" ICESOC_NPM=$1 cmake/fetch.py page "$work/page" 2>&1; }
mkdir -p "$work/npm/tabulator-tables/-" && echo wrong >"$work/npm/tabulator-tables/-/tabulator-tables-6.5.3.tgz"
for mirror in http://127.0.0.1:9 "file://$work/npm"; do
    said=$(page "$mirror") || { echo "without a network: $said" >&2 && exit 1; }
    case $said in *"cannot get Tabulator and uPlot"*) ;; *) echo "$said" >&2 && exit 1 ;; esac
    [ -f "$work/page/libraries.js" ] && [ ! -s "$work/page/libraries.js" ] && [ ! -e "$work/page/done" ] && [ -z "$(ls "$work/empty/icesoc/foreign")" ] ||
        { echo "left by $mirror: $(ls -R "$work/page" "$work/empty")" >&2 && exit 1; }
done
case $said in *tabulator-tables-6.5.3.tgz\ is\ not\ the\ file\ that\ was\ tested*) ;; *) echo "$said" >&2 && exit 1 ;; esac

# Set-up in two steps: make run does not ask for packages that only tests need. On a machine without packages:
mkdir "$work/bin" && printf '#!/bin/sh\n' >"$work/bin/dpkg-query" && chmod +x "$work/bin/dpkg-query"
first=$(PATH="$work/bin:$PATH" cmake/setup.sh --check || true)
second=$(PATH="$work/bin:$PATH" cmake/setup.sh --tests --check || true)
for package in chromium tshark gtkwave; do
    if echo "$first" | grep " $package:"; then echo "make run asks for $package" >&2 && exit 1; fi
    echo "$second" | grep -q " $package:" || { echo "make test does not ask for $package" >&2 && exit 1; }
done
echo "$first" | grep -q ' verilator:' || { echo "$first" >&2 && exit 1; }

# One block's tests need its programs, and no more.
needed=$("$2/tests/regress/regress" --build "$2" --prepare --list --block bus)
[ "$(echo "$needed" | wc -l)" -lt 20 ] && echo "$needed" | grep -q '^tests/bus/test_bus_decoder$' || { echo "for BLOCK=bus is built: $needed" >&2 && exit 1; }

# Programs that `make test` runs with sanitizers: one without the label would be missed.
for program in test_os_cases test_link test_engine test_icec; do
    grep -q sanitized "$2"/tests/sw/*/"${program}_labels.cmake" || { echo "$program: no case is labelled sanitized" >&2 && exit 1; }
done
