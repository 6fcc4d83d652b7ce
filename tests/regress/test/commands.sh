# SPDX-License-Identifier: MIT
#
# commands: what commands do, by make, with each of its variables. Sourced by regress.sh, in its project.

# Runs make in the whole tree, where everything is built.
user() { status=0; "$source/tests/regress/test/make_in.sh" "$source" "$source" "$build" "$@" >out.txt 2>&1 </dev/null || status=$?; }
refused() { # words, then the command
    words=$1
    shift
    user "$@"
    [ $status -ne 0 ] && has "$words" && hasNot 'Traceback\|--help' || fail "$* is not refused"
}

# In this project, with all that commands ask of a build.
entrance() {
    mkdir -p cmake ip/fir tests/bench
    printf '#!/bin/sh\n' >cmake/setup.sh && chmod +x cmake/setup.sh
    touch ip/fir/fir_test.cpp
    cp "$source/tests/bench/figures.py" tests/bench
    sed -i 's/ d.Crash//' tests/room/CMakeLists.txt
    cat >waved <<'TEXT'
#!/bin/sh
case $1 in
--gtest_list_tests) printf 'Fir.\n  Impulse\n  ImpulseAndStep\n' ;;
*) echo "$1" >"$WAVE" ;;
esac
TEXT
    chmod +x waved
    cat >>tests/room/CMakeLists.txt <<TEXT
add_custom_target(regress ALL COMMAND mkdir -p tests/regress tests/hdl/formal/thing COMMAND ln -sf $regress tests/regress/regress
  COMMAND sh -c "echo 3 >tests/hdl/formal/thing/cpu" WORKING_DIRECTORY \${CMAKE_BINARY_DIR} VERBATIM)
foreach(target sanitized regmaps bench_programs)
  add_custom_target(\${target})
endforeach()
file(WRITE ${work}/size.json "[{\"name\": \"call\", \"value\": 4, \"unit\": \"bytes\"}]")
file(WRITE ${work}/air.json "[{\"name\": \"trip\", \"value\": 20, \"unit\": \"ms\", \"limit\": 40, \"share\": 0.5}]")
add_custom_target(size COMMAND cp ${work}/size.json ${work}/build)
add_custom_target(measure_good COMMAND cp ${work}/air.json ${work}/build/bench)
add_custom_target(measure_bad COMMAND test ! -e ${work}/slow COMMAND cp ${work}/air.json ${work}/build/bench/link.json)
add_custom_target(benches DEPENDS measure_bad measure_good)
add_custom_target(test_ip_fir ALL COMMAND cp ${work}/waved \${CMAKE_BINARY_DIR}/test_ip_fir)
file(WRITE \${CMAKE_BINARY_DIR}/cores.known "fir\n")
add_test(NAME test_ip_fir.Impulse COMMAND \${CMAKE_BINARY_DIR}/test_ip_fir --gtest_list_tests)
add_test(NAME test_s.Sane COMMAND sh -c "case \${CMAKE_BINARY_DIR} in *sanitized) ! test -e ../../../../leak ;; esac")
set_tests_properties(test_s.Sane PROPERTIES LABELS sanitized)
foreach(label zeroc nightly)
  add_test(NAME \${label}.Suite CONFIGURATIONS \${label} COMMAND sh -c "echo \${label} >>../../../../done")
  set_tests_properties(\${label}.Suite PROPERTIES LABELS \${label})
endforeach()
TEXT
}
here() { status=0; env -u MAKEFLAGS -u MFLAGS -u MAKELEVEL ICESOC_TREE="$work" make -s -C "$source" JOBS=1 "$@" >out.txt 2>&1 </dev/null || status=$?; }
good() { here "$@" && [ $status -eq 0 ] || fail "make $* ends with $status"; }
bad() { here "$@" && [ $status -ne 0 ] || fail "make $* succeeds"; }

case $case in
commands_run) # the program's message about an invalid value of a variable proves that the variable reaches it
    mkdir flight && echo '{}' >flight/flight.jsonl && echo up >flight/status
    refused "THRESHOLD is 0..255 grey levels, not '300'" run THRESHOLD=300
    refused "LOSS is the share .* not '7'" run LOSS=7
    refused "PORT is 0..65535, not 'x'" run PORT=x
    refused "CPU is host or m3, not 'x'" run CPU=x
    refused "APP is uav or minimal, not 'x'" run APP=x
    refused "core 'nobody' has no part in a mission" run CORES=nobody
    refused "OPEN=1 flies in the clear, KEY='$work/out.txt' does not" run OPEN=1 KEY="$work/out.txt"
    refused "SIZE is WIDTHxHEIGHT, .* not '96x64k'" run SIZE=96x64k OUT="$work/flight"
    refused "cannot read '/none'" run IMAGE=/none OUT="$work/flight"
    hasNot 'REPLAY=' # it would be of an earlier flight, still in the folder
    refused "cannot read '/none'" run PINS=/none OUT="$work/flight"
    refused "PROBE='fir.go=1' is a trigger of a probe: give --cores probe (CORES=probe), too" run PROBE=fir.go=1 OUT="$work/flight"
    refused "OUT='/proc/none' is no folder" run OUT=/proc/none
    refused "FROM is a number from 0 on s, not 'x'" run REPLAY="$work/flight" FROM=x # before a simulator is built for it
    refused "FROM=2.0 TO=1.0 are no span" run REPLAY="$work/flight" FROM=2 TO=1
    refused "cannot read '/none'" run UPDATE=/none CPU=m3 OUT="$work/flight"
    refused "no flight was recorded in '/none'" run REPLAY=/none
    refused "no flight was recorded in '/none'" gdb REPLAY=/none OUT="$work/replay"
    printf 'print $pc\nkill\n' >commands
    "$source/tests/regress/test/make_in.sh" "$source" "$source" "$build" gdb SIZE=96x64 OUT="$work/gdb" <commands >out.txt 2>&1 || fail "gdb"
    has 'Reset_Handler'
    user firmware
    [ $status -eq 0 ] && has '^Written: build/firmware.json' || fail "firmware"
    user faults NAME=no_memory MOMENTS=1 SEEDS=1 SEED=2
    [ $status -eq 0 ] && has '^faults: 1 moments of seeds 2 to 2, 0 failed' || fail "faults"
    for wrong in 'build JOBS=abc' 'fly MINUTES=abc' 'soak FUZZED=0' 'regress REPEAT=0' 'nightly NIGHTLY=x' 'faults MOMENTS=x' 'faults SEEDS=x' \
        'mutants DRAW=x' 'test TESTS=x' 'regress WAVES=-1' 'run SEED=-1' 'test SEED=7x'; do
        word=${wrong#* }
        # shellcheck disable=SC2086 # verb and variable
        refused "${word%=*} is a \(whole \)\?\(number\|time\).*, not '${word#*=}'" $wrong
    done
    refused 'faults: none is called nonsense; there are clock_step' faults NAME=nonsense
    refused 'there is no commit BASE=none' synth BASE=none
    ;;
commands_radio) # moments of what takes hours; of the two that run test_chip_soak, which is a test itself, one has it do something
    export GTEST_FILTER='-ChipSoak*'
    user soak MINUTES=0.01 FUZZED=1000
    unset GTEST_FILTER
    [ $status -eq 0 ] && has '^modem controller: 1000 bytes of noise' && has '^link layer: 10000 bytes of noise' || fail "soak"
    user fly MINUTES=0.01
    [ $status -eq 0 ] && has '^chip soak: .* simulated' || fail "fly"
    ;;
commands_small)
    entrance
    rm -rf build
    good build && [ -x build/main/tests/regress/regress ] || fail "make build builds not all"
    good test NAME=b.Bad LABEL=rtl SEED=7
    bad test NAME=b.Bad SEED=3
    has 'value 3 is not 7'
    bad test LABEL=nothing
    good test SEED=7
    [ "$(grep -c '100% tests passed' out.txt)" = 2 ] || fail "not once more with sanitizers"
    touch leak && bad test SEED=7
    has 'test_s.Sane' && rm leak
    good proofs && has '^1 proofs, 3 s of a processor$'
    good regress BLOCK=room NAME='[ab][.]' LABEL=rtl SEED=7 WAVES=0 TESTS=2
    has '^3 passed'
    bad regress NAME=b.Bad REPEAT=2
    has 'SEED=2'
    bad regress FAILED=1 && has '^1 tests' && bad regress KEPT=1 && has '^1 tests, SEED=2'
    good regress CHANGED=1 NAME='a[.]'
    # A bench that fails hides no other's figures, and its older figures do not count as new.
    mkdir -p docs
    good bench && [ "$(grep -c '^| trip | 20 ms | limit 40, 50.0 % |$' docs/figures.md)" = 2 ] || fail "$(cat docs/figures.md)"
    grep -q "^Measured on .* at commit $(git rev-parse --short HEAD) and changes to it\.$" docs/figures.md || fail "figures of an unknown commit"
    touch slow && bad bench && has measure_bad
    [ "$(grep -c '^| trip ' docs/figures.md)" = 1 ] && grep -q '^| call | 4 bytes |' docs/figures.md || fail "$(cat docs/figures.md)"
    DISPLAY='' good wave IP=fir TEST=Impulse
    has '^gtkwave .*/build/wave/fir.fst'
    [ "$(cat build/wave/fir.fst)" = --gtest_filter=Fir.Impulse ] || fail "another test than was asked for"
    DISPLAY='' good wave IP=fir TEST='And'
    bad wave IP=fir TEST=Imp
    has '2 tests, not one of'
    good ip-test IP=fir && has '1 tests passed\|100% tests passed'
    good ip-test IP=fir CORE_FOLDERS="$work/mine" && grep -q "^CORE_FOLDERS.*=$work/mine$" build/main/CMakeCache.txt || fail "CORE_FOLDERS"
    bad ip-test IP=nobody && has "there is no core 'nobody': fir"
    bad bisect TEST=test_a.One GOOD=nonsense BAD=HEAD SEED=1
    has 'no commit GOOD=nonsense'
    good clean && [ ! -e build ] || fail "make clean leaves build/"
    ;;
commands_nightly) # each step runs even if earlier ones failed, and each failure is reported
    entrance
    cat >icesoc <<'TEXT'
import sys
name = "_".join(word for word in sys.argv[1:4] if word.isalpha())
open("done", "a").write(name + "\n")
sys.exit(name == open("failing").read().strip())
TEXT
    sed -i 's/value $SEED is not 7/failed with $SEED/; s|"$SEED" = 7|! -e ../../../../bad|' tests/room/t.sh
    checks='check_sanitizers check_mutants check_mutants check_faults check_soak bench check_coverage'
    nightly() { # the step that fails
        : >done
        echo "$1" >failing
        here nightly NIGHTLY=2
        [ "$(tr '\n' ' ' <done)" = "zeroc nightly fly synth_report core_examples $checks check_fresh " ] || fail "where $1 fails only these are done: $(cat done)"
        [ "$(grep -c '^[0-9]* tests, SEED=' out.txt)" = "$2" ] || fail "not $2 seeds"
    }
    nightly none 2
    [ $status -eq 0 ] || fail "fails where nothing has"
    for step in check_mutants fly check_fresh; do
        nightly $step 2
        [ $status -ne 0 ] || fail "nobody says that $step has failed"
    done
    touch bad
    nightly none 2
    [ $status -ne 0 ] || fail "nobody says that a test has failed"
    nightly none 4 # and two that are kept
    ;;
esac
