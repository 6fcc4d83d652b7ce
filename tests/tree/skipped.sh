#!/bin/sh
# SPDX-License-Identifier: MIT
# skipped: skipped tests are named at the end with their reasons (tests/ctest.py).
# Usage: skipped.sh source-folder
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT TERM HUP
cat >"$work/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.25)
project(tiny NONE)
enable_testing()
add_test(NAME passes COMMAND true)
add_test(NAME by_script COMMAND sh -c "echo 'no right to mount'; exit 77")
add_test(NAME by_gtest COMMAND printf
         "[ RUN      ] A.B\\nfile.cpp:1: Skipped\\nno IPv6\\n\\n[  SKIPPED ] A.B\\n")
set_tests_properties(by_script by_gtest PROPERTIES SKIP_RETURN_CODE 77
                     SKIP_REGULAR_EXPRESSION "\\[  SKIPPED \\]")
END
cmake -S "$work" -B "$work/build" -G Ninja >/dev/null
"$1/tests/ctest.py" --test-dir "$work/build" >"$work/log" || { cat "$work/log" && exit 1; }
[ "$(tail -3 "$work/log")" = "Skipped, 2:
    by_script: no right to mount
    by_gtest: no IPv6" ] || { cat "$work/log" && exit 1; }
echo 'add_test(NAME fails COMMAND false)' >>"$work/CMakeLists.txt"
cmake "$work/build" >/dev/null
! "$1/tests/ctest.py" --test-dir "$work/build" >"$work/log" 2>&1 || {
    echo "a failed test is no error" && exit 1
}
