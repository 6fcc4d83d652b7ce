#!/bin/sh
# SPDX-License-Identifier: MIT
# make: checks that make knows how to make every target of its list, and refuses a mistyped variable. Usage: make.sh source-folder build-folder
set -eu
cd "$1"
targets=$(make --no-print-directory help | sed -n 's/^  make \([a-z-]*\) .*/\1/p')
[ "$(echo "$targets" | wc -l)" -gt 15 ] || { echo "make help lists: $targets" >&2 && exit 1; }
# make runs a recipe with $(MAKE) in it in spite of -n.
if grep -n '^	.*\$(MAKE)' Makefile ./*/targets.mk; then echo "say make, not \$(MAKE)" >&2 && exit 1; fi
for target in $targets; do
    make -n "$target" NAME=x LANG=verilog IP=fir >/dev/null
done
make -n run CORES='ascon fir' IMAGE='a picture=1.jpg' >/dev/null
if said=$(make help CORE=ascon 2>&1); then echo "CORE=ascon is accepted" >&2 && exit 1; fi
echo "$said" | grep -q 'there is no variable CORE;' || { echo "$said" >&2 && exit 1; }
[ "$(LC_ALL=de_DE.UTF-8 make -s --eval 'locale: ; @echo $$LC_ALL' locale)" = C.UTF-8 ] || { echo "numbers as the user's language writes them" >&2 && exit 1; }

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT TERM HUP
# Without permission to write, the message says what to do.
mkdir "$work/theirs" && cp cmake/configure.sh "$work" && chmod 755 "$work" "$work/configure.sh" && chmod 555 "$work/theirs"
other=''
[ "$(id -u)" != 0 ] || other='setpriv --reuid=65534 --regid=65534 --clear-groups'
if said=$($other "$work/configure.sh" "$work/theirs" 2>&1); then echo "a build where one may not write" >&2 && exit 1; fi
case $said in *"you may not write in $work/theirs"*BUILD=*) ;; *) echo "$said" >&2 && exit 1 ;; esac
mkdir -m 777 "$work/mine"
if said=$(HOME="$work/theirs" XDG_CACHE_HOME='' $other "$work/configure.sh" "$work/mine" 2>&1); then echo "a home where one may not write" >&2 && exit 1; fi
case $said in *"you may not write in $work/theirs/.cache"*XDG_CACHE_HOME*) ;; *) echo "$said" >&2 && exit 1 ;; esac
[ "$(env -u HOME make -s --eval 'home: ; @echo $$HOME' home)" = "$(getent passwd "$(id -u)" | cut -d: -f6)" ]
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

# The compiler's cache serves another clone.
export CCACHE_DIR="$work/cache"
for clone in a b; do
    mkdir -p "$work/$clone/build"
    cp Makefile "$work/$clone"
    echo 'int one(void) { return __LINE__; }' >"$work/$clone/one.c"
    make -s -C "$work/$clone" --eval 'one: ; @cd build && ccache cc -c $(CURDIR)/one.c' one
done
ccache --print-stats | grep -q '^\(direct\|preprocessed\)_cache_hit.1$' || { ccache --print-stats >&2 && exit 1; }

# A renamed tree is built anew, others keep their build.
configure=$PWD/cmake/configure.sh
mkdir "$work/old"
printf 'cmake_minimum_required(VERSION 3.25)\nproject(moved NONE)\n' >"$work/old/CMakeLists.txt"
(cd "$work/old" && "$configure" build >/dev/null && touch build/kept && "$configure" build && [ -f build/kept ])
mv "$work/old" "$work/new"
said=$(cd "$work/new" && "$configure" build 2>&1) || { echo "$said" >&2 && exit 1; }
echo "$said" | grep -q "build was made for the tree in $work/old: made anew" || { echo "$said" >&2 && exit 1; }
# A value that CMake refuses is not kept: it would fail all later targets.
printf 'if(WRONG)\n  message(FATAL_ERROR "WRONG is ${WRONG}")\nendif()\n' >>"$work/new/CMakeLists.txt"
said=$(cd "$work/new" && "${configure%/*}/set.sh" build -DWRONG=here 2>&1) && { echo "WRONG=here is accepted" >&2 && exit 1; }
case $said in *'WRONG is here'*) ;; *) echo "$said" >&2 && exit 1 ;; esac
said=$(cmake "$work/new/build" 2>&1) || { echo "kept: $said" >&2 && exit 1; }

# One block's tests need its programs, and no more.
needed=$("$2/tests/regress/regress" --build "$2" --prepare --list --block bus)
[ "$(echo "$needed" | wc -l)" -lt 20 ] && echo "$needed" | grep -q '^tests/bus/test_bus_decoder$' || { echo "for BLOCK=bus is built: $needed" >&2 && exit 1; }
[ "$(make -s --eval 'force: ; @echo "$(FORCE)$(LIVE)"' force FORCE=0 LIVE=1)" = 1 ] || { echo "FORCE=0 is not off" >&2 && exit 1; }

# Programs that `make test` runs with sanitizers: one without the label would be missed.
for program in test_os_cases test_link test_engine test_icec; do
    grep -q sanitized "$2"/tests/sw/*/"${program}_labels.cmake" || { echo "$program: no case is labelled sanitized" >&2 && exit 1; }
done
