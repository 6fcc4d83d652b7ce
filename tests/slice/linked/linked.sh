#!/bin/sh
# SPDX-License-Identifier: MIT
# linked: slice2c sw-folder work-folder
# Checks with nm that a program for the Cortex-M3 contains only those parts of an interface and of
# the run time that it uses. The programs are a client of one operation and a server of one
# interface (docs/slice-mapping.md).
set -eu
slice2c=$1 sw=$2 work=$3
here=$(cd "$(dirname "$0")" && pwd)
command -v arm-none-eabi-gcc >/dev/null ||
    { echo "linked: arm-none-eabi-gcc is missing; run './icesoc setup'" && exit 1; }
rm -rf "$work"
mkdir -p "$work"
for file in Lent Linked; do "$slice2c" "$here/$file.ice" --output-dir "$work"; done

build() { # name, flags
    name=$1
    shift
    # shellcheck disable=SC2046 # a list of words
    (cd "$work" && mkdir -p "$name" && cd "$name" &&
        arm-none-eabi-gcc -std=c90 -mcpu=cortex-m3 -mthumb -Os -ffunction-sections -fdata-sections \
        "$@" \
            -I"$sw/base" -I"$sw/icec" -I"$sw/minimal" -I.. -c $(sed "s,^,$sw/," \
            "$sw/minimal/sources.txt") ../Linked_*.c "$here/program.c")
    arm-none-eabi-gcc -mcpu=cortex-m3 -mthumb -nostartfiles --specs=nosys.specs --specs=nano.specs \
        -Wl,--gc-sections -Wl,-e,main \
        -o "$work/$name.elf" "$work/$name"/*.o 2>"$work/$name.log" || { cat "$work/$name.log" &&
        exit 1; }
    arm-none-eabi-nm "$work/$name.elf" | awk '{print $NF}' |
        grep -E '^(Linked|Ice|dispatch|operations)_|skipTable' >"$work/$name.names"
    echo "$name: $(arm-none-eabi-size "$work/$name.elf" |
        awk 'NR == 2 {print $1}') bytes of text, $(wc \
        -l <"$work/$name.names") names of IceC and of generated code"
}
# The host build of the server, with AddressSanitizer, must also not contain the tables of the
# interfaces that the program does not serve.
(mkdir -p "$work/host" && cd "$work/host" &&
    # shellcheck disable=SC2046 # a list of words
    gcc -std=c90 -Os -fsanitize=address --param asan-globals=0 -ffunction-sections -fdata-sections \
        -DICEC_MINIMAL -DSERVER -I"$sw/base" -I"$sw/icec" -I"$sw/minimal" -I.. \
        -c $(sed "s,^,$sw/," "$sw/minimal/sources.txt") ../Linked_*.c "$here/program.c" &&
    gcc -fsanitize=address -Wl,--gc-sections -o server ./*.o)
bad=0
classes=$(sed -n 's/^    &\(.*\)_type,$/\1/p' "$work/Linked_types.c")
[ "$classes" = Linked_Tree ] ||
    { echo "linked: the table of classes: expected Linked_Tree alone, got $classes" && bad=1; }
has() { # program, name
    grep -qx -- "$2" "$work/$1.names" ||
        { echo "linked: $1 lacks $2: the test looks at the wrong thing" && bad=1; }
}
lacks() { # program, pattern
    ! grep -E -- "$2" "$work/$1.names" ||
        { echo "linked: $1 has what it does not use (above: $2)" && bad=1; }
}
build client -DICEC_MINIMAL
build server -DICEC_MINIMAL -DSERVER
has client Linked_CounterPrx_add
has server Linked_Lamp_light
lacks client '^Linked_([^C]|Counter_|CounterPrx_([^a]|a[^d]))'
lacks server '^Linked_(Counter|Other|Tree|Failure|Groups|Names|CounterPrx|LampPrx)'
for program in client server; do
    lacks $program 'Values|_type$|Optional|Exception|Slice|readSequence|Async|_later|_Reply_|batch'
    lacks $program 'writeValue|readValue'
done
lacks client 'dispatch_|Object_dispatch|ObjectAdapter|Servant'
lacks server 'stringToProxy|_readPrx|ObjectPrx_begin|ObjectPrx_invoke'
exit $bad
