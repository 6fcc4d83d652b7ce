// SPDX-License-Identifier: MIT
//
// lines: top level for ISE, which connects line_tester to its pads, for the self-test of a new
// board (docs/first-board.md). It has the pads of chip.v except the pads of the DDR3, and uses the
// same board.ucf.

`default_nettype none

module lines (
    input  wire        sys_clk_i,
    inout  wire [24:0] fsmc_a_i,
    inout  wire [15:0] fsmc_d_io,
    inout  wire [1:0]  fsmc_ne_n_i,
    inout  wire        fsmc_noe_n_i,
    inout  wire        fsmc_nwe_n_i,
    inout  wire [1:0]  fsmc_nbl_n_i,
    inout  wire        fsmc_nadv_n_i,
    inout  wire        fsmc_nwait_n_o,
    inout  wire        irq_o,
    inout  wire        modem_rxd_i,
    inout  wire        modem_txd_o,
    inout  wire        modem_cts_n_i,
    inout  wire        modem_rts_n_o,
    inout  wire        modem_reset_n_o
);
    localparam LINES = 55;
    wire             osc;
    wire [LINES-1:0] pins_in, pins_out, pins_oe;

    // CFGMCLK: the FPGA's internal oscillator
    STARTUP_SPARTAN6 u_startup (
        .CFGCLK(), .CFGMCLK(osc), .EOS(), .CLK(1'b0), .GSR(1'b0), .GTS(1'b0), .KEYCLEARB(1'b1)
    );

    line_tester #(.LINES(LINES)) u_line_tester (
        .osc_i(osc), .clk_i(sys_clk_i), .pins_i(pins_in), .pins_o(pins_out), .pins_oe_o(pins_oe)
    );

    // in the order of line_tester's pins: the leftmost entry is the pin with the highest number
    assign pins_in = {modem_reset_n_o, modem_rts_n_o, modem_cts_n_i, modem_txd_o, modem_rxd_i,
                      irq_o, fsmc_nwait_n_o, fsmc_nadv_n_i, fsmc_nbl_n_i, fsmc_nwe_n_i,
                      fsmc_noe_n_i, fsmc_ne_n_i, fsmc_a_i, fsmc_d_io};

    genvar i;
    generate
        for (i = 0; i < 16; i = i + 1) begin : g_data
            assign fsmc_d_io[i] = pins_oe[i] ? pins_out[i] : 1'bz;
        end
        for (i = 0; i < 25; i = i + 1) begin : g_address
            assign fsmc_a_i[i] = pins_oe[16 + i] ? pins_out[16 + i] : 1'bz;
        end
        for (i = 0; i < 2; i = i + 1) begin : g_pairs
            assign fsmc_ne_n_i[i]  = pins_oe[41 + i] ? pins_out[41 + i] : 1'bz;
            assign fsmc_nbl_n_i[i] = pins_oe[45 + i] ? pins_out[45 + i] : 1'bz;
        end
    endgenerate
    assign fsmc_noe_n_i    = pins_oe[43] ? pins_out[43] : 1'bz;
    assign fsmc_nwe_n_i    = pins_oe[44] ? pins_out[44] : 1'bz;
    assign fsmc_nadv_n_i   = pins_oe[47] ? pins_out[47] : 1'bz;
    assign fsmc_nwait_n_o  = pins_oe[48] ? pins_out[48] : 1'bz;
    assign irq_o           = pins_oe[49] ? pins_out[49] : 1'bz;
    assign modem_rxd_i     = pins_oe[50] ? pins_out[50] : 1'bz;
    assign modem_txd_o     = pins_oe[51] ? pins_out[51] : 1'bz;
    assign modem_cts_n_i   = pins_oe[52] ? pins_out[52] : 1'bz;
    assign modem_rts_n_o   = pins_oe[53] ? pins_out[53] : 1'bz;
    assign modem_reset_n_o = pins_oe[54] ? pins_out[54] : 1'bz;
endmodule
