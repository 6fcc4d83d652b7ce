#!/bin/sh
# SPDX-License-Identifier: MIT
# drawn_test: drawn.py on a module with half a proof: mutants that it misses survive at their line, and those that are no bug
# drop out. A test of a model that carries all survivors (model.py) finds them.
# Usage: drawn_test.sh source-folder work-folder verilators-runtime.a
set -eu
source=$1 work=$2 runtime=$3
[ -d "$source/tests/mutants" ] || { echo "drawn_test: $source is not the source folder: run cmake again" >&2 && exit 2; }
rm -rf "$work"
mkdir -p "$work/hdl/small" "$work/bus" "$work/ip" "$work/build" "$work/tests"
cd "$work"
export PYTHONPYCACHEPREFIX="$work/compiled" # a script's compiled form contains its time, which differs in each clone
ln -s "$source/tests/mutants" tests/mutants
touch bus/none.v
fail() {
    cat run.log >&2
    echo "$*" >&2
    exit 1
}
cat >hdl/small/pair.v <<'END'
`default_nettype none
module pair (input wire clk_i, input wire a_i, input wire b_i, output reg both_o, output wire same_o);
    assign same_o = a_i | (a_i & b_i);
    always @(posedge clk_i)
        both_o <= a_i & b_i;
`ifdef FORMAL
    reg past = 0, a, b;
    always @(posedge clk_i)
        {past, a, b} <= {1'b1, a_i, b_i};
    always @* if (past) begin
        assert (same_o == a_i);
        cover (both_o);
    end
`endif
endmodule
END
cat >CMakeLists.txt <<END
cmake_minimum_required(VERSION 3.25)
project(tiny NONE)
enable_testing()
add_test(NAME formal.pair COMMAND env $source/tests/hdl/formal/prove.sh pair 4 $work $work/build/pair)
END
cmake -S . -B build -G Ninja >/dev/null
run() { "$source/tests/regress/test/make_in.sh" "$source" "$work" build mutants DRAW=8 SEED=3 JOBS=2 BLOCK="${1:-pair}" >run.log 2>&1; }
if run; then fail "mutants that survive are no error"; fi
grep -q '^SURVIVED .*formal.pair .*hdl/small/pair.v:[45] ' run.log || fail "the survivor's line is not told"
! grep -q '^SURVIVED .*pair.v:3 ' run.log || fail "a mutant that changes nothing survives, or the proof misses one"
grep -q '^pair .* [1-9] the same$' run.log || fail "none drops out"
grep -q 'below 95 %: pair$' run.log || fail "the gate is not told"
python3 -c 'import json, sys; json.dump(json.load(sys.stdin)["survived"], sys.stdout)' <build/mutants/drawn.json >missed.json
cat >main.cpp <<'END'
#include "Vpair.h"
int main() {
    Vpair top;
    for (unsigned i = 0; i < 8; ++i) {
        top.clk_i = 0;
        top.eval();
        top.a_i = i & 1, top.b_i = i >> 1 & 1;
        top.eval();
        top.clk_i = 1;
        top.eval();
        if (top.both_o != (top.a_i & top.b_i))
            return 3;
    }
}
END
DRAWN=$PWD/missed.json "$source/tests/mutants/model.py" --cc -Wall --top-module pair --prefix Vpair --Mdir model hdl/small/pair.v >run.log 2>&1 || fail "no model"
include=$(verilator --getenv VERILATOR_ROOT)/include
c++ -Imodel -I"$include" -I"$include/vltstd" main.cpp model/*.cpp "$runtime" -lz -lpthread -o test_pair
./test_pair || fail "the model without a mutant is not the module"
for mutant in $(seq "$(grep -o '"alike"' missed.json | wc -l)"); do
    ! MUTANT=$mutant ./test_pair || fail "the model does not have mutant $mutant"
done
sed -i 's/assert (same_o == a_i);/& assert (both_o == (a \&\& b));/' hdl/small/pair.v
run || fail "a proof that says all misses some"
grep -q '^\([0-9]*\) of \1 mutants tried' run.log || fail "no word of how far it is"
grep -q '^pair  *100.0 %' run.log || fail "no score"
grep -q '"survived": \[\]' build/mutants/drawn.json || fail "no summary"
cp build/mutants/drawn/pair/list drawn.list
run || fail "a second run of the same seed fails"
cmp build/mutants/drawn/pair/list drawn.list || fail "the same seed draws others"
# A test program that fails without a mutant catches none; the others' results are still reported.
mkdir -p copy/build/main
cat >copy/build/main/build.ninja <<'END'
rule script
  command = printf '#!/bin/sh\necho said; exit $$((%s))\n' '$fails' >$out && chmod +x $out
build test_pair: script
  fails = MUTANT == 1
build test_bad: script
  fails = 1
END
cat >by_tests.py <<END
import pathlib, sys
from concurrent.futures import ThreadPoolExecutor
sys.path.insert(0, "$source/tests/mutants")
import drawn, run
run.TOP, run.prepare, drawn.TESTS = pathlib.Path.cwd(), lambda *_: None, {"pair": "test_pair", "bad": "test_bad"}
rows = [dict(module=name, result="SURVIVED") for name in ("pair", "pair", "bad")]
with ThreadPoolExecutor(2) as pool:
    assert drawn.by_tests(rows, run.TOP / "copy", pool) == ["test_bad"]
assert [row["result"] for row in rows] == ["test_pair", "SURVIVED", "SURVIVED"], rows
END
/usr/bin/python3 by_tests.py >run.log 2>&1 || fail "what the tests say of mutants is lost"
grep -q '^said$' run.log && grep -q 'test_bad fails without any mutant, so it caught none' run.log || fail "no word of a test that fails as it is"
# A mutant that does not run is reported; the others are still judged.
cat >yosys <<END
#!/bin/sh
case \$PWD in */drawn/pair/2) echo "no such thing" && exit 1 ;; esac
exec $(command -v yosys) "\$@"
END
chmod +x yosys
if PATH=$PWD:$PATH run; then fail "a mutant that does not run is no error"; fi
grep -q 'no such thing' run.log && grep -q '^mutants: 1 do not run' run.log && grep -q '^pair  *100.0 %' run.log ||
    fail "a mutant that does not run loses the rest"
if run nothing; then fail "no proof is no error"; fi
grep -q 'no proof.s name begins with nothing' run.log || fail "no word of what there is"
