# SPDX-License-Identifier: MIT
#
# soc_members: lists the chip's signals in Verilator's header, a line each: MEMBER(name, "path").
# Random values that it reads beyond an array's end, and the scratch of writes there, are no state.

/__DOT____V(xrand|lvbound)/ { next }
/;$/ && match($0, /[ ]sim_soc__DOT__soc__DOT__[A-Za-z0-9_]*;$/) {
    name = substr($0, RSTART + 1, RLENGTH - 2)
    path = substr(name, 25)
    gsub(/__DOT__/, ".", path)
    printf "MEMBER(%s, \"%s\")\n", name, path
}
