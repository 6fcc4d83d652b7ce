#!/bin/sh
# SPDX-License-Identifier: MIT
# refused: new_foreign.py work-folder   Input that make new-foreign refuses, with a reason and
# nothing written. It is shell because a case is a command and what it says.
set -eu
new=$1 work=$2
here=$(cd "$(dirname "$0")" && pwd)
rm -rf "$work"
mkdir -p "$work"
refused() { # words of the message, arguments
    words=$1
    shift
    ! "$new" "$@" >"$work/log" 2>&1 || { echo "accepted: $*" && exit 1; }
    grep -q -- "$words" "$work/log" && ! grep -q Traceback "$work/log" || { cat "$work/log" &&
        echo "'$words' is not said: $*" && exit 1; }
    [ ! -e "$work/out" ] || { echo "something was written: $*" && exit 1; }
}
: >"$work/timescale.v"
says() { # each line of the log
    for line; do
        grep -q "^  $line" "$work/log" || { cat "$work/log" && echo "'$line' is not said" &&
            exit 1; }
    done
}
echo 'module pads(input clk, inout sda); endmodule' >"$work/pads.v"
echo 'module outer(input clk); inner u(clk); endmodule' >"$work/outer.v"
echo 'module wide(input clk, clk_en, we, input [1:0] a, input [63:0] my_wide, output [31:0] q); assign q = my_wide[31:0]; endmodule' >"$work/wide.v"
echo 'module odd(input clk, input type_t [1:0] a); endmodule' >"$work/odd.sv"
echo 'module broken(input clk;' >"$work/broken.v"
refused 'usage: make new-foreign' my_port wb_port wishbone "$work/out"
refused "not 'spi'" my_port wb_port spi "$work/out" "$here/wb_port.v"
refused 'is there already' my_port wb_port wishbone "$work" "$here/wb_port.v"
refused 'small letters' My wb_port wishbone "$work/out" "$here/wb_port.v"
refused "'event' is a reserved word" event wb_port wishbone "$work/out" "$here/wb_port.v"
refused "'npi_fifo' is the name of this project's module in hdl" npi_fifo wb_port wishbone \
    "$work/out" "$here/wb_port.v"
refused "'wb_port' is the name of a module of the core" wb_port wb_port wishbone "$work/out" \
    "$here/wb_port.v"
refused 'no Verilog or VHDL file' my_port wb_port wishbone "$work/out" "$work/none.v"
refused "no module 'nobody' in FILES; there is wb_port" my_port nobody wishbone "$work/out" \
    "$here/wb_port.v"
refused 'does not elaborate broken' my_port broken wishbone "$work/out" "$work/broken.v"
refused "inout port 'sda'" my_port pads wishbone "$work/out" "$work/pads.v"
refused 'has no port for awvalid' my_port wb_port axil "$work/out" "$here/wb_port.v"
refused 'has a space in its name' my_port wb_port wishbone "$work/out" "$work/a b.v"
sed '1i // module wb_port' "$here/wb_port.v" >"$work/again.v"
refused "again.v:6: module 'wb_port' is in .*/wb_port.v:5, too" my_port wb_port wishbone \
    "$work/out" "$here/wb_port.v" "$work/again.v"
echo 'module npi_fifo(input clk); endmodule' >"$work/ours.v"
refused "ours.v:1: module 'npi_fifo' has the name of .*hdl/ddr/npi_fifo.v:" my_port wb_port \
    wishbone "$work/out" "$here/wb_port.v" "$work/ours.v"
sed '1i `include "sizes.vh"' "$here/wb_port.v" >"$work/head.v"
refused "sizes.vh.*" my_port wb_port wishbone "$work/out" "$work/head.v"
refused 'FILES may name headers' my_port wb_port wishbone "$work/out" "$work/head.v"
refused 'all Verilog or all VHDL' my_port wb_port wishbone "$work/out" "$here/wb_port.v" \
    "$here/lamps.vhd"
refused "TOP is the name of a module or an entity, not 'wb_port; x'" my_port 'wb_port; x' wishbone \
    "$work/out" "$here/wb_port.v"
refused "no entity 'lamp' in FILES; there is lamps" my_port lamp own "$work/out" "$here/lamps.vhd"
refused 'no port for write, wdata, rdata: .*PORTS=' my_port req_words own "$work/out" \
    "$here/cores.v"
refused "'grant' is none of .*select, strobe" my_port req_words own "$work/out" grant=gnt \
    "$here/cores.v"
refused "has no port 'go'" my_port req_words own "$work/out" write=go "$here/cores.v"
refused "ack is an output of a core, and 'req' is not" my_port req_words own "$work/out" ack=req \
    "$here/cores.v"
refused 'a strobe of one clock needs an ack' my_port req_words own "$work/out" strobe=req write=wr \
    wdata=value rdata=held clock=clock "$here/cores.v"
refused "FILES lacks the file with module 'inner'" my_port outer wishbone "$work/out" \
    "$work/outer.v"
refused "PARAMS: axil_words has no 'WIDTH'" my_port axil_words axil "$work/out" PARAM:WIDTH=8 \
    "$here/axil_words.v"
refused "'my_wide' of .* has 64 bits" my_port wide own "$work/out" select=clk_en write=we \
    address=a wdata=my_wide rdata=q "$work/wide.v"
echo 'module broad(input clk, we, input [31:0] d, output [31:0] q, output [127:0] pads, input [32:0] more); endmodule' >"$work/broad.v"
refused "'pads' of broad has 128 bits, and a pin at most 32: PORTS='open=pads low=more'" my_port \
    broad own "$work/out" write=we wdata=d rdata=q "$work/broad.v"
refused 'include looks for timescale.v' my_port apb_words apb "$work/out" "$here/apb_words.v"
refused 'Verilator does not elaborate odd' my_port odd memory "$work/out" "$work/odd.sv"
refused "no port for ack: .*ack=1" my_port wbs_names wishbone "$work/out" "$here/cores.v"
refused "more than one port for rdata: wbs_dat_o, spare" my_port wbs_names wishbone "$work/out" \
    rdata=spare ack=1 "$here/cores.v"
echo 'module two(input clk, input [7:0] a_tdata, b_tdata, input a_tvalid, output [7:0] o_tdata, output o_tvalid, input o_tready); endmodule' >"$work/two.v"
echo 'module odd(input clk, input [23:0] i_tdata, input i_tvalid, output [7:0] o_tdata, output o_tvalid, input o_tready); endmodule' >"$work/odd.v"
refused 'more than one port for s_tdata: a_tdata, b_tdata' my_port two axis "$work/out" \
    "$work/two.v"
refused 'odd has 24 and 8 bits: it must be 8, 16, 32 or 64' my_port odd axis "$work/out" \
    "$work/odd.v"
refused 'has no port for s_tdata' my_port wb_port axis "$work/out" "$here/wb_port.v"
refused "CLOCK=fast: the frequency" my_port wb_port wishbone "$work/out" CLOCK=fast \
    "$here/wb_port.v"
refused 'ADDRESS=fast: words or bytes' my_port wb_port wishbone "$work/out" ADDRESS=fast \
    "$here/wb_port.v"
refused 'ack= is not for it' my_port apb_words apb "$work/out" ack=1 pin=PREADY \
    "$here/apb_words.v" "$work/timescale.v"
refused 'CLOCK: a core with AXI-Streams' my_port axis_scale axis "$work/out" CLOCK=24000000 \
    "$here/cores.v"
refused 'LIBRARY: .* these are Verilog' my_port req_words own "$work/out" LIBRARY=lights \
    "$here/cores.v"
refused 'a setting is for BUS=axis' my_port req_words own "$work/out" setting=value \
    "$here/cores.v"
refused "setting is an input of a core, and 'over' is not" my_port axis_scale axis "$work/out" \
    setting=over "$here/cores.v"
# Of two cores in one chip.
! "${new%/*}/foreign_files.py" "$here/wb_port.v" "$work/again.v" 2>"$work/log" &&
    grep -q "again.v:6: module 'wb_port' is in .*a chip has one of each" "$work/log" ||
    { cat "$work/log" && exit 1; }
# Meanings of names.
"$new" my_port wbs_names wishbone "$work/names" ack=2 open=spare "$here/cores.v" >"$work/log"
says 'wbs_clk: clock' 'rst_ni: resetn' 'gate_clk_pad_i: pin' 'clk_div: pin' \
    'wbs_cyc_i: cyc' 'wbs_adr_i: adr, counts words: it has 2 bits; if not, ADDRESS=bytes' \
    'wbs_cti_i: low' 'intr: interrupt' 'spare: open'
# Macros that are multiples of 4 are byte addresses.
printf '`define PORT_MODE 8\047h0\n  `define PORT_MODE_BITS 2\n`define PORT_LEVEL 8\047h8 // of pins\n' >"$work/macros.vh"
echo 'module macros(input clk, we, input [7:0] a, input [31:0] d, output [31:0] q); assign q = d ^ a; endmodule' >"$work/macros.v"
"$new" my_port macros own "$work/macros" write=we address=a wdata=d rdata=q "$work/macros.vh" \
    "$work/macros.v" >"$work/log"
grep -q 'a: adr, counts bytes: PORT_MODE, PORT_LEVEL are multiples of 4; if not' "$work/log" &&
    grep -q 'registers: MODE LEVEL' "$work/log" && grep -q '"word": 10' "$work/macros/my_port.regs.json" ||
    { cat "$work/log" && exit 1; }
# Outputs that may be interrupts are asked about; one that is active low is told.
echo 'module asked(input clk, we, input [31:0] d, output [31:0] q, output TIMERINT, irq_no, point, output [3:0] rx_events); endmodule' >"$work/asked.v"
"$new" my_port asked own "$work/asked" write=we wdata=d rdata=q "$work/asked.v" >"$work/log"
says "TIMERINT: pin timerint_o; if it is an interrupt: PORTS='interrupt=TIMERINT'" \
    "rx_events: pin rx_events_o; if it is an interrupt: PORTS='interrupt=rx_events'" \
    'irq_no: interruptn$' 'point: pin point_o$'
"$new" my_port asked own "$work/open" write=we wdata=d rdata=q 'open=*t*' "$work/asked.v" >"$work/log"
says 'TIMERINT: pin' 'rx_events: open' 'point: open' 'irq_no: interruptn'
refused "has no port 'TIMER\*'" my_port asked own "$work/out" write=we wdata=d rdata=q \
    'low=TIMER*' "$work/asked.v"
grep -q 'interrupt = !interrupt_0;' "$work/asked/my_port.v"
# Many pins that nobody needs.
"$new" my_port asked own "$work/spared" write=we wdata=d rdata=q 'open=*' pin=point "$work/asked.v" >"$work/log"
grep -q 'irq_no: interruptn$' "$work/log" && grep -q 'rx_events: open$' "$work/log" &&
    grep -q 'point: pin point_o$' "$work/log" ||
    { cat "$work/log" && exit 1; }
# OpenCores' level of a reset, whatever else has it for a name.
echo 'module level #(parameter ARST_LVL = 0) (input clk, arst_i, we, input [31:0] d, output reg [31:0] q);
    wire rst = arst_i ^ ARST_LVL[0];
    always @(posedge clk or negedge rst) if (!rst) q <= 0; else if (we) q <= d;
endmodule' >"$work/level.v"
"$new" my_port level own "$work/level" write=we wdata=d rdata=q "$work/level.v" >"$work/log"
grep -q '^  arst_i: resetn' "$work/log" && grep -q 'level u_core' "$work/level/my_port.v" ||
    { cat "$work/log" && echo 'the level of a reset is wrong' && exit 1; }
# SystemVerilog with packages, in any order, and a loop that Verilator reports.
cat >"$work/system.sv" <<'END'
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
endpackage' >"$work/sizes.sv"
echo 'package widths; localparam W = 8; endpackage' >"$work/widths.sv"
"$new" my_port system own "$work/system" PARAM:EXTRA=2 write=we wdata=d rdata=q \
    "$work/system.sv" "$work/sizes.sv" "$work/widths.sv" >"$work/log"
says 'state_o: pin state_o' "sv2v --top=system .*/widths.sv .*/sizes.sv .*/system.sv >system.v"
! grep -q 'is_odd\|number' "$work/log" && # what belongs to functions is no port
    grep -q 'input  wire \[2:0\] more_i' "$work/system/my_port.v" &&
    grep -q '"width": 16' "$work/system/my_port.regs.json" &&
    ! grep -q UNOPTFLAT "$work/system/CMakeLists.txt" ||
    { cat "$work/log" "$work/system/my_port.v" && exit 1; }
# A register is as wide as its written, or read, data.
echo 'module narrow(input clk, we, input [16:0] d, output [12:0] q); assign q = d[12:0]; endmodule' >"$work/narrow.v"
"$new" my_port narrow own "$work/narrow" write=we wdata=d rdata=q "$work/narrow.v" >"$work/log" &&
    grep -q '"width": 17' "$work/narrow/my_port.regs.json" ||
    { cat "$work/log" && echo 'a register has not 17 bits' && exit 1; }
# The same by make, and one that is taken.
mkdir -p "$work/tree/ip"
ln -s "$new" "$work/tree/ip"
made() { "${new%/ip/*}/tests/regress/test/make_in.sh" "${new%/ip/*}" "$work/tree" build \
    new-foreign NAME=my_port TOP=req_words BUS=own FILES="$here/cores.v" "$@" >"$work/log" \
    2>&1; }
! made && grep -q "PORTS=" "$work/log" || { cat "$work/log" && exit 1; }
made CLOCK=24000000 PORTS='select=req write=wr address=where wdata=value rdata=held ack=gnt' &&
    [ -s "$work/tree/ip/my_port/my_port.regs.json" ] ||
    { cat "$work/log" && exit 1; }
made NAME=my_bridge TOP=apb_words BUS=apb FILES="$here/apb_words.v $work/timescale.v" \
    PARAMS=WORDS=3 PORTS= && grep -q 'WORDS(3)' "$work/tree/ip/my_bridge/my_bridge.v" ||
    { cat "$work/log" && exit 1; }
echo 'refused: all as expected'
