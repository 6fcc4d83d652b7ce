# SPDX-License-Identifier: MIT
#
# state_members: reads the header that declares the state of a Verilated model, and lists the
# signals with the prefix `top`, one line each: MEMBER(name, "path"). If `class` is set to
# the type of the state, the list is written as the function stateOf (registers_apart.h).
# Two kinds of variables that Verilator adds are not listed: random values for reads beyond the end
# of an array, and variables that take writes beyond the end of an array.

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
/__DOT____V/ && class { next } # variables that Verilator adds
/__DOT____V(xrand|lvbound)/ { next }
/;$/ && match($0, "[ ]" top "[A-Za-z0-9_]*;$") {
    name = substr($0, RSTART + 1, RLENGTH - 2)
    path = substr(name, length(top) + 1)
    gsub(/__DOT__/, ".", path)
    gsub(/__BRA__/, "[", path)
    gsub(/__KET__/, "]", path)
    printf "MEMBER(%s, \"%s\")\n", name, path
}
