// SPDX-License-Identifier: MIT
//
// sim_soc: soc.v, its netlist, or that of table1.v (TABLE1), as the simulator clocks it.
//
// A clock is a change of tick_i: clk_i rises with it and falls as soon as its edge is taken, so that
// both edges pass in one evaluation. The memory's pins have flip-flops here, with what they have
// after the edge set before it: from inputs no path leads through the chip's logic, all of which the
// model would follow in each evaluation.

`default_nettype none

module sim_soc #(
    parameter CLK_HZ = 100000000
) (
    input  wire        tick_i,
    input  wire        rst_i,
    `include "platform_ports.vh"
    input  wire [31:0] core_pins_i,
    output wire [31:0] core_pins_o,
`ifdef PLATFORM_RESTS
    input  wire        rests_i,
    output wire        stirs_o,
`endif
    output wire        irq_o
);
    reg  ticked = 1'b0;
`ifdef TRACED
    wire clk_i = tick_i; // so that a waveform has both edges
`else
    wire clk_i = tick_i != ticked;
`endif

    reg [63:0] rd_data;
    reg        cmd_full, wr_full, rd_empty, calib_done;
    always @(posedge clk_i) begin
        ticked     <= tick_i;
        rd_data    <= mcb_rd_data_i;
        cmd_full   <= mcb_cmd_full_i;
        wr_full    <= mcb_wr_full_i;
        rd_empty   <= mcb_rd_empty_i;
        calib_done <= mcb_calib_done_i;
    end

`ifdef PLATFORM_RESTS
    `include "wiring.vh"
    // The memory's clock stops while the memory would not move.
    wire memory_clk_i;
    core_gate #(.GATED(1)) u_gate_memory (
        .clk_i(clk_i), .rst_i(soc.rst), .access_i(1'b0), .idle_i(`MEMORY_RESTS(soc.u_memory)),
        .clk_o(memory_clk_i));

    soc #(.CLK_HZ(CLK_HZ), .GATES(1))
`elsif TABLE1
    assign core_pins_o = 32'd0;
    table1
`else
    soc
`endif
    soc (.*,
`ifdef TABLE1
         .page_i(6'd0), .access_error_o(), .error_memory_o(), .error_addr_o(), .error_write_o(),
         .late_o(),
`endif
         .mcb_cmd_full_i(cmd_full), .mcb_wr_full_i(wr_full), .mcb_rd_empty_i(rd_empty),
         .mcb_rd_data_i(rd_data), .mcb_calib_done_i(calib_done));
endmodule
