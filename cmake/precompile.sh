#!/bin/sh
# SPDX-License-Identifier: MIT
#
# precompile.sh TO HEADER COMPILER OPTION...: precompiles a C++ header with Clang. TO.d lists the
# files that the header includes. TO.sum is a checksum of their text, which is the same in all
# clones, so ccache compares it; TO itself contains the path of its folder.
set -e
to=$1 header=$2
shift 2
{ "$1" --version && "$@" -x c++-header -E -P -dD "$header"; } >"$to.text"
sha256sum <"$to.text" >"$to.sum"
rm "$to.text"
"$@" -Xclang -fno-pch-timestamp -x c++-header -MD -MF "$to.d" -MT "$to" -o "$to" "$header"
