#!/bin/sh
# SPDX-License-Identifier: MIT
# verilated_header: source-folder work-folder
# Checks that the precompiled header has all macros of Verilator's makefile, each with the value 0,
# also the macros of another version of Verilator. (Verilator 5.032 has VM_TIMING, 5.006 has not.)
set -eu
rm -rf "$2"
mkdir -p "$2/include"
cd "$2"
touch include/verilated.h
# shellcheck disable=SC2016 # variables of make
echo 'CPPFLAGS += -MMD -DVM_SC=$(VM_SC) -DVM_NEW=$(VM_NEW) $(USER_CPPFLAGS)' >include/verilated.mk
printf '#!/bin/sh\necho "$*" >>arguments\n' >compiler
chmod +x compiler
make -s -f "$1/cmake/verilated_header.mk" VERILATOR_ROOT="$2" TO=header.pch CXX=./compiler \
    OPT_FAST=-O3 USER_CPPFLAGS=-fPIC
compiled=$(tail -n 1 arguments)
expected="-DVM_SC=0 -DVM_NEW=0 -fPIC -O3 -x c++-header -o header.pch $2/include/verilated.h"
[ "$compiled" = "$expected" ] || {
    echo "arguments of the compiler: expected '$expected', got '$compiled'" >&2
    exit 1
}
