#!/bin/sh
# SPDX-License-Identifier: MIT
# agreement: slice2c cases.ice work-folder
# Each case, from a line "// ok: ..." , "// warning: ..." or "// error: ..." to the next, is given
# to slice2c and to ZeroC's slice2cpp: both must take it silently, take it with a warning, or refuse
# it, at the same first line. What ZeroC's own wrong files have is in error_detection.py alone.
set -eu
slice2c=$1 cases=$2 work=$3
rm -rf "$work"
mkdir -p "$work"
cd "$work"
awk '/^\/\/ (ok|warning|error): / { n++; file = sprintf("case%03d.ice", n) } n { print > file }' \
    "$cases"
{ echo '// ok: modules in modules' && seq -f 'module M%g {' 200 && echo 'struct S { int a; };' &&
    seq -f '}; // %g' 200; } >case000.ice
golden=$(dirname "$cases")/../compiler/golden
{ echo '// ok: every construct' && cat "$golden/everything.ice"; } >case999.ice

# Prints a compiler's verdict on a file: "0" or "1", and the line of its first message.
said() { # compiler, file
    status=0
    "$1" "$2" --output-dir out >log 2>&1 || status=1
    echo "$status $(sed -n 's/^[^:]*\.ice:\([0-9]*\):.*/\1/p' log | head -n 1)"
}

mkdir out
failures=0
for file in case*.ice; do
    title=$(head -n 1 "$file")
    kind=${title#// }
    kind=${kind%%:*}
    ours=$(said "$slice2c" "$file")
    cp log ours
    theirs=$(said slice2cpp "$file")
    case $kind in ok) wanted='0 ' ;; warning) wanted='0 [0-9]*' ;; error) wanted='1 [0-9]*' ;; esac
    # shellcheck disable=SC2254 # a pattern is meant
    case $theirs in $wanted) ;; *)
        echo "$file: $title: slice2cpp says otherwise: $theirs" && cat log &&
            failures=$((failures + 1))
        continue
        ;;
    esac
    [ "$ours" = "$theirs" ] || {
        echo "$file: $title: slice2cpp: $theirs, slice2c: $ours" && cat log ours
        failures=$((failures + 1))
    }
done
# Each keyword of Slice as a name of each kind, with and without the backslash: of a file with a
# definition a line both refuse the same lines.
keywords='module class interface exception struct sequence dictionary enum out extends implements throws void byte bool short
int long float double string Object LocalObject local const false true idempotent optional Value'
lines() { # compiler, file
    "$1" "$2" --output-dir out 2>&1 | sed -n 's/^[^:]*\.ice:\([0-9]*\):.*/\1/p' | sort -nu
}
number=0
for form in 'struct % { int a; };' 'struct S# { int %; };' 'enum % { x# };' 'enum E# { % };' \
    'interface % { };' \
    'interface I# { void %(); };' 'interface I# { void op(int %); };' 'const int % = 1;' \
    'exception % { };' 'class % { };' \
    'sequence<int> %;' 'dictionary<int, int> %;' 'module % { };'; do
    number=$((number + 1))
    for kind in plain escaped; do
        file=keyword$number$kind.ice line=0
        for word in $keywords; do
            [ $kind = plain ] || word="\\\\$word"
            line=$((line + 1))
            echo "module A$line { $form };" | sed "s/%/$word/; s/#/$line/"
        done >"$file"
        lines "$slice2c" "$file" >ours
        lines slice2cpp "$file" >theirs
        [ $kind = plain ] || [ ! -s theirs ] || { echo "$file: slice2cpp refuses escaped names" &&
            failures=$((failures + 1)); }
        [ $kind = escaped ] || [ "$(wc -l <theirs)" = $line ] ||
            { echo "$file: slice2cpp takes some" && failures=$((failures + 1)); }
        cmp -s ours theirs || { echo "$file: the compilers refuse different lines:" &&
            diff theirs ours; failures=$((failures + 1)); }
    done
done
echo "$(ls case*.ice | wc \
    -l) cases and $((number * 2)) files of keywords, $failures on which the compilers differ"
[ $failures = 0 ]
