#!/bin/sh
# SPDX-License-Identifier: MIT
#
# join_waves: adds the rows of wave.fst.program.vcd (program_trace.h) to wave.fst, above the rows of
# the RTL.
# If one of the files is missing, nothing is changed. Usage: join_waves.sh wave.fst
set -eu
wave=$1 program=$1.program.vcd
[ -s "$wave" ] && [ -s "$program" ] || exit 0
command -v fst2vcd >/dev/null && command -v vcd2fst >/dev/null || {
    echo "join_waves: fst2vcd is missing (Debian: gtkwave): the program's rows stay in $program" >&2
    exit 0
}
fst2vcd "$wave" | awk -v program="$program" '
function next_line() {
    more = (getline line < program) > 0
    if (more && line ~ /^#/) { time = substr(line, 2) + 0; next_line() }
}
# prints the lines of the program waveform up to this time; a negative time prints all lines
function told_until(end) {
    while (more && (end < 0 || time <= end)) {
        if (time > now) print "#" (now = time)
        print line
        next_line()
    }
}
BEGIN { now = -1; next_line() }
/^\$scope/ && !head {
    for (; line !~ /^\$enddefinitions/; next_line()) if (line !~ /^\$timescale/) print line
    head = 1
    next_line()
}
/^#/ { stamp = substr($0, 2) + 0; told_until(stamp - 1); now = stamp }
{ print }
END { told_until(-1) }
' | vcd2fst - "$wave.joined"
mv "$wave.joined" "$wave"
rm "$program"
