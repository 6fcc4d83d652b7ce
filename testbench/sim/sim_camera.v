// SPDX-License-Identifier: MIT
//
// sim_camera: the camera core alone, as it works while a sensor sends a picture. camera_alone.h
// computes clocks with this model and with sim_memory.v while the rest of the chip would not
// change.
//
// Instances have the same names as in sim_soc.v, so that the state of a register can be copied
// between the models. While this model is used, nothing accesses the registers of the core, and the
// outputs of other cores do not change.

`default_nettype none
`include "core_pins.vh"

module sim_camera (
    // The memory port of the camera; its inputs are set to the values that they have after the
    // edge, and pass through flip-flops here, as the inputs from the MCB in sim_soc.v.
    `include "memory_ports.vh"
    input  wire        tick_i, // each change is one clock, as in sim_soc.v
    // Reset and register bus are always low. They come from inputs, because otherwise Verilator
    // would remove registers, or merge registers that differ only in their reset.
    input  wire        rst_i, valid_i, write_i,
    input  wire [3:0]  addr_i,
    input  wire [31:0] wdata_i,
    output wire [31:0] bus_rdata_o,
    input  wire [31:0] core_pins_i,
    input  wire [`CORE_CAMERA_FROM_BITS-1:0] from_cores_i, // outputs of other cores
    // outputs of the camera to the rest of the chip; while they do not change, the rest does not
    // change either. The register bus is not part of it: nothing samples it without an access.
    output wire [`CORE_CAMERA_TO_BITS-1:0] others_o,
    // the camera uses its memory port
    output wire        requests_o
);
    reg  ticked = 1'b0;
    wire clk_i = tick_i != ticked;
    reg        rst, valid, write;
    reg [3:0]  addr;
    reg [31:0] wdata;
    reg        addr_ack, wr_empty, wr_almost_full, rd_empty;
    reg [63:0] rd_data;
    reg [3:0]  rd_word;
    reg [`CORE_CAMERA_FROM_BITS-1:0] from_cores;
    always @(posedge clk_i) begin
        ticked         <= tick_i;
        rst            <= rst_i;
        valid          <= valid_i;
        write          <= write_i;
        addr           <= addr_i;
        wdata          <= wdata_i;
        addr_ack       <= npi_addr_ack_i;
        wr_empty       <= npi_wr_empty_i;
        wr_almost_full <= npi_wr_almost_full_i;
        rd_empty       <= npi_rd_empty_i;
        rd_data        <= npi_rd_data_i;
        rd_word        <= npi_rd_word_i;
        from_cores     <= from_cores_i;
    end

    wire irq, bus_ready, bus_error;
    wire [`CORE_CAMERA_TO_BITS-1:0] to_cores;
    assign to_cores[0] = irq;
    generate
        if (1) begin : soc
            camera u_camera (
                .clk_i(clk_i), .rst_i(rst),
                .bus_valid_i(valid), .bus_write_i(write), .bus_addr_i(addr), .bus_wdata_i(wdata),
                .bus_ready_o(bus_ready), .bus_rdata_o(bus_rdata_o), .bus_error_o(bus_error),
                .npi_addr_o(npi_addr_o), .npi_addr_req_o(npi_addr_req_o),
                .npi_addr_ack_i(addr_ack), .npi_rnw_o(npi_rnw_o), .npi_size_o(npi_size_o),
                .npi_rmw_o(npi_rmw_o), .npi_wr_data_o(npi_wr_data_o), .npi_wr_be_o(npi_wr_be_o),
                .npi_wr_push_o(npi_wr_push_o), .npi_wr_empty_i(wr_empty),
                .npi_wr_almost_full_i(wr_almost_full), .npi_wr_flush_o(npi_wr_flush_o),
                .npi_rd_data_i(rd_data), .npi_rd_word_i(rd_word), .npi_rd_pop_o(npi_rd_pop_o),
                .npi_rd_empty_i(rd_empty), .npi_rd_flush_o(npi_rd_flush_o),
                .npi_init_done_i(1'b1), // stirs_o of sim_soc.v is high before that
                `CORE_CAMERA_PINS(from_cores, to_cores)
                .irq_o(irq));
        end
    endgenerate

    assign others_o   = to_cores;
    assign requests_o = |{npi_addr_req_o, npi_wr_push_o, npi_wr_flush_o, npi_rd_pop_o,
                          npi_rd_flush_o};

    wire unused = &{1'b0, core_pins_i, from_cores[0], bus_ready, bus_error, npi_init_done_i, 1'b0};
endmodule
