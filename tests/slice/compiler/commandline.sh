#!/bin/sh
# SPDX-License-Identifier: MIT
# commandline: slice2c sw-folder work-folder   Options, exit statuses, files that include others, dependencies.
set -eu
slice2c=$1 sw=$2 work=$3
rm -rf "$work"
mkdir -p "$work/slice/Lib"
cd "$work"
fail() { echo "commandline: $*" && exit 1; }
expect() { # status, words of the output, command...
    wanted=$1 words=$2
    shift 2
    status=0
    "$@" >log 2>&1 || status=$?
    [ $status = "$wanted" ] || { cat log && fail "exit status $status, not $wanted: $*"; }
    [ -z "$words" ] || grep -q -- "$words" log || { cat log && fail "'$words' is not said: $*"; }
}

cat >slice/Lib/Base.ice <<'ICE'
#pragma once
[["underscore"]]
module Lib { struct Point_ty { int x; int y; }; exception Failed { string why; }; interface Named { string name() throws Failed; };
             class Node { Node next; }; };
ICE
cat >slice/Lib/Middle.ice <<'ICE'
#ifndef MIDDLE
#define MIDDLE
#include <Lib/Base.ice>
module Lib { sequence<Point_ty> Points; interface Later; };
#endif
ICE
cat >slice/Top.ice <<'ICE'
#include <Lib/Middle.ice>
#include <Lib/Base.ice>
#ifdef WITH_MORE
module More { const int Amount = WITH_MORE; };
#endif
module Top {
    class Leaf extends Lib::Node { Lib::Points points; };
    exception Worse extends Lib::Failed { Lib::Later* whom; };
    interface Service extends Lib::Named { void go(Lib::Points points, Leaf leaf) throws Worse; };
};
ICE

expect 0 'output-dir' "$slice2c" --help
expect 0 'slice2c' "$slice2c" --version
expect 0 'slice2c' "$slice2c" -v
expect 1 'Slice file' "$slice2c"
expect 1 'no-such-option' "$slice2c" --no-such-option slice/Top.ice
expect 1 'cannot read' "$slice2c" no-such-file.ice
expect 1 'cannot read' "$slice2c" slice
expect 1 'Middle.ice' "$slice2c" slice/Top.ice # no -I
[ ! -e Top.h ] || fail 'files were written in spite of an error'
echo 'in the way' >file
expect 1 'cannot write' "$slice2c" -I slice slice/Lib/Base.ice --output-dir file/sub
expect 0 '' "$slice2c" --validate
# Checksums are those of slice2cpp.
cat >checksums.ice <<'ICE'
[["underscore"]]
module Sums {
    const int A = -0x10; const float B = 1.50; const double C = 1e30; const string D = "a\t\u00e9\"\x41\\"; const bool E = true; const long F = A;
    const double Third = 0.333333333333; const byte G = 0; const string Empty = ""; const string Raw = "\U0001F681\xe9\351\'\?\n\7";
    enum Plain { one, two }; enum Valued { x = 5, y = 1, z }; const Valued G_ood = y; const Valued H = Valued::z; const Valued K = H;
    struct S { int a = 5; ["m"] string b; Plain p; };
    sequence<Object> Q; sequence<Object*> R; dictionary<S, Q> Dict; interface I; sequence<I*> Is;
    exception Ex { optional(5) int b; string why; optional(2) S a; }; exception Fx extends Ex { }; exception Gx { };
    class Base; class Base(7) { int a; optional(9) Base b; optional(3) bool c; Base d; };
    class Derived extends Base implements I2 { };
    interface I extends I3, I4 {
        void nothing(); idempotent int op(int a, out string b) throws Fx, Gx; ["amd"] optional(3) S opt(optional(7) int z, int y, optional(1) int x, out bool w);
        optional(1) I* all(optional(9) int a, optional(2) int b); void first(int a, optional(4) int b);
    };
};
ICE
sed -i 's/^    class Base; /    interface I2 { void run(); }; interface I3 { }; interface I4 { };\n&/' checksums.ice
sums() { sed -n 's/^ *{*"\(::[^"]*\)", "\([0-9a-f]*\)".*/\1 \2/p' "$1" | sort -u; }
mkdir sums sums/cpp
for file in checksums.ice /usr/share/ice/slice/IceGrid/Admin.ice /usr/share/ice/slice/Ice/Version.ice /usr/share/ice/slice/Ice/Metrics.ice; do
    base=$(basename "$file" .ice)
    expect 0 '' "$slice2c" --checksum -I/usr/share/ice/slice "$file" --output-dir sums
    slice2cpp --checksum -I/usr/share/ice/slice "$file" --output-dir sums/cpp 2>/dev/null
    sums "sums/${base}_types.c" >ours
    sums "sums/cpp/$base.cpp" >theirs
    [ "$base" != checksums ] || gcc -std=c90 -pedantic -Wall -Wextra -Werror -fsyntax-only -I"$sw/base" -I"$sw/icec" sums/checksums_types.c
    [ -s ours ] && diff theirs ours || fail "checksums of $base differ from those of slice2cpp"
done
expect 0 'struct Point_ty' "$slice2c" -E -I slice slice/Top.ice

# Several files in one run, each beside the others; a header that is included by its name on the -I path.
expect 0 '' "$slice2c" -I slice slice/Lib/Base.ice slice/Lib/Middle.ice --output-dir out/Lib
expect 0 '' "$slice2c" -Islice -DWITH_MORE=7 slice/Top.ice --output-dir out
grep -q '#include "Lib/Middle.h"' out/Top.h || fail 'Top.h does not include Lib/Middle.h'
grep -q '#include "Lib/Base.h"' out/Lib/Middle.h || fail 'Middle.h does not include Lib/Base.h'
grep -q 'More_Amount ((Ice_Int)7)' out/Top.h || fail '-D does nothing'
expect 0 '' "$slice2c" -Islice -DWITH_MORE=7 -UWITH_MORE slice/Top.ice --output-dir out
! grep -q More_ out/Top.h || fail '-U does nothing'
# Two files of one name go into one program; a name may begin with a digit.
mkdir slice/2nd
echo 'module Second { class Node { int x; }; };' >slice/2nd/Base.ice
printf '#include <Lib/Base.ice>\n#include <2nd/Base.ice>\nmodule Both { struct S { Lib::Node a; Second::Node b; }; };\n' >slice/Both.ice
expect 0 '' "$slice2c" -Islice slice/Both.ice --output-dir out
expect 0 '' "$slice2c" -Islice slice/2nd/Base.ice --output-dir out/2nd
gcc -r -I"$sw/base" -I"$sw/icec" -Iout -o linked.o out/Both_types.c out/Lib/Base_types.c out/2nd/Base_types.c
for cc in gcc clang; do
    for c in out/*.c out/Lib/*.c out/2nd/*.c; do
        $cc -std=c90 -pedantic -Wall -Wextra -Wconversion -Wstrict-prototypes -Wmissing-prototypes -Werror -fsyntax-only \
            -I"$sw/base" -I"$sw/icec" -Iout -Iout/Lib "$c"
    done
done
# A header for C++ too.
printf '#include "Top.h"\nint main() { Top_Leaf leaf; return sizeof leaf == 0; }\n' >top.cpp
g++ -std=c++17 -Wall -Werror -fsyntax-only -I"$sw/base" -I"$sw/icec" -Iout top.cpp

expect 0 '' "$slice2c" -Islice slice/Top.ice --output-dir ext --header-ext hh --source-ext cc --include-dir sub
grep -q '#include "sub/Top.hh"' ext/Top_client.cc || fail '--header-ext, --source-ext or --include-dir do nothing'
expect 0 'Top.h Top_types.c Top_client.c Top_async.c Top_server.c:' "$slice2c" --depend -Islice slice/Top.ice
grep -q 'slice/Lib/Base.ice' log || fail 'a dependency is missing'
expect 0 '<dependsOn name="slice/Lib/Base.ice"/>' "$slice2c" --depend-xml -Islice slice/Top.ice
expect 0 '' "$slice2c" --depend-file deps -Islice slice/Top.ice
grep -q Top_client.c deps || fail '--depend-file writes nothing'
# Make understands it, and remakes the header when an included file changes.
printf 'include deps\nTop.h:\n\t@echo remade\n' >Makefile
touch Top.h
touch -d '+1 hour' slice/Lib/Base.ice
make -s Top.h | grep -q remade || fail 'make does not remake Top.h'
# One bad file does not keep the others from being compiled.
echo 'module {' >bad.ice
expect 1 'expected the module' "$slice2c" bad.ice slice/Lib/Base.ice --output-dir mixed
[ -f mixed/Base.h ] || fail 'the good file was not compiled'
printf 'module A_b { struct iceS { int x; }; };' >names.ice
expect 1 'underscore' "$slice2c" names.ice --output-dir x
expect 0 '' "$slice2c" --underscore --ice names.ice --output-dir x

# Lines: what the preprocessor has no room for is an error that says where, also in an included file.
{ printf 'module L { // ' && head -c 70000 /dev/zero | tr '\0' x && printf '\n};\n'; } >long.ice
printf '\n#include <long.ice>\n' >includes.ice
expect 1 'long.ice:1: error: the line is too long' "$slice2c" long.ice
expect 1 'long.ice:1: error: the line is too long' "$slice2c" -I . includes.ice
{ printf 'module L { struct S { int a; }; };' && yes '          \' | head -8000; } >joined.ice
expect 1 'joined.ice:[0-9]*: error: the line is too long' "$slice2c" joined.ice
# Line ends of another system, or none, are not spoken of.
printf 'module L {\r\n struct S { int a; };\r\n};' >crlf.ice
printf '#include <crlf.ice>\nmodule M { struct T { L::S a; }; };' >without.ice
expect 0 '' "$slice2c" -I . crlf.ice without.ice --output-dir x
[ ! -s log ] || { cat log && fail 'a line end is spoken of'; }
printf '#include <crlf.ice>\n#include <crlf.ice>\n' >twice.ice
expect 1 'crlf.ice:2:9: error: .S. is defined already: this file is included twice; begin it with #pragma once' "$slice2c" -I . twice.ice
printf 'module L { const string T = "%0509d"; struct S { string a = "%0510d"; }; };' 0 0 >text.ice
expect 1 'text.ice:1:[0-9]*: error: a string of 510 bytes; a compiler of C90 needs to take 509 only' "$slice2c" text.ice
grep -q '^1 error$' log || { cat log && fail 'a string of 509 bytes is refused'; }
# A file beside the one that includes it, or above, wherever the compiler runs.
mkdir -p beside/sub
echo 'module Above { struct S { int a; }; };' >beside/above.ice
echo 'module Next { struct S { Above::S a; Nothing b; }; };' >beside/sub/next.ice
printf '#include "../above.ice"\n#include "next.ice"\nmodule Low { struct S { Above::S a; }; };\n' >beside/sub/low.ice
expect 1 '^/.*/beside/sub/next.ice:1:38: error: .Nothing. is not a type' "$slice2c" beside/sub/low.ice
grep -q '^module Next' log || { cat log && fail 'the line of an included file is not shown'; }
sed -i 's/Nothing b;//' beside/sub/next.ice
expect 0 '' "$slice2c" beside/sub/low.ice --output-dir beside/sub
grep -q '^#include "../above.h"$' beside/sub/low.h && grep -q '^#include "next.h"$' beside/sub/low.h || fail 'a header beside its file, or above, is not included'
expect 0 '' "$slice2c" --depend beside/sub/low.ice
grep -q '^ beside/above.ice ' log && grep -q '^ beside/sub/next.ice$' log || { cat log && fail 'dependencies beside a file, or above'; }
echo '#include <sub/low.ice>' >top.ice
expect 0 '' "$slice2c" --depend -Ibeside top.ice
grep -q '^ beside/above.ice ' log && grep -q '^ beside/sub/next.ice$' log || { cat log && fail 'dependencies beside a file of the -I path'; }
# A full disk.
for option in -E --depend --depend-xml; do
    ! "$slice2c" $option crlf.ice >/dev/full 2>log || fail "$option: no error although nothing could be written"
    grep -q 'cannot write' log || fail "$option does not say that it cannot write"
done

# Files of one program: no two names of theirs are one name in C.
mkdir -p one/other
printf 'module Cores { sequence<byte> Bytes; interface Fir { void f(); }; };\n' >one/fir.ice
printf '// a core\nmodule Cores { sequence<byte> Bytes; interface Crc { void f(); }; };\n' >one/crc.ice
printf 'module Other { interface Fir { void f(); }; };\n' >one/other/fir.ice
printf '#include <fir.ice>\nmodule Cores { interface User { void f(Bytes b); }; };\n' >one/user.ice
expect 1 "crc.ice:2:31: error: '::Cores::Bytes' is 'Cores_Bytes' in C, as one/fir.ice:1 is" "$slice2c" --one-program one/fir.ice one/crc.ice
expect 1 "'fir.ice' is the name of one/fir.ice too" "$slice2c" --one-program one/fir.ice one/other/fir.ice
expect 0 '' "$slice2c" --one-program -Ione one/fir.ice one/user.ice
[ ! -e fir.h ] || fail '--one-program generated something'
echo 'commandline: all as expected'
