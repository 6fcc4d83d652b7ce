# SPDX-License-Identifier: MIT
#
# lights: seeds a bug of each kind, which must turn its light red and no other. Sourced by regress.sh, in its project.

# light name state: in the last run's output
light() { has "^$1  *$2"; }

# Writes the file that a measurement's command leaves beside its figures.
measured() { "$regress" --tree "$2" >"build/$1/tree"; }

# The proof's and the coverage test's design: two bits that count to 2.
design() {
    mkdir -p hdl/small bus ip build/coverage
    cat >hdl/small/counter.v <<'END'
`default_nettype none
module counter (input wire clk_i, input wire rst_i, input wire enable_i, output reg [1:0] count_o);
    always @(posedge clk_i) begin
        if (enable_i)
            count_o <= (count_o == 2) ? 0 : count_o + 1;
        if (rst_i)
            count_o <= 0;
    end
`ifdef FORMAL
    initial assume (rst_i);
    reg past = 0;
    always @(posedge clk_i) past <= 1;
    always @* if (past) begin
        assert (count_o != 3);
        cover (count_o == 2);
    end
`endif
`ifdef COVER_POINTS
    reset_at_two: cover property (@(posedge clk_i) rst_i && count_o == 2);
`endif
endmodule
END
}

case $case in
lights_function)
    run --name 'a[.]'
    light tests green
    run --name '[ab][.]'
    light tests 'red   *1 failed: test_b.Bad'
    has '^| tests | red | 1 failed: test_b.Bad' build/regress/summary.md
    ;;
lights_proof)
    design
    touch bus/none.v
    cat >>tests/room/CMakeLists.txt <<END
add_test(NAME formal.counter COMMAND $source/tests/hdl/formal/prove.sh counter 6 $work $work/build/proof)
set_tests_properties(formal.counter PROPERTIES LABELS formal)
END
    cmake build/main >/dev/null
    run --name 'formal|a[.]'
    light proofs green
    sed -i 's/count_o == 2) ? 0/count_o == 3) ? 0/' hdl/small/counter.v # one value too many
    run --name 'formal|a[.]'
    light proofs 'red   *1 failed: formal.counter'
    light tests green
    ;;
lights_coverage)
    design
    cat >main.cpp <<'END'
#include "Vcounter.h"
#include <cstdlib>
#include <verilated_cov.h>
int main() {
    Vcounter top;
    for (int i = 0; i < 40; ++i) {
        top.clk_i = i & 1;
        if (!top.clk_i) { // a property samples what was there before the edge
            bool shy = std::getenv("SHY") && top.count_o == 2;
            top.rst_i = (i < 4 || i > 26) && !shy;
            top.enable_i = !std::getenv("LAZY") && i % 3;
        }
        top.eval();
    }
    VerilatedCov::write("build/coverage/small.dat");
}
END
    echo '{"gates": {"hdl/": {"lines": 95, "toggles": 95}}}' >gates.json
    verilator --cc --exe --build --coverage --assert -DCOVER_POINTS -O0 -Mdir build/small hdl/small/counter.v "$PWD/main.cpp" \
        -MAKEFLAGS "OPT_FAST=-O0 OPT_SLOW=-O0 OPT_GLOBAL=-O0 CXX='$(command -v ccache) g++'" >verilator.log 2>&1 || fail "$(tail -5 verilator.log)"
    measure() { # environment
        env "$@" build/small/Vcounter
        status=0
        "$source/tests/regress/coverage.py" --gates gates.json --verilator build/coverage/small.dat \
            --out build/coverage/summary.json >coverage.txt 2>&1 || status=$?
        measured coverage hdl
        run --name 'a[.]'
    }
    measure SEED=1
    light coverage green
    measure LAZY=1 # the stimulus is forgotten: the test still passes
    light coverage 'red   *1 files below their gate: hdl/small/counter.v'
    light tests green
    measure SHY=1 # all lines, all toggles; but one situation, named in the design, never comes
    light coverage 'red   *1 files below their gate: hdl/small/counter.v'
    has 'toggles 100.0 (gate 95), points 0.0 (gate 100); never: [0-9]*: reset_at_two' coverage.txt
    measure SEED=1
    light coverage 'green   *100.0 % of lines, 100.0 % of toggles, 1 of 1 cover points'
    grep -q '"reset_at_two"' build/regress/report.html || fail "the page does not list the cover point"
    ;;
lights_mutants)
    mkdir -p build/mutants
    printf 'small/one\tcaught\ttest_a\t1\nsmall/two\tcaught\ttest_a\t1\n' >build/mutants/results.tsv
    measured mutants hdl
    run --name 'a[.]'
    light mutants 'green  2 of 2 caught'
    sed -i 's/two.caught/two\tSURVIVED/' build/mutants/results.tsv
    run --name 'a[.]'
    light mutants 'red   *1 of 2 not caught: small/two'
    light tests green
    sed -i 's/SURVIVED/caught/' build/mutants/results.tsv
    drawn() { # score
        printf '{"seed":"1","tree":"%s","gate":95,"survived":[],"modules":{"fifo":{"drawn":8,"same":0,"caught":7,"score":%s}}}' \
            "$("$regress" --tree hdl)" "$1" >build/mutants/drawn.json
        run --name 'a[.]'
    }
    drawn 87.5
    light mutants 'red   *1 modules of which proofs and tests miss drawn mutants: fifo'
    drawn 100
    light mutants green
    mkdir -p hdl && echo >hdl/new.v # the measured sources have changed
    run --name 'a[.]'
    light mutants 'grey   sources have changed since it was green'
    ;;
lights_figures) # as `make synth` and `make bench` report them: within a limit, beyond it, without a figure
    mkdir -p build/synth build/bench
    figure() { # value, unit, limit, failure, state
        printf '{"failures":[%s],"states":{"whole":"%s"},"entries":[{"name":"whole","value":%s,"unit":"%s","limit":%s}]}' "${4:-}" \
            "${5:-as accepted}" "$1" "$2" "$3"
    }
    measure() {
        measured synth project
        measured bench hdl
        run --name 'a[.]'
    }
    figure 40 LUT 40 >build/synth/report.json
    figure 60 'times, at least' 50 >build/bench/speed.json
    measure
    light size green && light speed green
    figure 40 LUT 40 '' 'changed since' >build/synth/report.json
    measure
    light size 'grey   1 changed since, 0 never measured here: make synth'
    figure 41 LUT 40 >build/synth/report.json
    measure
    light size 'red   *1 beyond their limits: whole 41 (at most 40)'
    light tests green && light speed green
    figure 0 LUT 40 '"whole: synthesis failed"' >build/synth/report.json
    figure 49 'times, at least' 50 >build/bench/speed.json
    measure
    light size 'red .*whole: synthesis failed'
    light speed 'red   *1 beyond their limits: whole 49 (at least 50)'
    ;;
esac
