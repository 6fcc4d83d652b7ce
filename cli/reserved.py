# SPDX-License-Identifier: MIT
"""reserved: names that no core may have."""
RESERVED = set("""abs access after alias all always and architecture array assert assign attribute automatic begin block body buf
 buffer bus case casex casez cell class cmos component config configuration const constant context cover deassign default defparam
 design disable disconnect double downto edge else elsif end enum event exit false file float for force forever fork function
 generate generic genvar group guarded highz0 highz1 if ifnone impure in inertial inout input instance int integer interface is join
 label large liblist library linkage literal local localparam long loop macromodule map medium mod module nand negedge new next nmos
 nor noshowcancelled not notif0 notif1 null object of on open operation or others out output package parameter pmos port posedge
 postponed primitive private procedure process property protected public pull0 pull1 pulldown pullup pure range rcmos real realtime
 record reg register reject release rem repeat report restrict return rnmos rol ror rpmos select sequence severity shared short
 showcancelled signal signed sla sll small specify specparam sra srl string strong strong0 strong1 struct subtype supply0 supply1
 table task template test then throws time to tran transport tri type union unaffected units unsigned until use value variable
 vectored void wait wand weak weak0 weak1 when while wire with wor work xnor xor""".split())

REFUSAL = "is a reserved word of Verilog, VHDL, C, Slice or this project"
