// SPDX-License-Identifier: MIT
//
// sim_soc: connects the chip to the clocks of the simulator. The chip is soc.v, its netlist, or the
// netlist of table1.v (TABLE1).
//
// Each change of tick_i is one clock: clk_i rises with the change and falls as soon as its edge has
// been processed, so one evaluation of the model is enough for both edges. The inputs from the
// memory pass through flip-flops here: before an edge, the simulator sets these inputs to the
// values that they have after the edge. Therefore no combinational path leads from these inputs
// through the chip's logic. The model would have to evaluate such a path at each change of the
// inputs.

`default_nettype none
`ifdef RESTS
`include "rests.vh"
`include "core_pins.vh"
`endif

module sim_soc #(
    parameter CLK_HZ = 100000000
) (
    input  wire        tick_i,
    input  wire        rst_i,
    // FSMC pins
    input  wire [24:0] fsmc_a_i,
    input  wire [15:0] fsmc_d_i,
    output wire [15:0] fsmc_d_o,
    output wire        fsmc_d_oe_o,
    input  wire [1:0]  fsmc_ne_n_i,
    input  wire        fsmc_noe_n_i,
    input  wire        fsmc_nwe_n_i,
    input  wire [1:0]  fsmc_nbl_n_i,
    input  wire        fsmc_nadv_n_i,
    output wire        fsmc_nwait_n_o,
    // modem pins
    input  wire        modem_rxd_i, // driven by the modem
    output wire        modem_txd_o,
    input  wire        modem_cts_n_i,
    output wire        modem_rts_n_o,
    output wire        modem_reset_n_o,
    // user port of the Spartan-6 MCB, 64 bits
    output wire        mcb_cmd_en_o,
    output wire [2:0]  mcb_cmd_instr_o,
    output wire [5:0]  mcb_cmd_bl_o,
    output wire [29:0] mcb_cmd_byte_addr_o,
    input  wire        mcb_cmd_full_i,
    output wire        mcb_wr_en_o,
    output wire [7:0]  mcb_wr_mask_o,
    output wire [63:0] mcb_wr_data_o,
    input  wire        mcb_wr_full_i,
    output wire        mcb_rd_en_o,
    input  wire [63:0] mcb_rd_data_i,
    input  wire        mcb_rd_empty_i,
    input  wire        mcb_calib_done_i,
    input  wire [31:0] core_pins_i,
    output wire [31:0] core_pins_o,
`ifdef RESTS
    input  wire        rests_i,
    output wire        stirs_o,
`ifdef CORE_CAMERA_FROM_BITS
    output wire [`CORE_CAMERA_FROM_BITS-1:0] camera_from_o, // inputs of the camera from other cores
`endif
`endif
    output wire        irq_o
);
`ifdef RESTS
    `include "map_regs.vh"
`endif
    reg  ticked = 1'b0;
`ifdef TRACED
    wire clk_i = tick_i; // a waveform needs both edges of the clock, so tick_i itself is the clock
`else
    wire clk_i = tick_i != ticked;
`endif
    always @(posedge clk_i)
        ticked <= tick_i;
    `include "sampled_mcb.vh"

`ifdef RESTS
    // The simulator's copies of soc.v and platform.v use these clocks (rest.awk). The platform's
    // clock stops while rests_i is high; the memory clock stops while the memory would not change.
    wire platform_clk = clk_i && !rests_i;
    wire memory_clk;
    core_gate #(.GATED(1), .LOG2(`MEMORY_REST_LOG2)) u_gate_memory (
        .clk_i(clk_i), .rst_i(soc.rst), .access_i(1'b0),
        .idle_i(`MEMORY_RESTS(soc.u_platform.u_memory)), .clk_o(memory_clk));
    // A probe may record the platform's counters. These would stand still while the clock is
    // stopped, so with a probe the clock is never stopped.
    assign stirs_o = MAP_PROBES != 0 || `PLATFORM_STIRS(soc.u_platform);
`ifdef CORE_CAMERA_FROM_BITS
    assign camera_from_o = `CORE_CAMERA_FROM(soc);
`endif

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
