#!/bin/sh
# SPDX-License-Identifier: MIT
# refused: source-folder work-folder GHDL
# Tests that `./icesoc core foreign` rejects wrong input with a reason, and writes no files then.
# This is a shell script because each case is a command and its output.
set -eu
source=$1 work=$2 ghdl=$3
new() { "$source/tools/python" -m icesoc.cores.new_foreign "$@"; }
here=$(cd "$(dirname "$0")" && pwd)
rm -rf "$work"
mkdir -p "$work"
cd "$work"
for file in wb_port.v cores.v axil_words.v lamps.vhd; do cp "$here/$file" .; done
named() { # arguments: name of the core, message, top, bus, options and files
    name=$1 words=$2 top=$3 bus=$4
    shift 4
    ! new "$name" "$top" "$bus" out "$@" >log 2>&1 ||
        { echo "accepted: $name $top $bus $*" && exit 1; }
    grep -q -- "$words" log && ! grep -q Traceback log || { cat log &&
        echo "'$words' is not said: $name $top $bus $*" && exit 1; }
    [ ! -e out ] || { echo "something was written: $name $top $bus $*" && exit 1; }
}
refused() { named my_port "$@"; }
prints() { # prints EXPRESSION...: checks that each expression matches a line of the log
    for line; do
        grep -q "^  $line" log || { cat log && echo "'$line' is not said" && exit 1; }
    done
}
echo 'module pads(input clk, inout sda); endmodule' >pads.v
echo 'module outer(input clk); inner u(clk); endmodule' >outer.v
echo 'module wide(input clk, clk_en, we, input [1:0] a, input [63:0] my_wide, output [31:0] q);
    assign q = my_wide[31:0];
endmodule' >wide.v
echo 'module odd(input clk, input type_t [1:0] a); endmodule' >odd.sv
echo 'module broken(input clk;' >broken.v
refused 'usage: ./icesoc core foreign' wb_port wishbone
refused "got 'spi'" wb_port spi wb_port.v
mkdir out
! new my_port wb_port wishbone out wb_port.v >log 2>&1 && grep -q 'already exists' log ||
    { cat log && exit 1; }
rmdir out
named My 'small letters' wb_port wishbone wb_port.v
named event "'event' is a reserved word" wb_port wishbone wb_port.v
named npi_fifo "'npi_fifo' is the name of this project's module in hdl" wb_port wishbone wb_port.v
named wb_port "'wb_port' is also the name of a module of the core" wb_port wishbone wb_port.v
refused "none.v': expected a Verilog or VHDL file" wb_port wishbone none.v
refused "no module 'missing' in --files; found wb_port" missing wishbone wb_port.v
refused 'does not elaborate broken' broken wishbone broken.v
refused "inout port 'sda'" pads wishbone pads.v
refused 'has no port for awvalid' wb_port axil wb_port.v
refused 'expected a path without spaces' wb_port wishbone 'a b.v'
sed '1i // module wb_port' wb_port.v >again.v
refused "again.v:6: module 'wb_port' is also in .*/wb_port.v:5" wb_port wishbone wb_port.v again.v
echo 'module npi_fifo(input clk); endmodule' >ours.v
refused "ours.v:1: module 'npi_fifo' has the same name as .*hdl/ddr/npi_fifo.v:" wb_port wishbone \
    wb_port.v ours.v
sed '1i `include "sizes.vh"' wb_port.v >head.v
refused "sizes.vh.*" wb_port wishbone head.v
refused 'files may also name headers' wb_port wishbone head.v
refused 'only Verilog or only VHDL' wb_port wishbone wb_port.v lamps.vhd
refused "top: expected the name of a module or an entity, got 'wb_port; x'" \
    'wb_port; x' wishbone wb_port.v
refused "no entity 'lamp' in --files; found lamps" lamp own lamps.vhd
refused 'no port for write, wdata, rdata; its ports are clock, .*--ports write=PORT' req_words own \
    cores.v
refused "'grant': expected one of .*select, strobe" req_words own grant=gnt cores.v
refused "has no port 'go'; its ports are clock, " req_words own write=go cores.v
refused "ack must be an output of the core, and 'req' is not" req_words own ack=req cores.v
refused 'a strobe of one clock needs an ack' req_words own strobe=req write=wr wdata=value \
    rdata=held clock=clock cores.v
refused "files lacks the file with module 'inner'" outer wishbone outer.v
refused "params: axil_words has no 'WIDTH'" axil_words axil PARAM:WIDTH=8 axil_words.v
refused 'params: WIDTH is given twice' axil_words axil PARAM:WIDTH=8 PARAM:WIDTH=16 axil_words.v
for odd in '' 1X a-b; do
    refused "params: expected a name, got '$odd'" axil_words axil "PARAM:$odd=8" axil_words.v
    refused "defines: expected a name, got '$odd'" axil_words axil "DEFINE:$odd" axil_words.v
done
refused "'my_wide' of .* has 64 bits" wide own select=clk_en write=we address=a wdata=my_wide \
    rdata=q wide.v
echo 'module broad(input clk, we, input [31:0] d, output [31:0] q, output [127:0] pads,
    input [32:0] more); endmodule' >broad.v
refused "'pads' of broad has 128 bits, but a pin has at most 32: --ports open=pads low=more" broad \
    own write=we wdata=d rdata=q broad.v
refused 'include looks for timescale.v' apb_words apb "$here/apb_words.v"
: >timescale.v
refused 'Verilator does not elaborate odd' odd memory odd.sv
refused "no port for ack; .*ack=1" wbs_names wishbone cores.v
refused "more than one port for rdata: wbs_dat_o, spare" wbs_names wishbone rdata=spare ack=1 \
    cores.v
echo 'module two(input clk, input [7:0] a_tdata, b_tdata, input a_tvalid, output [7:0] o_tdata,
    output o_tvalid, input o_tready); endmodule' >two.v
echo 'module odd(input clk, input [23:0] i_tdata, input i_tvalid, output [7:0] o_tdata,
    output o_tvalid, input o_tready); endmodule' >odd.v
refused 'more than one port for s_tdata: a_tdata, b_tdata' two axis two.v
refused 'odd has 24 and 8 bits: expected 8, 16, 32 or 64' odd axis odd.v
refused 'has no port for s_tdata' wb_port axis wb_port.v
refused "clock: expected 3000000.*got 'fast'" wb_port wishbone CLOCK=fast wb_port.v
refused "address: expected words or bytes.*got 'fast'" wb_port wishbone ADDRESS=fast wb_port.v
refused 'leave out ack=' apb_words apb ack=1 pin=PREADY "$here/apb_words.v" timescale.v
refused 'clock: a core with AXI-Streams' axis_scale axis CLOCK=24000000 cores.v
refused 'library: expected VHDL files, got Verilog' req_words own LIBRARY=lights cores.v
refused "expected 'setting' only with --bus axis" req_words own setting=value cores.v
refused "setting must be an input of the core, and 'over' is not" axis_scale axis setting=over \
    cores.v
# The same module name in two cores of a chip is an error.
! "$source/tools/python" -m icesoc.cores.foreign_files wb_port.v again.v 2>log &&
    grep -q "again.v:6: module 'wb_port' is also in .*a chip has one of each" log ||
    { cat log && exit 1; }
# Port names from which the command recognises the role of a port.
new my_port wbs_names wishbone names ack=2 open=spare cores.v >log
prints 'wbs_clk: clock' 'rst_ni: resetn' 'gate_clk_pad_i: pin' 'clk_div: pin' \
    'wbs_cyc_i: cyc' 'wbs_adr_i: adr, counts words: it has 2 bits; if not, --address bytes' \
    'wbs_cti_i: low' 'intr: interrupt' 'spare: open'
# If macros are multiples of 4, they are byte addresses.
printf '%s\n' "\`define PORT_MODE 8'h0" '  `define PORT_MODE_BITS 2' \
    "\`define PORT_LEVEL 8'h8 // of pins" >macros.vh
echo 'module macros(input clk, we, input [7:0] a, input [31:0] d, output [31:0] q);
    assign q = d ^ a;
endmodule' >macros.v
new my_port macros own macros write=we address=a wdata=d rdata=q macros.vh macros.v >log
grep -q 'a: adr, counts bytes: PORT_MODE, PORT_LEVEL are multiples of 4; if not' log &&
    grep -q 'registers: MODE LEVEL' log && grep -q '"word": 10' macros/my_port.regs.json ||
    { cat log && exit 1; }
# The command asks about outputs that may be interrupts. It recognises an active-low interrupt.
echo 'module asked(input clk, we, input [31:0] d, output [31:0] q, output TIMERINT, irq_no, point,
    output [3:0] rx_events); endmodule' >asked.v
new my_port asked own asked write=we wdata=d rdata=q asked.v >log
prints "TIMERINT: pin timerint_o; if it is an interrupt: --ports interrupt=TIMERINT" \
    "rx_events: pin rx_events_o; if it is an interrupt: --ports interrupt=rx_events" \
    'irq_no: interruptn$' 'point: pin point_o$'
new my_port asked own open write=we wdata=d rdata=q 'open=*t*' asked.v >log
prints 'TIMERINT: pin' 'rx_events: open' 'point: open' 'irq_no: interruptn'
refused "has no port 'TIMER\*'" asked own write=we wdata=d rdata=q 'low=TIMER*' asked.v
grep -q 'interrupt = !interrupt_0;' asked/my_port.v
# 'open=*' leaves many unneeded pins open.
new my_port asked own spared write=we wdata=d rdata=q 'open=*' pin=point asked.v >log
prints 'irq_no: interruptn$' 'rx_events: open$' 'point: pin point_o$'
# A file that is listed twice is used once. A real number may have an exponent.
echo 'module gain #(parameter real G = 1.0) (input clk, we, input [31:0] d, output [31:0] q);
    assign q = G > 100.0 ? d : 0;
endmodule' >gain.v
new my_port gain own gain write=we wdata=d rdata=q PARAM:G=2.5e3 gain.v "$PWD/./gain.v" >log
grep -q 'gain #(.G(2.5e3)) u_core' gain/my_port.v &&
    [ "$(grep -c 'gain\.v"' gain/core.toml)" = 1 ] ||
    { cat log gain/core.toml gain/my_port.v && exit 1; }
# OpenCores' parameter ARST_LVL sets the active level of the reset port, even if an internal signal
# has the usual name of a reset.
echo 'module level #(parameter ARST_LVL = 0) (input clk, arst_i, we, input [31:0] d,
        output reg [31:0] q);
    wire rst = arst_i ^ ARST_LVL[0];
    always @(posedge clk or negedge rst) if (!rst) q <= 0; else if (we) q <= d;
endmodule' >level.v
new my_port level own level write=we wdata=d rdata=q level.v >log
grep -q '^  arst_i: resetn' log && grep -q 'level u_core' level/my_port.v ||
    { cat log && echo 'the level of a reset is wrong' && exit 1; }
# In a narrow APB core, register addresses count units of the data width, unless the address begins
# at bit 2.
for bits in 8 16; do
    echo "module apb$bits(input pclk, psel, penable, pwrite, input [5:0] paddr,
        input [$((bits - 1)):0] pwdata, output [$((bits - 1)):0] prdata);
    endmodule" >apb$bits.v
done
new my_port apb8 apb apb8 apb8.v >log
prints 'paddr: adr, counts bytes, each a register: the data of this APB has 8 bits; if not'
grep -q 'paddr(adr\[7:2\])' apb8/my_port.v && grep -q 'at 0x1 in' apb8/my_port.regs.json || exit 1
new my_port apb16 apb apb16 apb16.v >log
grep -q 'paddr(adr\[6:1\])' apb16/my_port.v && grep -q 'at 0x2 in' apb16/my_port.regs.json || exit 1
sed 's/5:0/7:2/' apb8.v >apb8_high.v
new my_port apb8 apb apb8_high apb8_high.v >log
prints 'paddr: adr, counts bytes: it begins at bit 2'
# A memory of 64 KiB with initial contents is read within seconds, because Yosys need not unroll the
# loop. If the reset of the memory contains a loop, the command stops waiting for Yosys after a time
# and uses Verilator; until then a message reports the wait.
cat >big.v <<'END'
module big (input clk, rst_n, we, input [13:0] a, input [31:0] d, output reg [31:0] q);
    reg [31:0] words [0:16383];
    integer i;
`ifdef EMPTY
    initial begin : fill // "begin" in a comment
        for (i = 0; i < 16384; i = i + 1)
            if (i % 2 == 0) words[i] = 32'd0; else begin words[i] = 32'd1; end
    end
`endif
    initial begin
        for (i = 0; i < 16384; i = i + 1) begin
            case (i % 2)
                0: words[i] = 32'd0;
                default: words[i] = 32'd1;
            endcase
        end
        $display("initial ; end");
    end
    always @(posedge clk) begin
        if (we) words[a] <= d;
        q <= words[a];
    end
endmodule
END
big_ports='write=we address=a wdata=d rdata=q ADDRESS=words'
# shellcheck disable=SC2086 # a list of words
timeout 60 "$source/tools/python" -m icesoc.cores.new_foreign my_port big own big $big_ports \
    DEFINE:EMPTY big.v >log 2>&1 && ! grep -q waiting log ||
    { cat log && echo 'a large memory takes long' && exit 1; }
prints 'rst_n: resetn'
sed 's/if (we)/if (!rst_n) for (i = 0; i < 16384; i = i + 1) words[i] = 0;\
    else if (we)/;s/words\[a\] <= d/words[a] = d/' big.v \
    >cleared.v
limited='import sys
from icesoc.cores import foreign_ports, new_foreign
foreign_ports.REPORT, foreign_ports.LIMIT = 1, 2
new_foreign.main(sys.argv[1:])'
# shellcheck disable=SC2086
"$source/tools/python" -c "$limited" my_port big own cleared $big_ports cleared.v >log 2>&1 &&
    grep -q 'waiting for Yosys to elaborate big: 1 s' log &&
    grep -q 'Yosys has not elaborated big in 2 s, so Verilator reads its ports' log ||
    { cat log && echo 'a slow core is not reported' && exit 1; }
prints 'd: wdata'
# Packed structures: a bus in the style of AXI with nested members that get roles from PORTS, and a
# structure of pins.
cat >nested.sv <<'END'
package nested_types;
    typedef struct packed {logic [7:0] addr; logic [2:0] prot;} address_t;
    typedef struct packed {logic [31:0] data; logic [3:0] strb;} data_t;
    typedef struct packed {
        address_t aw; logic aw_valid; data_t w; logic w_valid, b_ready;
        address_t ar; logic ar_valid, r_ready; } req_t;
    typedef struct packed {logic [1:0] resp;} b_t;
    typedef struct packed {logic [31:0] data; logic [1:0] resp;} r_t;
    typedef struct packed {
        logic aw_ready, w_ready, ar_ready, b_valid; b_t b; logic r_valid; r_t r; } resp_t;
    typedef struct packed {logic on; logic [1:0] level;} pins_t;
endpackage
module nested import nested_types::*; (input logic clk, rst_n, input req_t req_i,
        output resp_t resp_o, input pins_t pins_i, output pins_t state_o);
    assign resp_o = '0, state_o = pins_i;
endmodule
END
new my_port nested axil nested nested.sv >log
prints 'req_i.aw.addr: awaddr' 'req_i.w.strb: wstrb' 'resp_o.r.resp: rresp' 'pins_i: pin pins_i$'
grep -q 'resp_o({awready, wready, arready, bvalid, bresp, rvalid, rdata, rresp})' \
    nested/my_port.v || { cat nested/my_port.v && exit 1; }
new my_port nested axil parts open=state_o.on nested.sv >log
prints 'state_o.on: open' 'state_o.level: pin state_level_o'
grep -q 'state_o({unused_state_o_on, state_level_o})' parts/my_port.v || exit 1
# A SystemVerilog interface as a port is rejected, with a message that shows the solution.
echo 'interface bus_if (input logic clk); logic sel; modport slave (input clk, sel); endinterface
module faced (input logic reset, bus_if.slave s); endmodule' >faced.sv
refused "faced has the port 's', a SystemVerilog interface (bus_if.slave)" faced apb faced.sv
refused 'bus_if s (...);' faced apb faced.sv
# VHDL files in several libraries.
refused "library: expected a library and one of the files, got 'util=none.vhd'" lamps own \
    LIBRARY=util=none.vhd lamps.vhd
if [ -x "$ghdl" ]; then # the build downloads GHDL 5
    cp "$here/lamps_types.vhd" .
    sed 's/lights/types/' lamps.vhd >two_libraries.vhd
    new my_port lamps own libraries GHDL="$ghdl" LIBRARY=main LIBRARY=types='*_types.vhd' \
        PARAM:lamps_lit=4 read=request_rd write=request_wr address=request_a wdata=request_d \
        rdata=q two_libraries.vhd lamps_types.vhd >log || { cat log && exit 1; }
    grep -q '"types=.*/lamps_types.vhd"' libraries/core.toml &&
        "$source/tools/python" -m icesoc.chip.manifest libraries/core.toml |
        grep -q '"LIBRARIES" "types=.*/lamps_types.vhd"' ||
        { cat libraries/core.toml && exit 1; }
fi
# SystemVerilog with packages in any order, and a loop about which Verilator prints a warning.
cat >system.sv <<'END'
module system import sizes::*; #(parameter EXTRA = 1) (
    input logic clk, input logic we, input logic [1:0][7:0] d, output pair_t q,
    output state_t state_o, input logic [EXTRA:0] more_i);
    logic [0:2][31:0] held;
    always_ff @(posedge clk) if (we) held <= '{default: widths::W'(d)};
    assign q = held[1][15:0];
    function automatic logic is_odd(input logic [3:0] number); return number[0]; endfunction
    assign state_o = is_odd(d[0][3:0]) ? RUN : IDLE;
endmodule
END
printf 'package sizes; import widths::*;
typedef enum logic [1:0] {IDLE, RUN} state_t;
typedef struct packed {logic [W-1:0] a; logic [7:0] b;} pair_t;
endpackage' >sizes.sv
echo 'package widths; localparam W = 8; endpackage' >widths.sv
new my_port system own system PARAM:EXTRA=2 write=we wdata=d rdata=q \
    system.sv sizes.sv widths.sv >log
prints 'state_o: pin state_o' "sv2v --top=system .*/widths.sv .*/sizes.sv .*/system.sv >system.v"
! grep -q 'is_odd\|number' log && # arguments of functions are not ports
    grep -q 'input  wire \[2:0\] more_i' system/my_port.v &&
    grep -q '"width": 16' system/my_port.regs.json &&
    ! grep -q UNOPTFLAT system/core.toml ||
    { cat log system/my_port.v && exit 1; }
# A register has the width of the data that is written to it, or of the data that is read from it,
# whichever is wider.
echo 'module narrow(input clk, we, input [16:0] d, output [12:0] q);
    assign q = d[12:0];
endmodule' >narrow.v
new my_port narrow own narrow write=we wdata=d rdata=q narrow.v >log &&
    grep -q '"width": 17' narrow/my_port.regs.json ||
    { cat log && echo 'a register has not 17 bits' && exit 1; }
# Parameters in all forms that users type, and a file that begins with a byte order mark.
cat >typed.v <<'END'
module typed #(parameter MODE = "SLOW", parameter [31:0] INIT = 0, parameter signed [7:0] LOW = 0)
    (input clk, input we, input [(MODE == "FAST" ? 8 : 7) - LOW:0] d, output reg [31:0] q);
    always @(posedge clk) q <= we ? {INIT[31:16], 16'd0} | d : q;
endmodule
END
printf '\357\273\277' | cat - typed.v >marked.v
for value in FAST '"FAST"'; do
    rm -rf typed
    new my_port typed own typed PARAM:MODE="$value" PARAM:LOW=-3 PARAM:INIT=0xDEADBEEF \
        write=we wdata=d rdata=q marked.v >log
    grep -q '.MODE("FAST"), .LOW(-3), .INIT(32.hDEADBEEF)' typed/my_port.v &&
        grep -q 'd(wdata\[11:0\])' typed/my_port.v &&
        [ "$(head -c 6 typed/copy_marked.v)" = module ] ||
        { cat log typed/my_port.v && echo 'parameters are not as typed' && exit 1; }
done
refused "params: INIT: expected a number such as .*, got '2[*]1'" typed own PARAM:INIT='2*1' \
    write=we wdata=d rdata=q typed.v
while read -r value words; do
    refused "params: INIT: $words, got '$value'" typed own PARAM:INIT="$value" \
        write=we wdata=d rdata=q typed.v
done <<'END'
4'hFF expected a number of at most 4 bits
8'd256 expected a number of at most 8 bits
0'h1 expected a number of at most 0 bits
8'b12 expected digits of base 2
8'o8 expected digits of base 8
8'd1F expected digits of base 10
99999999999 expected a number of at most 32 bits
-2147483649 expected a number of at most 32 bits
0x_ expected a number such as .*
END
# Slots are also written where /dev/shm is not writable, as in some containers, and a rejected core
# is an error there. A container may not allow a mount.
slots() { unshare --map-root-user --mount sh -c 'mount -t tmpfs -o ro none /dev/shm && exec "$@"' \
    sh "$source/tools/python" "$here/write_slots.py" "$@" >log 2>&1; }
if unshare --map-root-user --mount mount -t tmpfs -o ro none /dev/shm; then
    slots -- my_port wb_port axil odd_bus wb_port.v -- my_port wb_port wishbone first wb_port.v &&
        { cat log && echo 'a rejected core is accepted' && exit 1; }
    grep -q 'core foreign: wb_port has no port for' log && rm -rf first &&
        slots -- my_port wb_port wishbone first wb_port.v -- my_port wb_port wishbone second \
            wb_port.v && [ -s first/core.toml ] && [ -s second/core.toml ] ||
        { cat log && exit 1; }
fi
# Messages name the options as the user typed them: above as for ./icesoc, here as for make.
refused "no port for write, wdata.*PORTS='write=PORT'" req_words own SPELLING=make cores.v
refused 'CLOCK: expected 3000000' wb_port wishbone SPELLING=make CLOCK=fast wb_port.v
new my_port asked own by_make SPELLING=make write=we wdata=d rdata=q asked.v >log
prints "TIMERINT: pin timerint_o; if it is an interrupt: PORTS='interrupt=TIMERINT'"
# The same command by make, and a core with a name that already exists.
mkdir -p "$work/tree/ip"
made() { "$source/tests/regress/make_in.sh" "$source" "$work/tree" build \
    new-foreign NAME=my_port TOP=req_words BUS=own FILES="$work/cores.v" "$@" >log 2>&1; }
! made && grep -q "PORTS=" log || { cat log && exit 1; }
made CLOCK=24000000 PORTS='select=req write=wr address=where wdata=value rdata=held ack=gnt' &&
    [ -s "$work/tree/ip/my_port/my_port.regs.json" ] ||
    { cat log && exit 1; }
made NAME=my_bridge TOP=apb_words BUS=apb FILES="$here/apb_words.v $work/timescale.v" \
    PARAMS=WORDS=3 PORTS= && grep -q 'WORDS(3)' "$work/tree/ip/my_bridge/my_bridge.v" ||
    { cat log && exit 1; }
echo 'refused: all as expected'
