#!/bin/sh
# SPDX-License-Identifier: MIT
# prove: module depth source-folder work-folder [yosys commands for parameters]
# It is a shell script because it only calls Yosys, abc and CaDiCaL, each with a limit of CPU time.
#
# 1. induction: no assertion ever fails. If the assertions are inductive, k-induction (MiniSat)
#    proves this; otherwise property-directed reachability finds and checks an inductive invariant
#    (z3's k-induction did not end on 64-bit data);
# 2. bounded: if step 1 finds no proof, bounded model checking (BMC) looks for the shortest
#    counterexample within `depth` clocks;
# 3. cover: every cover statement is reached within 4 * `depth` clocks.
#
# PROVE_PDR: other options for pdr, if the proof is faster with them.
# PROVE_STEP=k: the assertions are inductive over k clocks, but there are too many for MiniSat, so
#   CaDiCaL does the induction step.
# PROVE_BOUNDED=1: the proof is only bounded.
# PROVE_READ: additional arguments of read_verilog: defines, files.
# PROVE_CORE: the name of a core and its files, for the proof of a core in idle_proof.
# PROVE_SCRIPT: Yosys script that changes the flattened design; it may use idle_registers.v and
#   idle.ys.
# PROVE_MUTANT: Yosys commands to run before flattening (tools/icesoc/mutants/drawn.py); without a
#   trace.
#
# Writes to <work> the parts of the Yosys script: state.ys converts modules to flip-flops, and
# gates.ys converts flip-flops to AIGER's gates. If an assertion fails, it also writes
# <work>/trace.vcd. The module may instantiate modules of its folder, of bus/, hdl/system/ and
# hdl/cdc/. For a proof in testbench/sim/, the modules of hdl/ddr/ are used instead of those of its
# folder.
set -eu
here=$(dirname "$(readlink -f "$0")")
module=$1 depth=$2 source=$3 work=$4 parameters=${5:-}
limit=${PROVE_SECONDS:-300} # limit of CPU time, s; a proof that takes longer is an error
mkdir -p "$work"
cd "$work"
rm -f ./*.aig ./*.map ./*.aiw ./*.vcd
# One of these folders may not exist.
file=$(find "$source/bus" "$source/hdl" "$source/ip" "$source/testbench/sim" -name "$module.v" \
    2>/dev/null) || true
generated=''
[ -n "$file" ] || [ ! -e "${GEN_DIR:-.}/$module.v" ] || generated=$GEN_DIR/$module.v file=$generated
[ -n "$file" ] || {
    echo "$module: no $module.v below bus, hdl, ip or testbench/sim" >&2
    exit 2
}
near=$(dirname "$file") alone=
case $file in */testbench/sim/*) near=$source/hdl/ddr alone=$file ;; esac
folders="$source/bus $source/hdl/system $source/hdl/cdc $near"
[ -z "$generated" ] || folders=$source/bus alone=$generated
files=$(for folder in $folders; do ls "$folder"/*.v || true; done | sort -u)
files="$files $alone"
# In a proof with several clocks (`gclk`), every edge is a separate input.
clocks=async2sync
! grep -q gclk "$file" || clocks='memory_map; clk2fflogic'
read=${PROVE_READ:-}
[ -z "${PROVE_CORE:-}" ] || {
    core=${PROVE_CORE%% *}
    own=${PROVE_CORE#* } # its files
    rules=$source/ip/$core/idle_rules.vh # invariants of a core that is written in VHDL
    read="-DCORE=$core $own $source/hdl/ddr/npi_stream.v"
    # shellcheck disable=SC2086
    ! grep -q 'memory_ports\|npi_addr_o' $own || read="-DMEMORY $read"
    [ ! -e "$rules" ] || read="-DIDLE_RULES=\"$rules\" $read"
}
flat=''
[ -z "${PROVE_SCRIPT:-}" ] || {
    flat="script $PROVE_SCRIPT"
    cp "$here/idle_registers.v" "$here/idle.ys" .
}
# -nosdff -nodffe: AIGER has only plain flip-flops. The module's outputs are removed, because abc
# would treat them as properties. Undefined values, such as the value of a flip-flop without a
# clock, become unconstrained, because newer AIGER backends reject them.
cat >gates.ys <<'END'
memory_map; opt -full; setundef -anyseq; techmap; opt -fast -nosdff -nodffe
dfflegalize -cell $_DFF_P_ 01; delete -output w:*
END
cat >state.ys <<END
flatten
prep -top $module -nordff
memory_nordff
$clocks
dffunmap
chformal -early
$flat
setundef -anyseq -undriven
opt_clean
check -assert
END
aiger='opt_clean; abc -g AND -fast; opt_clean; write_aiger -zinit -map'
# shellcheck disable=SC2086
cat >prove.ys <<END
verilog_defaults -add -formal -sv -DRULES -I${GEN_DIR:-.} -I$source/bus -I$source/hdl/ddr
verilog_defaults -add -I$source/hdl/system -I$source/testbench/sim
read_verilog $read $(echo $files)
$parameters
hierarchy -top $module -libdir ${GEN_DIR:-.}
proc
${PROVE_MUTANT:-}
script state.ys
write_smt2 -wires model.smt2
write_rtlil model.il
script gates.ys
design -save gates
chformal -cover -remove
$(echo $aiger) assert.map assert.aig
design -load gates
select -write cover.names t:\$cover
chformal -assert -live -fair -remove
techmap -map cover.v t:\$cover
simplemap
$(echo $aiger) cover.map cover.aig
END
cat >cover.v <<'END' # a cover statement becomes an assertion that must fail
module \$cover (input A, input EN);
    \$assert _TECHMAP_REPLACE_ (.A(~A), .EN(EN));
endmodule
END
yosys -q prove.ys >yosys.log 2>&1 || {
    cat yosys.log
    exit 1
}
cat >induct.ys <<END
read_rtlil model.il
memory_map
opt_clean
chformal -cover -remove
sat -tempinduct -prove-asserts -set-assumes -seq 1 -maxsteps 4
END
failed() {
    cat "$1"
    [ -n "${PROVE_MUTANT:-}" ] || replay
    echo "$module: $2" >&2
    exit 1
}
# replay: smtbmc replays abc's counterexample, which gives the names of signals and a waveform
replay() {
    awk -v n="$(head -1 assert.aig | cut -d' ' -f3)" 'NR == 1 { print "1" }
        { print NR == 1 ? $0 : substr($0, 1, n) }' assert.aiw >replay.aiw 2>/dev/null || true
    timeout 100 yosys-smtbmc -s z3 --unroll --noprogress --aig assert.map:replay.aiw \
        --dump-vcd trace.vcd model.smt2 >trace.log 2>&1 || true
    grep -E 'Assert failed' trace.log || true
    [ ! -e trace.vcd ] || echo "$module: trace: $work/trace.vcd" >&2
}
# limited command log: runs abc with a limit of CPU time
limited() { (ulimit -t "$limit" && exec "$@"); }
abc() { limited yosys-abc -c "$1" >"$2" 2>&1 || true; }
# step clocks: searches, from any state (no initial values), for a failure after this number of
# clocks without a failure. Exit status 20 means that there is none. The assumptions hold in all
# clocks.
step() {
    abc "read_aiger assert.aig; fold; strash; orpos; frames -F $(($1 + 1)); comb;
        write_blif frames.blif" step.log
    # The first outputs of the model show for each clock whether an assertion fails. They are
    # combined to a single output, which is 1 if an assertion failed in the last clock and in no
    # earlier clock.
    awk -v bads=$(($1 + 1)) '
        /\\$/ { # a line that is continued on the next line
            sub(/\\$/, "")
            line = line $0
            next
        }
        { $0 = line $0; line = "" }
        $1 == ".outputs" {
            for (i = 2; i < 2 + bads; i++) inputs = inputs " " $i
            print ".outputs step"
            next
        }
        $1 == ".end" {
            for (i = 1; i < bads; i++) zeros = zeros "0"
            print ".names" inputs " step"
            print zeros "1 1"
        }
        { print }' frames.blif >step.blif
    rm -f step.cnf
    abc "read_blif step.blif; strash; write_cnf step.cnf" step.log
    limited cadical -q step.cnf >step.log 2>&1
}
# bounded clocks [seconds]: searches for a failed assertion within this number of clocks, or as many
# as it can check in this time
bounded() {
    abc "read_aiger assert.aig; fold; strash; bmc3 -F $1 ${2:+-T $2};
        write_cex -a assert.aiw" bounded.log
    all='Explored all reachable states'
    grep -q "output failed\|output asserted\|was asserted\|$all" bounded.log || {
        cat bounded.log
        echo "$module: abc has no answer (see above): is another proof at work in $work?" >&2
        exit 2
    }
    grep -q "No output failed\|No output asserted\|$all" bounded.log ||
        failed bounded.log "an assertion fails within $1 clocks"
    [ -n "${2:-}" ] || echo "$module: bounded, $1 clocks"
}
latches() { head -1 "$1" | cut -d' ' -f4; }

if [ "$(latches assert.aig)" -eq 0 ]; then
    abc "read_aiger assert.aig; strash; orpos; sat" induction.log
    grep -q 'UNSATISFIABLE' induction.log || failed induction.log "an assertion fails"
    echo "$module: proven (it has no state)"
else
    clocks_of_step=${PROVE_STEP:-0} carried=''
    if [ -n "${PROVE_BOUNDED:-}" ]; then
        bounded "$depth"
        carried=no
    elif [ "$clocks_of_step" -gt 0 ]; then
        command -v cadical >/dev/null || {
            echo "$module: PROVE_STEP needs cadical: cmake/setup.sh" >&2
            exit 2
        }
        bounded $((clocks_of_step + 1))
        status=0
        step "$clocks_of_step" || status=$?
        [ $status -ne 20 ] || carried="induction step of $clocks_of_step clock(s)"
    elif [ "$clocks" = async2sync ]; then # this takes only a second if the assertions are inductive
        limited yosys -q -l induct.log induct.ys >/dev/null 2>&1 || true
        ! grep -q 'Induction step proven: SUCCESS' induct.log || {
            bounded 2 # the base case begins after the first clock
            carried="$(grep -c 'Induction step failed' induct.log || true) + 1 steps"
        }
    fi
    if [ -z "$carried" ]; then
        bounded "$depth" 5 # an existing failure is found in seconds here; pdr may take minutes
        # sat: scorr may already find that the output is constant; newer versions of abc then have
        # nothing left to prove
        abc "read_aiger assert.aig; fold; strash; scorr -F 2; pdr ${PROVE_PDR:-};
            write_cex -a assert.aiw; sat" induction.log
        grep -q 'Property proved\|UNSATISFIABLE' induction.log || {
            mv assert.aiw deep.aiw 2>/dev/null || true
            bounded "$depth" # looks for the shortest counterexample
            mv deep.aiw assert.aiw 2>/dev/null || true
            failed induction.log "not proven (PROVE_SECONDS=$limit)"
        }
        carried=$(sed -n 's/^Invariant[^:]*: \([0-9]* clauses with [0-9]* flops\).*/\1/p' \
            induction.log)
    fi
    [ "$carried" = no ] || echo "$module: proven, ${carried:-no clause needed}"
fi

covers=$(grep -c . cover.names || true)
[ "$covers" -gt 0 ] || {
    echo "$module: no cover statement: nothing shows that the properties are reached" >&2
    exit 1
}
# -g selects the solver glucose, which needs a quarter of the time for deep covers
solve="bmc3 -g -F $((depth * 4))"
[ "$(latches cover.aig)" -gt 0 ] || solve=sat
# older versions of abc need -s, otherwise they drop the flip-flops of a cone; newer versions have
# no -s
cone=cone
! yosys-abc -c 'cone -h' 2>&1 | grep -q -- '^.*-s  ' || cone='cone -s'
commands='' index=0
# one output at a time, because bmc3 -a can crash with several outputs
while [ "$index" -lt "$covers" ]; do
    commands="$commands echo cover $index; read_aiger cover.aig; fold; strash;
        $cone -O $index; $solve;"
    index=$((index + 1))
done
abc "$commands" cover.log
missing=0 index=0
while read -r name; do
    sed -n "/^cover $index *\$/,/^cover $((index + 1)) *\$/p" cover.log |
        grep -q 'was asserted\|^SATISFIABLE' || {
        echo "$module: not reached in $((depth * 4)) clocks: ${name#*/}" >&2
        missing=1
    }
    index=$((index + 1))
done <cover.names
[ "$missing" -eq 0 ] || exit 1
echo "$module: $covers covers reached"
# CPU time of this script and its children; `make proofs` adds these times up
times >times.txt
awk 'function s(t) { split(t, a, /[ms]/); return 60 * a[1] + a[2] } { n += s($1) + s($2) }
    END { printf "%.1f\n", n }' times.txt >cpu
echo "$module: $(cat cpu) s of CPU time"
