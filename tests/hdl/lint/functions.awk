# SPDX-License-Identifier: MIT
#
# functions: checks that each Verilog function with a local variable, other than the variable of a
# loop, is automatic. In other functions, such a variable keeps its value between calls. If a clocked
# process calls the function, Verilator 5.032 (Debian 13) therefore reports BLKSEQ for each
# assignment to the variable; Verilator 5.006 (Debian 12) does not.

function check_function(    each) {
    for (each in variables) {
        print place ": error: expected \"function automatic\", because " each " is a local variable"
        failed = 1
    }
}
/^ *function / {
    place = FILENAME ":" FNR
    is_automatic = /^ *function automatic /
    delete variables
    ++functions
}
place && !is_automatic && /^ *(integer|reg) / {
    names = $0
    sub(/^ *(integer|reg) *(\[[^]]*\])?/, "", names)
    sub(/;.*/, "", names)
    count = split(names, list, /[ ,]+/)
    for (n = 1; n <= count; ++n)
        if (list[n])
            variables[list[n]]
}
place && match($0, /for \([a-z_0-9]+ =/) { delete variables[substr($0, RSTART + 5, RLENGTH - 7)] }
/endfunction/ {
    check_function()
    delete variables
    place = ""
}
END {
    if (functions < 15) {
        print "expected at least 15 functions, got " functions + 0
        failed = 1
    }
    exit failed
}
