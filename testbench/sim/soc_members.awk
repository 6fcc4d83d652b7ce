# SPDX-License-Identifier: MIT
#
# soc_members: of the header that Verilator wrote, the chip's signals, a line each: MEMBER(name, "path").

/;$/ && match($0, /[ ]soc__DOT__[A-Za-z0-9_]*;$/) {
    name = substr($0, RSTART + 1, RLENGTH - 2)
    path = substr(name, 11)
    gsub(/__DOT__/, ".", path)
    printf "MEMBER(%s, \"%s\")\n", name, path
}
