# SPDX-License-Identifier: MIT
#
# state_members: lists the signals in the header of a Verilated model's state that have names
# beginning with `top`, one line each: MEMBER(name, "path"). With `class`, the type of the state, it
# writes them as the function stateOf (registers_apart.h).
# Not state: random values that reads beyond the end of an array return, and scratch variables for
# writes there.

BEGIN {
    if (class) {
        print "inline std::vector<StateMember> stateOf(const " class "& root) {\n    return {"
        print "#define MEMBER(name, path) {root, root.name, path},"
    }
}
END {
    if (class)
        print "#undef MEMBER\n    };\n}"
}
/__DOT____V/ && class { next } # copies that Verilator makes
/__DOT____V(xrand|lvbound)/ { next }
/;$/ && match($0, "[ ]" top "[A-Za-z0-9_]*;$") {
    name = substr($0, RSTART + 1, RLENGTH - 2)
    path = substr(name, length(top) + 1)
    gsub(/__DOT__/, ".", path)
    gsub(/__BRA__/, "[", path)
    gsub(/__KET__/, "]", path)
    printf "MEMBER(%s, \"%s\")\n", name, path
}
