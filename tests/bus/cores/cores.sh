#!/bin/sh
# SPDX-License-Identifier: MIT
# cores: source-folder generated-folder work-folder
# Generates chips from several lists of cores, checks each soc.v with a linter, and tests messages
# about wrong lists (refused.py tests all of these messages). It is a shell script because a case
# consists of a list and the output of programs (coremap, Verilator, GCC, xmllint, Yosys).
set -eu
source=$1 gen=$2 work=$3
coremap() { "$source/tools/python" -m icesoc.chip.coremap "$@"; }
regmap() { "$source/tools/python" -m icesoc.regs.generate "$@"; }
here=$(cd "$(dirname "$0")" && pwd)
data=$here/data
rm -rf "$work"
mkdir -p "$work/own"
# Makes a core `tuner` from the core `led`, but with a separate clock.
for f in regs.json v toml; do sed 's/\<led\>/tuner/' "$data/led.$f" >"$work/own/tuner.$f"; done
sed -i '/^name/a clock_hz = 48000000' "$work/own/tuner.toml"
clocked() { "$source/tools/python" -m icesoc.chip.clocked "$@"; }
clocked "$work/own/tuner.toml" "$work/own/tuner.regs.json" "$work/own/tuner_clocked.v"
fail() { echo "cores: $*" && exit 1; }

# The generated registers of a core are the same in all chips.
registers=$work/registers
mkdir "$registers"
regmap "$data"/*.regs.json "$work"/own/*.regs.json --output-dir "$registers"

known() { # runs the command in the arguments, with coremap's options for the known cores
    "$@" --base "$source/bus/map.regs.json" \
        --core "led=$data/led.toml=$data/led.regs.json" \
        --core "adder=$data/adder.toml=$data/adder.regs.json" \
        --core "mover=$data/mover.toml=$data/mover.regs.json" \
        --core "probe=$source/ip/probe/core.toml=$source/ip/probe/probe.regs.json" \
        --core "tuner=$work/own/tuner.toml=$work/own/tuner.regs.json" \
        --block "0=system=$source/hdl/system/system.regs.json"
}
chip() { # arguments: name, list; generates the chip in $work/name
    out=$work/$1
    mkdir -p "$out"
    printf '%b' "$2" >"$out/cores.list"
    known coremap "$out/cores.list" --output-dir "$out" 2>"$out/messages"
}
accepted() {
    chip "$@" || { cat "$out/messages" && fail "refused: $2"; }
    regmap "$out/map.regs.json" --output-dir "$out"
    # shellcheck disable=SC2086 # a list of folders
    verilator --lint-only -Wall -I"$out" -I"$registers" $(for f in "$out" "$registers" "$data" \
        "$work/own" "$source"/bus "$source"/hdl/* "$source/ip/probe" "$gen"; do
            [ ! -d "$f" ] || echo "-y $f"; done) \
        -I"$gen" --top-module soc "$source/hdl/soc.v"
    gcc -std=c90 -pedantic -Wall -Wextra -Wmissing-prototypes -Werror -fsyntax-only -I"$out" \
        -I"$registers" -I"$data" -I"$source/sw/hw" \
        -I"$source/sw/hw/registers" -I"$gen/slice/Registers" -I"$source/ip/probe" \
        -I"$gen/slice/Probe" -I"$source/sw/icec" -I"$source/sw/base" "$out/soc_cores.c"
}
refused() { # arguments: message, list; adds a case for refused.py
    printf '%s\0%b\0' "$1" "$2" >>"$work/refusals"
}
has() { # arguments: file of the chip, expected lines
    file=$1
    shift
    for line; do grep -q -- "$line" "$out/$file" || fail "$file has no '$line'"; done
}
lacks() { ! grep -E -- "$2" "$out/$1" || fail "$1 contains a forbidden line (above: $2)"; }
is() { has map_regs.h "^#define MAP_$1 $2U"; }

# A byte order mark is not part of a name. Form feeds and U+0085 in a comment do not end the line.
chip marked '\0357\0273\0277led # a\014b \0302\0205c\n' ||
    { cat "$out/messages" && fail 'a mark is refused'; }
has soc_cores.vh led
accepted none '# nothing\n\n'
is SLOT_COUNT 0x2
is NPI_PORT_COUNT 0x2
accepted one 'led\n'
is SLOT_LED 0x2
is SLOT_COUNT 0x3
accepted several 'adder identity=eye # a comment
led slot=5 button_i=camera.seen_o
mover
mover name=camera
 adder name=adder2\n'
is SLOT_ADDER 0x2
is SLOT_LED 0x5
is SLOT_MOVER 0x3
is SLOT_CAMERA 0x4
is SLOT_ADDER2 0x6
is NPI_PORT_COUNT 0x4
is NPI_PORT_MOVER 0x2
is NPI_PORT_CAMERA 0x3
is MEMORY_MOVER 0x1000000
is MEMORY_CAMERA 0x1000800
# The files are valid XML (bus.svd checks the SVD against ARM's schema), and the registers are at
# the addresses of the map.
address=$(xmllint --xpath 'string(//peripheral[name="CAMERA"]/baseAddress)' "$out/icesoc.svd")
[ "$address" = 0x64000100 ] || fail "CAMERA is at $address in the SVD file"
event='//peripheral[name="SYSTEM"]/registers/register[name="EVENT"]'
[ "$(xmllint --xpath "string($event/modifiedWriteValues)" "$out/icesoc.svd")" = oneToClear ] ||
    fail 'EVENT is not cleared by writing 1 in the SVD file'
[ "$(xmllint --xpath 'count(//peripheral)' "$out/icesoc.svd")" = 6 ] ||
    fail 'the SVD file has not six peripherals'
# In SystemRDL and IP-XACT, the words that are accessed through PAGE have separate maps. SystemRDL
# can be converted back.
"$source/tools/python" -m icesoc.regs.rdl "$out/icesoc.rdl" "$work/back" >"$work/rdl" 2>&1 ||
    { cat "$work/rdl" && fail 'SystemRDL with pages'; }
for f in "$data/led.regs.json" "$work/back/led.regs.json"; do
    /usr/bin/python3 -c 'import json, sys
registers = json.load(open(sys.argv[1]))["registers"]
print(sorted(json.dumps(dict(r), sort_keys=True) for r in registers))' "$f"
done | uniq | wc -l | grep -qx 1 || { cat "$work/back/led.regs.json" &&
    fail 'what comes back from SystemRDL is not what was there'; }
pages='//*[local-name()="memoryMap"][*[local-name()="name"]="LED_PAGES"]'
offset='//*[local-name()="register"][1]/*[local-name()="addressOffset"]'
[ "$(xmllint --xpath "string($pages$offset)" "$out/icesoc.ipxact.xml")" = "'h44" ] ||
    fail 'IP-XACT has not the words behind PAGE'
is PIN_CAMERA_SEEN_O 0xB
# A core has the identity that the list gives it. A core without its own servant (camera) has the
# general servant for registers.
has soc_cores.c '"eye"' '{"camera", MAP_SLOT_CAMERA, .*core_camera_start' \
    'core_camera_table\[\] = {MOVER_TABLE}'
accepted unwired 'mover
mover name=a
mover name=b level_o=none
led button_i=none
mover name=c level_o=none\n'
has soc_pins.h '"a.level_o"'
lacks soc_pins.h '"(c.level_o|led.button_i)"' # a signal that is not a pin must have no location
has soc_cores.vh "button_i(1'd0)"
accepted pins 'led name=eye button_i=@A4\nmover seen_o=@B1 level_o=@C1,C2,C3,C4,C5,C6,C7,C8,C9\n'
has soc_pins.h '^    {"eye.button_i", 0, 1, false},$'
has core_pins.ucf '^NET "core_pins_i<0>" LOC = "A4"; # eye.button_i\[0\]$' \
    '^# NET "core_pins_o<0>" LOC = "..."; # eye.led_o\[0\]$' \
    '^NET "core_pins_o<10>" LOC = "C9"; # mover.level_o\[8\]$'
has soc_cores.vh 'led u_eye' 'mover #(.CLK_HZ(CLK_HZ)) u_mover'
# Chip and firmware have the same hash for the registers of a core. The hash changes if the
# registers change, but not if only their descriptions change.
contract() { sed -n "s/.*\"$1\"}, [0-9]*, 0, (Ice_Int)0x\([0-9A-F]*\)U.*/\1/p" "$out/soc_cores.c"; }
before=$(contract mover)
[ -n "$before" ] && grep -q "CONTRACTS = {32'h$before, 32'h$(contract \
    eye), 32'h0\{8\}, 32'h$(contract system)};" "$out/soc_cores.vh" ||
    { cat "$out/soc_cores.vh" && fail 'the chip has other hashes than the firmware'; }
# changed EXPRESSION: prints the hash for mover after this sed command has changed mover's
# description
changed() {
    mkdir -p "$work/changed"
    sed "$1" "$data/mover.regs.json" >"$work/changed/mover.regs.json"
    coremap "$out/cores.list" --base "$source/bus/map.regs.json" --core \
        "led=$data/led.toml=$data/led.regs.json" \
        --core "mover=$data/mover.toml=$work/changed/mover.regs.json" --output-dir "$out"
    contract mover
}
[ "$(changed 's/With a memory/Having a memory/')" = "$before" ] ||
    fail 'words of a description change the hash'
added='{"word": 3, "name": "A", "access": "rw", "doc": ""}'
[ "$(changed "s/\"registers\": /&[$added], \"events\": /")" != "$before" ] ||
    fail 'a register does not change the hash'
# A servant that has no waiting calls needs neither an interrupt nor polling.
for f in adder.regs.json adder.v; do cp "$data/$f" "$work"; done
sed '/^header/a waits = false' "$data/adder.toml" >"$work/adder.toml"
echo adder >"$work/cores.list"
coremap "$work/cores.list" --base "$source/bus/map.regs.json" \
    --core "adder=$work/adder.toml=$work/adder.regs.json" \
    --output-dir "$work"
grep -q '^    Hw_Core_interrupt(&core_adder.core);' "$work/soc_cores.c" &&
    ! grep -q 'Demo_Adder_Core_\(interrupt\|poll\)' "$work/soc_cores.c" ||
    fail 'a servant that waits for nothing is asked for its interrupt or poll'
# Errors: two cores, or a core and the platform, would have the same name in a generated file.
refused "1: error: the platform and core 'rst' both become u_rst" 'led name=rst\n'
refused "3: error: the platform and core 'fsmc' both become NPI_PORT_FSMC" \
    'led\nadder\nmover name=fsmc\n'
refused "2: error: core 'a' and core 'a_start' both become core_a_start" \
    'led name=a\nled name=a_start\n'
refused "2: error: core 'a' and core 'gate_a' both become u_gate_a" \
    'adder name=a gate=on\nled name=gate_a\n'
# Only a core with idle_o can have a clock gate. If the list requests a gate, the gate is also built
# on the board.
accepted gates 'adder gate=on\nadder name=other\nled\n'
has soc_cores.vh 'core_gate #(.GATED(1)) u_gate_adder ($' 'access_i(slot_valid\[2\]),$' \
    '.clk_o(clk_adder)$' '.clk_i(clk_adder)' 'core_gate #(.GATED(GATES)) u_gate_other'
lacks soc_cores.vh u_gate_led
has core_pins.ucf '^NET "u_soc/u_gate_adder.g_gate.run" MAXDELAY'
# The separate clock of a core comes from a pin, comes from another core, or is derived from the
# chip clock. The constraints for ISE contain its period and its crossings.
accepted clocks 'led
tuner clock_i=@A9
tuner name=other clock_i=led.led_o
tuner name=made clock=6/25\n'
is PIN_TUNER_CLOCK_I 0x2
has soc_cores.vh '^    tuner_clocked u_tuner' 'clock_i(pin_led_led_o)' \
    'core_clock #(.MULTIPLY(6), .DIVIDE(25)) u_clock_made'
has core_pins.ucf '^NET "core_pins_i<2>" TNM_NET = "tuner_clk";$' \
    '^TIMESPEC "TS_tuner_clk" = PERIOD "tuner_clk" 20.833 ns HIGH 50%;$' \
    '^TIMESPEC "TS_made_clk" = PERIOD "made_clk" 41.667 ns HIGH 50%;$' \
    '^TIMESPEC "TS_soc_to_other" = FROM "soc_clk" TO "other_clk" 8 ns DATAPATHONLY;$'
refused 'for .tuner., got 75000000 Hz' 'tuner clock=3/4\n'
refused 'for .tuner., got 2020202 Hz' 'tuner clock=2/99\n'
refused 'clock=9/8: expected a fraction' 'tuner clock=9/8\n'
refused 'clock=x: expected a fraction' 'tuner clock=x\n'
refused "has no input pin 'clock'" 'led clock=6/25\n'
sed '/^name/a clock_hz = 48000000' "$data/mover.toml" >"$work/mover.toml"
for f in mover.regs.json mover.v; do cp "$data/$f" "$work"; done
! clocked "$work/mover.toml" "$data/mover.regs.json" "$work/mover_clocked.v" 2>"$work/messages" &&
    grep -q 'a core with a memory port uses the chip clock' "$work/messages" ||
    fail 'a memory port in another clock'
# Errors: names of registers and fields collide in the generated headers.
for names in 'A B A_B_LSB' 'A_B_LSB C A_B_LSB'; do
    # shellcheck disable=SC2086 # three words
    printf '{"block": "b", "doc": "", "registers": [
        {"word": 0, "name": "%s", "access": "ro", "doc": "",
         "fields": [{"name": "%s", "doc": "", "lsb": 0, "width": 1}]},
        {"word": 1, "name": "%s", "access": "ro", "doc": ""}]}' $names >"$work/twice.regs.json"
    ! regmap "$work/twice.regs.json" --output-dir "$work" 2>"$work/messages" &&
        grep -q 'both become A_B_LSB\|A_B_LSB: duplicate name' "$work/messages" ||
        fail "registers and fields of one name ($names)"
done
described() { # arguments: message, description that must be rejected
    printf '%b' "$2" >"$work/wrong.regs.json"
    ! regmap "$work/wrong.regs.json" --output-dir "$work" 2>"$work/messages" &&
        grep -q -- "$1" "$work/messages" || { cat "$work/messages" && fail "'$1' is not said: $2"; }
}
described 'expected an object of names and values, got \[\]' '[]'
described "missing key 'doc'" '{"block": "b"}'
described 'expected JSON in UTF-8' '{"block": "\0377"}'
described 'deep brackets' "$(printf '[%.0s' $(seq 50000))"
described 'block: expected a name .*, got "../b"' '{"block": "../b", "doc": "", "registers": []}'
described 'doc: expected a text .*, got "\*/"' '{"block": "b", "doc": "*/", "registers": []}'
described 'registers\[0\].word: expected a whole' \
    '{"block": "b", "doc": "", "registers": [{"word": ""}]}'
described 'pins\[0\].name: expected' \
    '{"block": "b", "doc": "", "registers": [], "pins": [{"name": "a"}]}'
# A probe records signals at any depth of the hierarchy by their hierarchical names, in Verilog and
# after Yosys has flattened the design. The ground receives these names.
accepted probe 'adder
probe signals=u_adder.u_registers.u_wrapper.mask,u_modem.u_timer.clocks:17
probe name=other signals=u_adder.irq_o\n'
yosys -q -p "verilog_defaults -add -I$out -I$registers -I$gen $(for f in bus hdl/fsmc hdl/ddr \
    hdl/cdc; do printf -- '-I%s ' "$source/$f"; done)
    read_verilog $source/hdl/soc.v
    hierarchy -top soc $(for f in "$out" "$registers" "$data" "$source/ip/probe" "$gen" \
        "$source"/bus "$source"/hdl/*; do [ ! -d "$f" ] || printf -- '-libdir %s ' "$f"; done)
    proc; flatten; opt_clean; check -assert
    select -assert-count 1 w:u_adder.u_registers.u_wrapper.mask" >"$work/yosys" 2>&1 ||
    { cat "$work/yosys" && fail 'Yosys does not join a signal with the probe'; }
hash=$(python3 -c 'import json, sys
print(next(p["names"] for p in json.load(open(sys.argv[1]))["probes"] if p["core"] == "other"))' \
    "$out/chip.json")
grep -q "WORDS(1), .NAMES(32'h$(printf %08X "$hash"))) u_other" "$out/soc_cores.vh" ||
    fail 'chip and ground have other hashes of what a probe records'
refused "1: error: 'probe' records no signals" 'probe\n'
refused "signals: 'u_a.b:0': expected a name and a width" 'probe signals=u_a.b:0\n'
refused 'signals: expected at most 223 bits, got 224' 'probe signals=a:200,b:24\n'
refused "'led' has no input pin 'signals'" 'led signals=a\n'
accepted hole 'led slot=63\n'
is SLOT_COUNT 0x40

accepted placed 'mover\nmover name=last memory=0x1000800\nmover name=camera\n'
is MEMORY_MOVER 0x1000000
is MEMORY_LAST 0x1000800
is MEMORY_CAMERA 0x1001000

refused "memory=0x1000400: expected a multiple of the buffers' size, 2048" \
    'mover memory=0x1000400\n'
refused 'memory=0x0: expected a multiple' 'mover memory=0\n'
refused 'memory=0x8000000: expected a multiple' 'mover memory=0x8000000\n'
refused '2: error: memory=0x1000800 is within the buffers of line 1' \
    'mover memory=0x1000800\nmover name=b memory=0x1000800\n'
refused 'memory=1x: expected a byte address' 'mover memory=1x\n'
refused 'a byte address in DDR3' "mover memory=1$(printf '%05000d' 0)\n"
refused 'memory=0x1000000: expected a byte address in DDR3, and a core with' \
    'led memory=0x1000000\n'
refused "1: error: no core 'missing'" 'missing\n'
refused "2: error: 'led' is already on line 1; give one" 'led\nled\n'
refused "3: error: slot 7 is taken on line 2" '#\nled slot=7\nadder slot=7\n'
refused "slot=1: expected 2 to 63" 'led slot=1\n'
refused "slot=64: expected 2 to 63" 'led slot=64\n'
refused "slot=x" 'led slot=x\n'
refused "'modem' is a name of the platform;" 'led name=modem\n'
refused "name=Led: expected small letters" 'led name=Led\n'
refused "2: error: the identity 'update' is an object of the platform" \
    'led\nadder identity=update\n'
refused "identity 'a' is taken" 'led identity=a\nadder identity=a\n'
refused "'slot' is given twice" 'led slot=3 slot=4\n'
refused "'as': expected name=, identity=" 'led as\n'
refused "has no input pin 'colour'; it has button_i" 'led colour=red\n'
refused 'button_i=@A4,A5: expected 1 places, one per bit, got 2' 'led button_i=@A4,A5\n'
refused '2: error: place A4 is taken on line 1' 'led button_i=@A4\nled name=b led_o=@A4\n'
refused 'expected places of letters and digits' 'led button_i=@A-4\n'
refused "1: error: gate=on: 'led' has no output idle_o" 'led gate=on\n'
refused 'gate=off: expected gate=on' 'adder gate=off\n'
refused "expected a core's output of 1 bits" 'led button_i=mover.nothing_o\n'
refused "_o=none leaves it unconnected" 'mover\nmover name=a\nmover name=b\nmover name=c\n'
mkdir "$work/refused"
known "$source/tools/python" "$here/refused.py" "$work/refusals" "$work/refused"
coremap --help | grep -q 'one core per line' || fail 'no help'
! coremap "$work/missing" --base "$source/bus/map.regs.json" 2>"$work/messages" ||
    fail 'a missing list is accepted'
grep -q 'cannot read' "$work/messages" || fail 'a missing list is not said'
echo 'cores: all as expected'
