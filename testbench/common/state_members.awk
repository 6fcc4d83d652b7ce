# SPDX-License-Identifier: MIT
#
# state_members: reads the header that declares the state of a Verilated model, the class
# `class`___024root, and lists the signals with the prefix `top`. The list is the constant
# `class`_state (model_state.h). If `slot` is set, the list is the function stateOf
# (registers_apart.h).
# Two kinds of variables that Verilator adds are not signals: random values for reads beyond the end
# of an array, and variables that take writes beyond the end of an array. Their path is empty, and
# the function stateOf does not contain them.

BEGIN {
    root = class "___024root"
    if (slot) {
        print "inline std::vector<StateMember> stateOf(const " root "& root) {\n    return {"
        print "#define MEMBER(name, path) {root, root.name, path},"
    } else {
        print "#include \"" root ".h\"\n#include \"model_state.h\""
        # offsetof is allowed, because no base class of the state changes the layout
        print "#pragma GCC diagnostic ignored \"-Winvalid-offsetof\""
        print "#define MEMBER(name, path) {offsetof(" root ", name), sizeof(" root "::name), path},"
        print "static const ModelMember members[] = {"
    }
}
END {
    if (slot)
        print "#undef MEMBER\n    };\n}"
    else
        print "};\n#undef MEMBER\nextern const ModelState " class "_state;\n" \
            "const ModelState " class "_state = {sizeof(" root "), members, " \
            "members + sizeof members / sizeof members[0]};"
}
/__DOT____V/ && slot { next } # variables that Verilator adds
/;$/ && match($0, "[ ]" top "[A-Za-z0-9_]*;$") {
    name = substr($0, RSTART + 1, RLENGTH - 2)
    path = name ~ /__DOT____V(xrand|lvbound)/ ? "" : substr(name, length(top) + 1)
    gsub(/__DOT__/, ".", path)
    gsub(/__BRA__/, "[", path)
    gsub(/__KET__/, "]", path)
    printf "MEMBER(%s, \"%s\")\n", name, path
}
