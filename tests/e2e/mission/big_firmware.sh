#!/bin/sh
# SPDX-License-Identifier: MIT
# big_firmware: enlarges the firmware of this tree to a given size. The added code is from newlib,
# so that it compresses like other code. Usage: big_firmware.sh BUILD-FOLDER OUT.elf BYTES
set -eu
build=$(realpath "$1") out=$2 bytes=$3
part=$out.part
echo 'SECTIONS { .text : { *(.text .text.*) } }' >"$part.ld"
for library in c m; do
    archive=$(arm-none-eabi-gcc -mcpu=cortex-m3 -mthumb -print-file-name=lib$library.a)
    arm-none-eabi-ld -r -T "$part.ld" --whole-archive "$archive" -o "$part.o"
    arm-none-eabi-objcopy -O binary -j .text "$part.o" "$part.bin"
    cat "$part.bin" >>"$part.text"
done
filling=$((bytes - $(stat -c %s "$build/firmware/uav.bin")))
[ "$filling" -le "$(stat -c %s "$part.text")" ] || {
    echo "big_firmware: newlib has not as much code as that" >&2
    exit 1
}
head -c "$filling" "$part.text" >"$part.rodata"
printf '%s\n' '.section .rodata.filling, "a"' '.balign 4' '.global filling' \
    "filling: .incbin \"$part.rodata\"" >"$part.S"
arm-none-eabi-gcc -mcpu=cortex-m3 -c "$part.S" -o "$part.o"
ninja -C "$build" -t commands firmware/uav.elf | tail -n 1 |
    sed "s#-o $build/firmware/uav.elf#-Wl,--undefined=filling $part.o &#
        s#$build/firmware/uav#${out%.elf}#g" | sh
rm "$part".*
