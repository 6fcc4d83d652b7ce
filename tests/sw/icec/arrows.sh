#!/bin/sh
# SPDX-License-Identifier: MIT
# arrows: source-folder   The files of sw/icec use each other downwards only: no file includes a header of its own
# layer or of one above it. The layers are those of docs/icec.md, the top one first.
set -eu
cd "$1/sw/icec"
layers='communicator batch builtin locator
invoke
loop
dispatch receiver connection
calls reply
adapter properties proxy_change proxy_parse proxy_print
transport proxy
message
value_read value_slice value_write
slice operation option status current
stream'
bad=0
above='' listed=''
IFS='
'
for layer in $layers; do
    IFS=' '
    above="$above $layer"
    for name in $layer; do
        listed="$listed ice_$name.c"
        for upper in $above; do
            [ "$upper" != "$name" ] || continue
            grep -Hn "#include \"ice_$upper\.h\"" "ice_$name.c" && bad=1
        done
    done
done
for file in ice_*.c; do
    case " $listed " in *" $file "*) ;; *) echo "$file is in no layer" && bad=1 ;; esac
done
exit $bad
