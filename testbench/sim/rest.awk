# SPDX-License-Identifier: MIT
#
# rest.awk: copies a Verilog file and replaces the clock of some of its instances, so that the
# simulator can stop these clocks while hdl/ stays free of simulation code (sim_soc.v).
#
#   awk -v clocks="u_modem=sim_soc.platform_clk ..." -f rest.awk hdl/soc.v
#
# The copy contains markers, so that messages and coverage refer to the lines of the original file.
BEGIN {
    count = split(clocks, pairs, " ")
    for (i = 1; i <= count; i++) {
        split(pairs[i], pair, "=")
        clock[pair[1]] = pair[2]
    }
}
FNR == 1 { printf "`line 1 \"%s\" 0\n", FILENAME }
match($0, /u_[a-z0-9_]+ \(/) { instance = substr($0, RSTART, RLENGTH - 2) }
instance in clock && sub(/\.clk_i\(clk_i\)/, ".clk_i(" clock[instance] ")") {
    delete clock[instance]
}
{ print }
END {
    for (instance in clock) {
        printf "%s: expected an instance %s with .clk_i(clk_i)\n", FILENAME, instance >"/dev/stderr"
        failed = 1
    }
    exit failed
}
