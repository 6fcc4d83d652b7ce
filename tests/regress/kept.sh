#!/bin/sh
# SPDX-License-Identifier: MIT
# kept: tests when tools/icesoc/regress/kept.py computes a result again and when it reuses the
# stored result. Usage: kept.sh path-of-kept.py work-folder
set -eu
kept=$1 work=$2
rm -rf "$work"
mkdir -p "$work/a/tests" "$work/a/tools/icesoc/regress" "$work/a/first" "$work/a/second" "$work/bin"
cp "$kept" "$work/a/tools/icesoc/regress"
cd "$work/a"
export XDG_CACHE_HOME="$work/cache" PATH="$work/bin:$PATH"
unset FRESH
# The test script looks for b.vh in two folders like a compiler, counts the files of one folder,
# calls a tool, and waits on request.
cat >tests/t.sh <<'END'
#!/bin/sh
own=$1
mkdir "$own" || exit 1 # fails if the folder was not emptied
[ ! -e wait ] || { mkfifo "$own/gate" && touch "$own/waits" && read -r _ <"$own/gate"; }
for f in first second; do [ ! -f $f/b.vh ] || { cat $f/b.vh; break; }; done
echo "$(ls second | wc -l) names, $(tool), ${OTHER:-nothing else}, $own"
ls "$(dirname "$(command -v tool)")" >"$own/tools" # lists a folder outside the tree
[ ! -e linked ] || { ln -s ../prog "$own/link" && "$own/link" 'by a link'; }
! grep -q wrong second/b.vh || exit 3
END
printf '#!/bin/sh\necho one\n' >"$work/bin/tool"
chmod +x tests/t.sh "$work/bin/tool"
echo 'b 1' >second/b.vh
fail() { echo "kept: $*" >&2 && cat "$work/said" >&2 && exit 1; }
kept=tools/icesoc/regress/kept.py
run() { status=0; $kept "$PWD/own" tests/t.sh "$PWD/own" >"$work/said" 2>&1 || status=$?; }
# computed REASON WORDS: expects that the result is computed now, that the output contains these
# words, and that the result is reused the next time
computed() {
    sleep 0.1 # a file that has just been written is not trusted
    run
    { [ $status -eq 0 ] && ! grep -q '^kept:' "$work/said"; } || fail "not computed: $1"
    grep -q "$2" "$work/said" || fail "'$2' is not said: $1"
    same "$1" "$2"
}
same() {
    run
    { [ $status -eq 0 ] && head -1 "$work/said" | grep -q '^kept: cached result of 20.*FRESH=1' &&
        grep -q "$2" "$work/said"; } || fail "not kept: $1"
}
computed 'never run' "^1 names, one, nothing else, $PWD/own$"
sed -i 's/1/2/' second/b.vh && computed 'one byte of an included file' '^b 2$'
sed -i 's/2/1/' second/b.vh && same 'as it was before' '^b 1$'
OTHER=1 && export OTHER && same 'a variable that no test is given' 'nothing else'
echo 'b 3' >first/b.vh && computed 'a file that is found earlier' '^b 3$'
rm first/b.vh && same 'that is gone' '^b 1$'
touch second/c.vh && computed 'a name more in a folder that is listed' '^2 names'
touch "$work/bin/game" && same 'a program of a package that it does not use' '^2 names'
mkdir "$work/bin/__pycache__" && same 'a cache there' '^2 names'
sed -i 's/one/three/' "$work/bin/tool" && computed 'another tool' 'three'
FRESH=1 && export FRESH && run && ! grep -q '^kept:' "$work/said" || fail "FRESH=1"
unset FRESH
cp -r "$work/a" "$work/b" && cd "$work/b" && same 'another clone' ", $PWD/own$" && cd "$work/a"
touch linked && cp /bin/echo prog
computed 'a program of the tree, by a link of the test' '^by a link$'
cp /bin/printf prog && computed 'another one there' '^by a link$'
rm prog linked
# The result of a failed test is not stored.
echo wrong >second/b.vh
for _ in 1 2; do
    run
    { [ $status -eq 3 ] && ! grep -q '^kept:' "$work/said"; } || fail "a failure: status $status"
done
# The result is not stored either if the test is killed, or if its files change meanwhile.
begun() { # earlier output
    rm -rf own
    $kept "$PWD/own" tests/t.sh "$PWD/own" >"$work/said" 2>&1 &
    until [ -e own/waits ]; do kill -0 $! || fail "a verdict of $1"; done
}
touch wait && echo 'b 4' >second/b.vh && sleep 0.1
begun nothing && kill -9 $!
wait $! || true
echo go >own/gate
begun 'one that is killed' && echo 'b 5' >second/b.vh && echo go >own/gate
wait $! || fail "a file that changes"
begun 'a file that changes' && echo go >own/gate
wait $! || fail "the third"
same 'one that came to its end' '^b 5$'
rm wait
# Two runs take place at the same time; a later run has no strace.
echo 'b 6' >second/b.vh && sleep 0.1
for n in 1 2; do $kept "" tests/t.sh "$PWD/own$n" >"$work/said$n" 2>&1 & done
wait
grep -q '^b 6$' "$work/said1" && grep -q '^b 6$' "$work/said2" || fail "two at once"
computed 'after two at once' '^b 6$'
printf '#!/bin/sh\nexit 1\n' >"$work/bin/strace" && chmod +x "$work/bin/strace"
echo 'b 7' >second/b.vh
for _ in 1 2; do
    run
    { [ $status -eq 0 ] && grep -q '^b 7$' "$work/said" &&
        grep -q '^kept: strace is missing' "$work/said"; } || fail "where strace cannot"
done
