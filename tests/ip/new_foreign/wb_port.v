// SPDX-License-Identifier: MIT
//
// wb_port: Wishbone core in another style, for tests: 8 bits, word addresses, interrupt, pins.

module wb_port (
    input            wb_clk_i, wb_rst_i,
    input      [1:0] wb_adr_i,
    input      [7:0] wb_dat_i,
    output reg [7:0] wb_dat_o,
    input            wb_we_i, wb_stb_i, wb_cyc_i,
    output reg       wb_ack_o,
    output           wb_inta_o,
    input      [7:0] port_in,
    output reg [7:0] port_out
);
    localparam [1:0] PORT_LEVELS = 2'd0, // `./icesoc core foreign` makes the names of
                                         // registers from these names
                     PORT_DRIVEN = 2'b01;
    assign wb_inta_o = port_in[7];
    always @(posedge wb_clk_i) begin
        wb_ack_o <= wb_stb_i && wb_cyc_i && !wb_ack_o;
        wb_dat_o <= wb_adr_i == PORT_LEVELS ? port_in : port_out;
        if (wb_stb_i && wb_cyc_i && wb_we_i && wb_adr_i == PORT_DRIVEN)
            port_out <= wb_dat_i;
        if (wb_rst_i)
            port_out <= 8'd0;
    end
endmodule
