#!/bin/sh
# SPDX-License-Identifier: MIT
#
# regress.sh: the regression tool on a small project of its own, with tests that pass, fail, flicker and crash.
# Usage: regress.sh case regress-binary work-folder source-folder build-folder
set -eu
case=$1 regress=$2 work=$3 source=$4 build=$5
fail() {
    echo "$case: $*" >&2
    [ ! -f out.txt ] || cat out.txt >&2
    exit 1
}
has() { grep -q -- "$1" "${2:-out.txt}" || fail "'$1' is not in ${2:-the output}"; }
hasNot() { ! grep -q -- "$1" "${2:-out.txt}" || fail "'$1' is in ${2:-the output}"; }

# A project: test_a passes, test_b fails alike for all seeds but 7, test_c as the file `flicker` says, test_d crashes.
rm -rf "$work"
mkdir -p "$work/tests/room"
cd "$work"
git init -q . && git config user.email a@b && git config user.name a
cat >CMakeLists.txt <<'END'
cmake_minimum_required(VERSION 3.25)
project(small NONE)
enable_testing()
add_subdirectory(tests/room)
END
cat >tests/room/CMakeLists.txt <<'END'
set(t ${CMAKE_CURRENT_SOURCE_DIR}/t.sh)
foreach(n a.One a.Two b.Bad c.Flicker d.Crash)
  add_test(NAME test_${n} COMMAND ${t} ${n})
  set_tests_properties(test_${n} PROPERTIES LABELS rtl)
endforeach()
add_test(NAME formal.thing COMMAND ${t} formal)
set_tests_properties(formal.thing PROPERTIES LABELS formal)
END
cat >tests/room/t.sh <<'END'
#!/bin/sh
case $1 in
b.Bad) [ "$SEED" = 7 ] || { echo "x.cpp:12: Failure"; echo "value $SEED is not 7 </script>"; exit 1; } ;;
c.Flicker) [ ! -e ../../../../flicker ] ;;
d.Crash) kill -SEGV $$ ;;
formal) echo "kept: the verdict of yesterday"; echo "thing: bounded, 6 clocks"; echo "thing: proven, 12 clauses with 3 flops"; echo "thing: 2 covers reached" ;;
esac
END
chmod +x tests/room/t.sh
echo build >.gitignore
cmake -S . -B build/main -G Ninja >/dev/null
ln -s "$build/page" build/main/page
git add . && git commit -qm one
run() { status=0; "$regress" "$@" >out.txt 2>&1 || status=$?; }

case $case in
results)
    run --seed 5
    [ $status -eq 1 ] || fail "exit status $status, not 1"
    has "4 passed, 2 failed, 0 skipped"
    has "^proofs *green *1 hold, 1 of them as before, from unchanged files$"
    has "make test NAME='^test_b\\\\.Bad\$\$' SEED=5"
    has "value 5 is not 7" build/regress/failures/test_b.Bad-5.log
    has 'failures="2"' build/regress/junit.xml
    has "test_d.Crash" build/regress/summary.md
    has "1 x  SegFault without a word"
    has 'message="value 5 is not 7 &lt;/script&gt; (SEED=5)"' build/regress/junit.xml
    has '| x.cpp:12: value 5 is not 7 &lt;/script> | test_b.Bad | ' build/regress/summary.md
    hasNot "not 7 </script>" build/regress/report.html
    [ "$(wc -c <build/regress/report.html)" -lt 2000000 ] || fail "the page is over 2 MB"
    ;;
rude) # tests that misbehave: the first line says so, and the run goes on
    while IFS='^' read -r name does says; do
        echo "add_test(NAME test_r.$name COMMAND sh -c [=[$does]=])" >>tests/room/CMakeLists.txt
        echo "$says" >>said
    done <<'END'
Hang^exec sleep 1000^^1 x  Timeout
Loud^yes 'a line' | head -c 1000000; echo; echo 'x is 3'; exit 1^^1 x  x is 3$
Long^head -c 300000 /dev/zero | tr '\0' x; exit 1^^1 x  \.\.\.$
Crash^echo begun; kill -SEGV $$^^1 x  SegFault: begun$
Mute^exit 3^^1 x  failed without a word$
Red^printf '\033[31mx.c:1: error: red\033[0m\n'; exit 1^^1 x  x.c:1: error: red$
Leaves^setsid sleep 1000 >/dev/null 2>&1 &^A test has left behind, and it was ended: .*sleep 1000 (in build/main/tests/room)$
Writes^echo >../../../../written^^Changed while the tests ran, .*: written$
END
    printf 'add_test(NAME test_r.Gone COMMAND /none)\nset_tests_properties(test_r.Hang PROPERTIES TIMEOUT 2)\n' >>tests/room/CMakeLists.txt
    echo '^1 x  Unable to find executable: /none$' >>said
    cmake build/main >/dev/null
    run --name test_r --jobs 4
    [ $status -eq 1 ] && has '^2 passed, 7 failed, 0 skipped' || fail "exit status $status"
    while read -r line; do has "$line"; done <said
    (trap '' XFSZ && ulimit -f 500 && "$regress" --name test_a >out.txt 2>&1) && fail "a full disk is not told" # a file of 250 KB is one
    has '^2 passed, 0 failed' && has '^regress: cannot write build/regress/report.html: is the disk full?$'
    [ ! -e build/regress/report.html.part ] && [ "$(wc -l <build/regress/history.jsonl)" = 2 ] || fail "after a full disk"
    ;;
plan) # which requirement is proven, failed, has not run with these sources, or has no test
    cat >tests/plan.toml <<'END'
[thing]
"It works" = "test_a.* formal.thing"
"It stands" = "test_a.One test_b.*"
"It flies" = "test_c.Nobody*"
END
    run --plan
    [ $status -eq 1 ] && has '^no test is called test_c.Nobody\*, which is to prove: It flies$' || fail "a pattern without a test"
    sed -i '$d' tests/plan.toml
    run --plan
    [ $status -eq 0 ] && has '^2 requirements$' || fail "each pattern has a test"
    run --name 'a.One'
    has '^plan  *grey   *0 of 2 requirements'
    run --name 'a[.]|formal'
    has '^plan  *grey   *1 of 2 requirements'
    run --name 'b.Bad'
    has '^plan  *red  *1 of 2 requirements of docs/ are not proven: It stands$'
    has '^| It stands | thing | test_b.Bad |$' build/regress/summary.md
    has '"open":\["test_b.Bad"\],"page":"thing","patterns":\["test_a.One","test_b.\*"\],"state":"failed"' build/regress/report.html
    run --name 'b.Bad' --seed 7
    has '^plan  *green  *2 requirements'
    echo "# changed" >>tests/room/t.sh
    run --name 'a.One'
    has '^plan  *grey   *0 of 2 requirements'
    printf 'add_test(NAME test_late_NOT_BUILT COMMAND false)\n' >>tests/room/CMakeLists.txt
    cmake build/main >/dev/null
    echo '"It comes" = "test_late.One"' >>tests/plan.toml
    run --plan
    [ $status -eq 0 ] || fail "a program that is not built may have any test"
    echo '"It has no test" = ""' >>tests/plan.toml
    run --plan
    [ $status -eq 2 ] && has 'plan.toml: It has no test: not' || fail "a line that is none is not told"
    echo 'It is none' >>tests/plan.toml
    run --plan
    [ $status -eq 2 ] && has 'plan.toml: .*line 6' || fail "a line that is no TOML is not told"
    ;;
blame) # one group for one bug; a test's own last word; the failure nearest to the cause first
    cat >>tests/room/CMakeLists.txt <<'END'
foreach(i 1 2 3)
  add_test(NAME test_g.Case${i} COMMAND sh -c "printf 'x.cpp:1: Failure\nExpected 1, got 2\n[  FAILED  ] g.Case${i} (${i}7 ms)\n'; exit 1")
endforeach()
set(n 0) # as tools name a wrong line: Verilator, the pages' test, GHDL, GCC, slice2c, a sanitizer
foreach(said "%Error: bus/counter.v:5:9: wrong" "lamp.vhd:4:5:@0ms:(assertion failure): dark" "twice.c:3:5: warning: ISO C90" "Lamp.ice:1:36: error: no Colour" "SUMMARY: AddressSanitizer: leak")
  math(EXPR n "${n} + 1")
  add_test(NAME lint.tool${n} COMMAND sh -c "echo '${t}: begun'; echo '${said}'; echo 'make: *** [x] Error 1'; exit 1")
endforeach()
add_test(NAME ice.x COMMAND sh -c "printf 'ran\n! error: unexpected operation mode. expected Normal, received Idempotent\n}\n'; exit 1")
add_test(NAME python.x COMMAND python3 -c "print('begun'); {}['key']")
add_test(NAME mission.x COMMAND sh -c "echo 'Ice.Exception: not served, as expected'; echo 'the picture differs'; exit 1")
set(at ${CMAKE_SOURCE_DIR}/hdl/a/broken_proof.vh:1)
foreach(m around broken) # as Yosys writes it: all cells around, and the end of the line before
  add_test(NAME formal.${m} COMMAND sh -c "echo 'Assert failed in ${m}: ${CMAKE_SOURCE_DIR}/hdl/a/around.v:7.1-8.9|${at}.6-3.20 ($flatten/u_x./u_y.$assert$${at}$12)'; touch '${CMAKE_BINARY_DIR}/t.vcd'; echo '${m}: trace: ${CMAKE_BINARY_DIR}/t.vcd'; echo '${m}: an assertion fails'; exit 1")
endforeach()
END
    mkdir -p hdl/a
    printf 'begin\n    assert (full ||\n        !taken);\nend\n' >hdl/a/broken_proof.vh
    cmake build/main >/dev/null
    run --name 'test_g|mission|formal|ice|python|lint'
    for said in '%Error: bus/counter.v:5:9: wrong' 'lamp.vhd:4:5:@0ms:(assertion failure): dark' 'twice.c:3:5: warning: ISO C90' 'Lamp.ice:1:36: error: no Colour' 'SUMMARY: AddressSanitizer: leak'; do
        has "^1 x  $said\$"
    done
    has '^3 x  Expected 1, got 2$'
    has '^1 x  the picture differs$'
    has '^1 x  ! error: unexpected operation mode. expected Normal, received Idempotent$'
    has "^1 x  KeyError: 'key'$"
    has 'message="! error: unexpected operation mode' build/regress/junit.xml
    [ "$(grep -m1 ' x  ' out.txt)" = '2 x  hdl/a/broken_proof.vh:2: assert (full || !taken);' ] || fail "the proof is not told first"
    grep -m1 '^    make test' out.txt | grep -q broken || fail "the module that has the assertion is not told first"
    has 'gtkwave build/regress/failures/formal.broken.vcd'
    [ -f build/regress/failures/formal.broken.vcd ] || fail "the proof's trace is not kept"
    has '<property name="wave" value="build/regress/failures/formal.broken.vcd"' build/regress/junit.xml
    has '^The longest: .* s '
    ;;
changed) # the changed files of a failed test since it passed: committed or not, new or gone; for a program its sources
    mkdir -p hdl/fifo docs
    printf 'a\nb\nc\nd\n' >hdl/fifo/fifo.v
    echo 1 >hdl/old.v && echo 1 >docs/page.md
    printf '#include "n.h"\nint main(void) { return LIMIT; }\n' >hdl/fifo/test.c && echo '#define LIMIT 0' >hdl/fifo/n.h
    sed -i 's/small NONE/small C/' CMakeLists.txt
    cat >>tests/room/CMakeLists.txt <<'END'
add_executable(test_u ${CMAKE_SOURCE_DIR}/hdl/fifo/test.c)
add_test(NAME test_u.Unit COMMAND test_u)
END
    cmake build/main >/dev/null && ninja -C build/main test_u >/dev/null
    run --name 'a.One|u.Unit'
    [ $status -eq 0 ] || fail "exit status $status, not 0"
    git add . && git commit -qm two
    sed -i 's/^case .1 in/&\na.One) exit 1 ;;/' tests/room/t.sh
    run --name 'b.Bad' # never passed: files that are not committed
    has '^        changed since the commit; it is not known to have passed: tests/room/t.sh:3 (1 line)$'
    printf 'a\nB\nc\nD\nE\n' >hdl/fifo/fifo.v && rm hdl/old.v && echo 2 >docs/page.md && git commit -qam three
    run --changed --prepare --list --name u.Unit # new.v is none of its inputs, a header is
    has '^Nothing to run'
    echo 'int g;' >hdl/new.v && echo '#define LIMIT 3' >hdl/fifo/n.h
    run --changed --prepare --list --name u.Unit
    has '^tests/room/test_u$'
    ninja -C build/main test_u >/dev/null
    run --name 'a.One|u.Unit' --seed 2
    passed=$(git rev-parse --short=10 HEAD~2) # and files that were not committed then
    has "^        changed since it passed at $passed with SEED=1: hdl/fifo/n.h:1 (1 line), hdl/new.v:1 (1 line), hdl/fifo/fifo.v:2 (3 lines), hdl/old.v:1 (1 line), tests/room/t.sh:3 (1 line)$" # mine first
    has "^        changed since it passed at $passed with SEED=1: hdl/fifo/n.h:1 (1 line), tests/room/t.sh:3 (1 line)$" # its program, its folder
    has '<property name="changed" value="changed since it passed' build/regress/junit.xml
    has '"changed":"changed since it passed' build/regress/report.html
    ! git cat-file -e "$(git hash-object hdl/new.v)" 2>/dev/null || fail "the repository has got objects"
    echo flicker >.git/info/exclude && run --name c.Flicker && touch flicker
    run --name c.Flicker
    has '^        nothing has changed since it passed at [0-9a-f]*$'
    rm -r build/regress/tree # without noted trees the commit is left
    run --name a.One
    has "^        changed since it passed at $passed: hdl/fifo/n.h:1 (1 line), hdl/new.v:1 (1 line), hdl/fifo/fifo.v:1 (5 lines), .* tests/room/t.sh"
    ;;
company) # progress, one run at a time, messages about mistyped words, no needless builds
    run --name 'a.One|formal'
    has '^1 of 2, 0 failed, 1 left' # nobody knows how long they take
    has '^2 of 2, 0 failed, 0:00 left'
    has '^tests  *green  1 passed, 4 did not run$'
    has '^proofs  *green  1 hold, 1 of them'
    run --seed abc
    [ $status -eq 2 ] || fail "exit status $status, not 2, for a seed that is none"
    has "'abc' is neither a number nor .random"
    run --jobs none
    [ $status -eq 2 ] || fail "exit status $status, not 2, for a bad option"
    has "^regress: .*see --help"
    printf 'add_test(NAME test_a.OneMore COMMAND true)\n' >>tests/room/CMakeLists.txt
    run --name test_a.One
    has '^1 passed' # an exact name is one test
    cat >>tests/room/CMakeLists.txt <<'END'
add_custom_command(OUTPUT ${CMAKE_BINARY_DIR}/tool COMMAND touch ${CMAKE_BINARY_DIR}/tool)
add_custom_command(OUTPUT ${CMAKE_BINARY_DIR}/other COMMAND touch ${CMAKE_BINARY_DIR}/other)
add_custom_target(tools ALL DEPENDS ${CMAKE_BINARY_DIR}/tool ${CMAKE_BINARY_DIR}/other)
add_test(NAME script.tool COMMAND ${t} ${CMAKE_BINARY_DIR}/tool ${CMAKE_CURRENT_BINARY_DIR}/work)
add_test(NAME script.whole COMMAND ${t} ${CMAKE_BINARY_DIR})
add_test(NAME script.says COMMAND ${t} ${CMAKE_BINARY_DIR})
set_tests_properties(script.says PROPERTIES ENVIRONMENT "NEEDS=other tools")
add_test(NAME script.after COMMAND ${t})
set_tests_properties(script.tool PROPERTIES FIXTURES_SETUP f)
set_tests_properties(script.after PROPERTIES FIXTURES_REQUIRED f)
foreach(n soon radio)
  add_test(NAME test_${n}_NOT_BUILT COMMAND false)
  file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/test_${n}_labels.cmake "PROPERTIES LABELS \"${n};x\"")
endforeach()
END
    cmake build/main >/dev/null
    needs() { run --prepare --list "$@" && tr '\n' ' ' <out.txt; }
    same() { [ "$1" = "$2" ] || fail "'$1' is built, not '$2'"; }
    same "$(needs --name '^script.whole')" "all "
    same "$(needs --name '^script.says')" "other tools "
    same "$(needs --name '^test_a')" ""
    same "$(needs --name 'script\.after')" "tool " # by what goes before it
    same "$(needs --name 'soon\.')" "test_soon "
    same "$(needs --name 'One')" "test_radio test_soon " # any may have such a case
    same "$(needs --label 'rtl|radio')" "test_radio "
    run --prepare --name script.tool
    [ $status -eq 0 ] && has '^Building tool ' && [ -e build/main/tool ] && [ ! -e build/main/other ] || fail "more or less is built than a test needs"
    # With --changed: tests that have never passed here and do not depend on an edit are not built.
    git add . && git commit -qm more
    same "$(needs --changed --name '^script|soon|radio')" "Nothing to run: no test changed since the last run. "
    echo '# edit' >>tests/room/t.sh
    same "$(needs --changed --name '^script.says')" "other tools "
    git checkout -q tests/room/t.sh
    run --prepare --name '^test_a.Nobody'
    [ $status -eq 2 ] && has "no test is chosen by NAME='^test_a.Nobody'; .ctest --test-dir" || fail "a name that no test has"
    git checkout -q HEAD~1 tests/room/CMakeLists.txt
    printf 'add_test(NAME test_late_NOT_BUILT COMMAND false)\n' >>tests/room/CMakeLists.txt
    cmake build/main >/dev/null
    run --label formal
    has '1 passed, 1 failed' # programs that are not built may have that label: they are not left out
    # Another run has the lock until this one has said that it waits.
    flock build/regress/lock sh -c 'touch held; until grep -q "waiting for another run" out.txt; do sleep 0.1; done' &
    until [ -e held ]; do sleep 0.1; done
    run --name a.One
    has 'waiting for another run in build/regress'
    wait
    ;;
selection)
    run --block room --list && [ "$(wc -l <out.txt)" -eq 6 ] || fail "block room"
    run --block thing --list && [ "$(cat out.txt)" = formal.thing ] || fail "block thing"
    run --label formal --list && [ "$(cat out.txt)" = formal.thing ] || fail "label formal"
    run --name One --list && [ "$(cat out.txt)" = test_a.One ] || fail "name One"
    run --name nothing
    [ $status -eq 2 ] || fail "exit status $status, not 2, where nothing is chosen"
    has "labels: formal rtl"
    run --name '*'
    [ $status -eq 2 ] && has "^regress: .*'\*' is no regular expression" || fail "a pattern that is none"
    run --build nowhere
    [ $status -eq 2 ] || fail "exit status $status, not 2, without a build"
    ;;
again)
    run
    run --rerun-failed
    has "2 tests, SEED=1"
    run --changed
    has "2 tests, SEED=1" # the tests that passed have not changed
    echo "# changed" >>tests/room/t.sh
    run --changed
    has "6 tests, SEED=1"
    run --name 'a.One' --repeat 3 --seed 7
    has "SEED=9"
    has "3 passed, 0 failed"
    # A removed bug: the failed tests run, and the sources of the last pass count as that pass.
    printf '[thing]\n"It works" = "test_a.One"\n' >tests/plan.toml
    cp tests/room/t.sh right && sed -i 's/^case .1 in/&\na.One) exit 1 ;;/' tests/room/t.sh
    run --changed --name a.One
    has '^plan  *red' && has 'test_a.One SEED=1$' build/regress/summary.md
    cp right tests/room/t.sh
    run --name a.Two
    has '^plan  *green'
    run --changed --name a.One
    has '^1 tests, SEED=1$' && has '^plan  *green' && hasNot 'test_a.One SEED=1$' build/regress/summary.md
    ;;
flaky)
    run
    hasNot Flaky
    touch flicker
    run
    has "Flaky: test_c.Flicker"
    has "test_c.Flicker" build/regress/summary.md
    echo '{"damaged' >>build/regress/history.jsonl
    run --name One
    has "1 damaged lines"
    [ $status -eq 0 ] || fail "a damaged history stops the run"
    ;;
seeds)
    run --kept
    [ $status -eq 0 ] || fail "exit status $status, not 0, where no seed is kept"
    has "no seed is kept"
    run --name 'test_[ab]' --seed random --repeat 2
    [ $status -eq 1 ] || fail "exit status $status, not 1"
    seeds=$(sed -n 's/^3 tests, SEED=//p' out.txt)
    [ "$(echo "$seeds" | wc -l)" -eq 2 ] || fail "not two seeds"
    for seed in $seeds; do has "\"seed\":\"$seed\",\"since\":.*\"test\":\"test_b.Bad\"" build/regress/seeds.jsonl; done
    hasNot test_a build/regress/seeds.jsonl
    run --name 'test_[ab]' --seed 7 # passes with another seed: the others stay
    has "2 failing seeds are kept"
    cp build/regress/report.html page.html
    run --kept --name 'a[.]' # none of these: another run's page stays unchanged
    has "no seed is kept"
    cmp -s page.html build/regress/report.html || fail "a run of nothing has written over another run's page"
    run --kept
    [ $status -eq 1 ] || fail "exit status $status, not 1, where kept seeds still fail"
    for seed in $seeds; do has "^1 tests, SEED=$seed"; done
    has "0 passed, 2 failed"
    has '"times":2' build/regress/seeds.jsonl
    has "test_b.Bad SEED=${seeds##*
}" build/regress/summary.md
    has '"seeds":\[{' build/regress/report.html
    sed -i 's/^b.Bad).*/b.Bad) ;;/' tests/room/t.sh # the bug is mended
    run --kept
    [ $status -eq 0 ] || fail "exit status $status, not 0, when kept seeds pass"
    [ ! -s build/regress/seeds.jsonl ] || fail "seeds that pass are kept"
    ;;
bisect) # of five commits the third breaks test_a.One; the second does not configure; the checkout stays as it is
    : >change && git add change && git commit -qm "something else"
    echo 'broken(' >>CMakeLists.txt && git commit -qam "does not configure"
    git revert --no-edit HEAD >/dev/null
    run --name a.One # passes, and is noted
    sed -i 's/^case .1 in/&\na.One) exit 1 ;;/' tests/room/t.sh && git commit -qam "breaks it"
    for n in 1 2; do echo $n >change && git commit -qam "later $n"; done
    echo mine >change
    git status --short >before.txt
    mkdir -p build/main/tests/regress && ln -sf "$regress" build/main/tests/regress/regress
    bisect() { status=0; ICESOC_TREE=. "$source/icesoc" bisect --built "$@" >out.txt 2>&1 || status=$?; }
    bisect test_a.One
    [ $status -eq 0 ] || fail "exit status $status, not 0"
    has '^since [0-9a-f]* breaks it (a, '
    bisect test_a.One --good "$(git rev-list --max-parents=0 HEAD)"
    has '^since [0-9a-f]* breaks it (a, '
    [ "$(cat change)" = mine ] && [ ! -e build/bisect/tree ] || fail "the checkout is changed"
    bisect test_a.Two --good "$(git rev-list --max-parents=0 HEAD)"
    [ $status -eq 2 ] && has 'passes at' || fail "a test that passes"
    bisect test_b.Bad
    [ $status -eq 2 ] && has 'GOOD= names one' || fail "no commit to begin with"
    bisect test_a.One --good nonsense
    [ $status -eq 2 ] && has 'no commit GOOD=nonsense' || fail "a commit that is none"
    ;;
page)
    cat >t.vcd <<'END'
$timescale 1ns $end $scope module top $end $var wire 1 ! clk_i $end $scope module u_fifo $end $var wire 1 ! clk_i $end
$var reg 8 " level [7:0] $end $var reg 8 & mask [7:0] $end $upscope $end $upscope $end
$scope module program $end $var string 1 p.task task $end $upscope $end $enddefinitions $end
#0 0! b0 " b1010 & sUAV_radioTask p.task #5 1! #10 0! b10100111 " #15 1!
END
    cat >>tests/room/CMakeLists.txt <<'END'
add_test(NAME formal.broken COMMAND sh -c "echo 'Assert failed in broken'; echo 'broken: trace: ${CMAKE_SOURCE_DIR}/t.vcd'; exit 1")
END
    cmake build/main >/dev/null
    mkdir -p build/coverage
    echo '{"total": 97, "toggles": 95, "files": [{"file": "hdl/fifo/fifo.v", "percent": 97, "lines": 200, "gate": 95, "toggles": 96, "toggle_points": 9,
        "toggle_gate": 95, "why": "", "missed": ["12: level_o[3]", "40"]}]}' >build/coverage/summary.json
    run
    opened() { # page
        chromium --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --user-data-dir="$work/chromium" \
            --virtual-time-budget=5000 --dump-dom "file://$work/$1" >dom.html 2>chromium.log || fail "chromium: $(tail -3 chromium.log)"
    }
    # If the libraries could not be fetched, the page is complete and says how to get them.
    sed '/^!function.*Tabulator=/d; /^.*var uPlot=/d' build/regress/report.html >plain.html
    opened plain.html
    has 'Tabulator and uPlot could not be fetched. With a network' dom.html
    has '<td>test_c.Flicker</td>' dom.html
    has 'class="dot dp"' dom.html
    [ -s "$build/page/libraries.js" ] || { echo "skipped: Tabulator and uPlot could not be fetched"; exit 77; }
    # A second script clicks as a user does, also on a table and a chart of its own, and writes what it then sees.
    cat >clicks.js <<'JS'
const seen = [], $ = (selector, at = document) => at.querySelector(selector), wait = () => new Promise(done => setTimeout(done, 300));
const column = (at, n) => [...at.querySelectorAll(".tabulator-row")].map(row => row.querySelectorAll(".tabulator-cell")[n].textContent).join(" ");
const key = (node, key) => node.dispatchEvent(new KeyboardEvent("keydown", {key, bubbles: true}));
(async () => {
  await wait();
  const results = $("#results"), test = $(".tabulator-col", results), filter = $("input", results.parentElement);
  test.click();
  key(test, "Enter");
  seen.push(`sorted ${column(results, 0)}`);
  filter.value = "ROOM fli";
  filter.oninput();
  window.Blob = function(parts) { seen.push(`csv ${parts.join("").replace(/\n/g, " / ")}`); };
  URL.createObjectURL = () => "";
  HTMLAnchorElement.prototype.click = () => {}; // nothing is downloaded
  $("button", results.parentElement).click();
  seen.push(`filtered ${column(results, 0)}`);
  const many = element("div"), few = element("div"), drawn = element("div");
  document.body.append(many, few, drawn);
  table(many, [["n", r => r]], [...Array(2000).keys()]);
  table(few, [["name", r => r.name], ["n", r => r.n]], [{name: "<a>", n: 9}, {name: "b", n: 10, below: [{name: "c", n: 1}]}],
    {id: "few", children: r => r.below, pick: r => seen.push(`picked ${r.name}`)});
  chart(drawn, {labels: ["i", "ii", "iii"], series: [{name: "s", colour: "--good", values: [1, null, 4], says: i => `no. ${i}`, bars: true}], limits: [{name: "l", value: 2, colour: "--bad"}]});
  await wait();
  seen.push(`of 2000 ${many.querySelectorAll(".tabulator-row").length < 300 ? "some" : "all"}`);
  few.querySelectorAll(".tabulator-col")[1].click();
  seen.push(`largest ${column(few, 0)}`);
  key($(".tabulator-row", few), "Enter");
  key($(".tabulator-row", few), "ArrowRight");
  seen.push(`open ${column(few, 0)}`);
  const read = () => [...drawn.querySelectorAll(".u-value")].map(v => v.textContent).join(" "), canvas = $("canvas", drawn), pixels = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
  const drawnIn = (r, g, b) => pixels.some((_, i) => i % 4 === 0 && pixels[i] === r && pixels[i + 1] === g && pixels[i + 2] === b && pixels[i + 3] === 255);
  seen.push(`canvas ${drawnIn(21, 122, 60)} ${drawnIn(179, 38, 30)}`, `read ${read()}`);
  key(drawn, "ArrowLeft");
  key(drawn, "ArrowLeft");
  seen.push(`moved ${read()}`);
  filter.value = "";
  filter.oninput();
  document.body.append(element("p", `seen: ${seen.join("; ")};`));
})();
JS
    { sed '/^<\/body>/,$d' build/regress/report.html; echo '<script>'; cat clicks.js; echo '</script></body></html>'; } >clicked.html
    opened clicked.html
    sed -n 's/.*<p>\(seen: .*;\)<.*/\1/p' dom.html >out.txt
    has 'sorted test_d.Crash test_c.Flicker test_b.Bad test_a.Two test_a.One formal.thing formal.broken;'
    has 'filtered test_c.Flicker;'
    has 'csv "test",.* / "test_c.Flicker","passed",'
    has 'of 2000 some; largest b &lt;a&gt;; picked b; open b c &lt;a&gt;; canvas true true; read iii no. 2 2; moved i no. 0 2;'
    has '3 failed' dom.html
    has 'class="waveform"' dom.html
    has '>top.clk_i<' dom.html     # the outermost of its names
    has '>top.u_fifo.level<' dom.html
    has '>a7<' dom.html
    has '>top.u_fifo.mask<' dom.html # it stays constant
    has '>UAV_radioTask<' dom.html
    has 'id="results"' dom.html
    has 'test_c.Flicker' dom.html
    has 'id="runs".*>one<' dom.html # the commit's subject
    has '<div>test_b.Bad: value 1 is not 7' dom.html
    has 'class="dot dp"' dom.html
    has '12 clauses with 3 flops' dom.html
    has '<a href="../../hdl/fifo/fifo.v">hdl/fifo/fifo.v:12: level_o\[3\]</a><br><a href="../../hdl/fifo/fifo.v">hdl/fifo/fifo.v:40</a>' dom.html
    has 'id="seeds"' dom.html
    has 'value 1 is not 7' dom.html
    has 'at <a href="../../x.cpp">x.cpp:12</a>; log <a href="failures/test_b.Bad-1.log"' dom.html
    has 'to have passed: <a href="../../tests/room/CMakeLists.txt">tests/room/CMakeLists.txt:8</a> (1 line)' dom.html
    hasNot 'src="http\|href="http' build/regress/report.html # offline
    sed 's/test_d.Crash/&OfANameForWhichANarrowWindowHasNoRoomUnlessItIsBrokenSomewhere/g' build/regress/report.html >long.html
    "$source/tests/regress/test/look.sh" long.html || fail "the page"
    sed -i 's/of data.lights/of data.lihgts/' long.html
    ! "$source/tests/regress/test/look.sh" long.html >out.txt 2>&1 && has '^long.html:[0-9]*: Uncaught TypeError: data.lihgts is not iterable: for (const light' || fail "a script's error"
    ICESOC_TREE=. "$source/icesoc" build pictures --from build --to . regression >/dev/null || fail "its picture"
    [ "$(head -c 4 regression.png | tail -c 3)" = PNG ] && [ "$(wc -c <regression.png)" -lt 100000 ] || fail "its picture is none, or large"
    ;;
waves) # a test that runs beside a core, not below tests/; a trace that is damaged: the report comes in any case
    mkdir -p ip/core build/trace/ip/core/verilated_core testbench/common
    cp "$source/testbench/common/join_waves.sh" testbench/common
    cat >ip/core/wave.sh <<'END'
#!/bin/sh
echo "wrong at clock cycle 5"
[ -z "${WAVE:-}" ] || vcd2fst "${0%/*}/t.vcd" "$WAVE"
exit 1
END
    chmod +x ip/core/wave.sh
    cat >ip/core/CMakeLists.txt <<'END'
add_test(NAME test_w.Wave COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/wave.sh)
add_test(NAME formal.damaged COMMAND sh -c "echo 'damaged: trace: ${CMAKE_CURRENT_SOURCE_DIR}/damaged.vcd'; exit 1")
add_custom_target(test_w)
END
    # shellcheck disable=SC2016 # VCD's
    echo '$timescale 1ns $end $var wire 1 ! clk_i $end $enddefinitions $end #0 0! #5 1! #10 0!' | tee ip/core/t.vcd | sed 's/#5/#five/' >ip/core/damaged.vcd
    echo 'VL_IN8(&clk_i,0,0);' >build/trace/ip/core/verilated_core/Vcore.h
    echo 'add_subdirectory(ip/core)' >>CMakeLists.txt
    cmake build/main >/dev/null
    run --name 'test_w|damaged'
    has '^0 passed, 2 failed'
    has 'formal.damaged.vcd is damaged, and not drawn'
    has '^TOP.clk_i$' build/regress/failures/test_w.Wave-1.gtkw
    has 'test_w.Wave-1.fst' build/regress/report.html
    ;;
flight) # a flight that fails is flown again around the last event of a core, by a simulator that writes this waveform
    mkdir -p build/trace/testbench/sim build/trace/gen fly testbench/common
    printf 'camera u_camera (\n  .clk_i(clk_i), `SLOT(2), .irq_o(i));\ncore u_core (\n    .clk_i(clk_i), `SLOT(3), .irq_o(j));\n' >build/trace/gen/soc_cores.vh
    cp "$source/testbench/common/join_waves.sh" testbench/common
    printf 'rule r\n command = true\nbuild icesoc-sim: r\n' >build/trace/build.ninja
    cat >build/trace/testbench/sim/icesoc-sim <<'END'
#!/bin/sh
echo "$@" >asked
while [ "$1" != --wave ]; do shift; done
printf '$timescale 1ps $end\n$scope module TOP $end\n$var wire 1 ! irq_o $end\n$scope module u_core $end\n$var wire 1 & busy $end\n$upscope $end\n$upscope $end\n$enddefinitions $end\n#10\n0!\n0&\n#20\n1!\n1&\n' | vcd2fst - "$2"
printf '$timescale 1 ps $end\n$scope module program $end\n$var string 1 p.task task $end\n$upscope $end\n$enddefinitions $end\n#3\nsidleTask p.task\n#20\nsradioTask p.task\n#33\nsidleTask p.task\n' >"$2.program.vcd"
END
    chmod +x build/trace/testbench/sim/icesoc-sim
    printf '{"ns":1000000000,"slot":1,"events":1}\n{"ns":1500000000,"slot":3,"events":1}\n{"ns":1900000000,"slot":1,"events":1}\n{"ns":2' >fly/events.jsonl
    cat >ended <<'END'
  0.1 s  UAV -> ground
mission: the vision core's result differs from the C++ reference: 141 corners, not 140
-- 11/23/26 06:27:52.116 XBeeAT: link idle
icesoc-sim: Cortex-M3: 748300 instructions; asleep 99.5 % of the time
icesoc-sim: 2.0 s simulated, 37 packets on the air
The mission failed (exit status 1).
Its end as a waveform: make run REPLAY='fly' FROM=1.500 TO=2.000
Its end, and backwards from there: make gdb REPLAY='fly'
END
    cat >>tests/room/CMakeLists.txt <<'END'
add_test(NAME mission.x COMMAND sh -c "cat ${CMAKE_SOURCE_DIR}/ended; exit 1")
set_tests_properties(mission.x PROPERTIES LABELS e2e)
END
    cmake build/main >/dev/null
    run --name mission --waves 3
    has "^1 x  mission: the vision core's result differs from the C++ reference: 141 corners"
    has '^--replay fly --out build/regress/failures/mission.x-1.replay --wave .*mission.x-1.fst --from 1.498500 --to 1.500500$' asked
    fst2vcd build/regress/failures/mission.x-1.fst | sed -n '/^#/,$p' | tr '\n' ' ' >rows
    has '#3 .*sidleTask .*#10 .*0. .*#20 .*1. .*sradioTask .*#33 sidleTask' rows
    has '^program.task$' build/regress/failures/mission.x-1.gtkw
    has '"program.task",0,\[3,"idleTask",20,"radioTask",33,"idleTask"\]\],\["TOP.u_core.busy"' build/regress/report.html # the core before ports
    ;;
large) # more tests than this project has: the page stays small
    cat >>tests/room/CMakeLists.txt <<'END'
foreach(i RANGE 1 400)
  add_test(NAME test_with_a_long_name.AndManyCases.Number/${i} COMMAND ${t} a.${i})
endforeach()
foreach(i RANGE 1 30)
  add_test(NAME test_loud.Case${i} COMMAND sh -c "seq 1 20000; exit 1")
endforeach()
foreach(i RANGE 1 8)
  add_test(NAME formal.long${i} COMMAND sh -c "echo 'long${i}: trace: ${CMAKE_SOURCE_DIR}/long.vcd'; exit 1")
endforeach()
END
    awk 'BEGIN { print "$scope module top $end"
        for (s = 0; s < 100; s++) printf "$var wire 16 s%d a_signal_%d $end\n", s, s
        print "$upscope $end $enddefinitions $end"
        for (t = 0; t < 300; t++) { print "#" 1000000 + t; for (s = 0; s < 100; s++) print "b1" t % 2 "10101010101010 s" s } }' >long.vcd
    mkdir -p build/coverage build/mutants
    awk 'BEGIN { printf "{\"total\": 97.1, \"toggles\": 95.2, \"files\": ["
        for (f = 0; f < 600; f++) {
            printf "%s{\"file\": \"hdl/block/some_module_%d.v\", \"percent\": 97, \"lines\": 200, \"gate\": 95, \"toggles\": 96, \"toggle_points\": 900, \"toggle_gate\": 95, \"why\": \"\", \"missed\": [", f ? "," : "", f
            for (m = 0; m < 500; m++) printf "%s\"%d: some_signal_of_it[%d]\"", m ? "," : "", m, m
            printf "]}" }
        print "]}" }' >build/coverage/summary.json
    awk 'BEGIN { for (i = 0; i < 400; i++) printf "block/some_seeded_bug_%d\tcaught\ttest_block.Case\t7\n", i }' >build/mutants/results.tsv
    cmake build/main >/dev/null
    run
    has "404 passed, 40 failed"
    [ "$(grep -o '"signals":\[\["top.a_signal_' build/regress/report.html | wc -l)" = 8 ] || fail "there are not eight drawings"
    [ "$(wc -c <build/regress/report.html)" -lt 2000000 ] || fail "the page has $(wc -c <build/regress/report.html) bytes"
    ;;
lights_*) . "$source/tests/regress/test/lights.sh" ;;
commands_*) . "$source/tests/regress/test/commands.sh" ;;
*) fail "no such case" ;;
esac
