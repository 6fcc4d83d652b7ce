// SPDX-License-Identifier: MIT
//
// sim_camera: the part of the chip that works while the sensor sends a picture: the camera core and
// the memory. camera_alone.h computes clocks with this model while the rest of the chip would not
// change.
//
// Instances have the same names as in sim_soc.v, so that the state of a register can be copied
// between the two models. While this model is used, all inputs from the rest of the chip are
// constant: nothing accesses the core's registers, no core takes a frame, and no other memory port
// has a request.

`default_nettype none
`include "rests.vh"

module sim_camera (
    input  wire        tick_i, // each change is one clock, as in sim_soc.v
    // Requests of the other memory ports, reset and register bus are always low. They come from an
    // input, because with constants Verilator would remove registers, or merge registers that
    // differ only in their reset.
    input  wire [39:0] low_i,
    output wire [31:0] bus_rdata_o,
    input  wire [31:0] core_pins_i,
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
    // outputs of camera and memory to the rest of the chip; while they do not change, the rest does
    // not change either. The register bus and the read words are not part of it: nothing samples
    // them without an access or a word in the FIFO.
    output wire [63:0] others_o,
    // the FIFOs of the other memory ports are empty
    output wire        empty_o,
    // keeps registers that only another memory port reads
    output wire [64:0] sampled_o
);
    `include "map_regs.vh"
    localparam PORTS = MAP_NPI_PORT_COUNT, PORT = MAP_NPI_PORT_CAMERA;
    // the parameters of the memory in soc.v and platform.v
    localparam [31:0] NO_READ_FIFO = 1 << MAP_NPI_PORT_FSMC | 1 << MAP_NPI_PORT_MODEM;
    localparam [31:0] WRITES_BYTES = 1 << MAP_NPI_PORT_MODEM;

    reg  ticked = 1'b0;
    wire clk_i = tick_i != ticked;
    reg [63:0] rd_data;
    reg        cmd_full, wr_full, rd_empty, calib_done;
    reg [39:0] low;
    always @(posedge clk_i) begin
        low        <= low_i;
        ticked     <= tick_i;
        rd_data    <= mcb_rd_data_i;
        cmd_full   <= mcb_cmd_full_i;
        wr_full    <= mcb_wr_full_i;
        rd_empty   <= mcb_rd_empty_i;
        calib_done <= mcb_calib_done_i;
    end

    wire memory_clk;
    core_gate #(.GATED(1)) u_gate_memory (
        .clk_i(clk_i), .rst_i(low[39]), .access_i(1'b0),
        .idle_i(`MEMORY_RESTS(soc.u_platform.u_memory)), .clk_o(memory_clk));

    // memory port of the camera
    wire [31:0] addr;
    wire [3:0]  size;
    wire [63:0] wr_data;
    wire [7:0]  wr_be;
    wire        addr_req, rnw, rmw, wr_push, wr_flush, rd_pop, rd_flush;
    // outputs of all memory ports
    wire [PORTS-1:1]    addr_ack;
    wire                addr_ack_0;
    wire [PORTS-1:0]    wr_empty, wr_almost_full, rd_empty_of, init_done;
    wire [64*PORTS-1:0] rd_data_of;
    wire [4*PORTS-1:0]  rd_word_of;
    wire                irq, frame_valid, bus_ready, bus_error;
    wire [1:0]          frame_index;

    generate
        if (1) begin : soc
            if (1) begin : u_platform
                memory_mcb #(
                    .PORTS(PORTS), .READ_FIFO(~NO_READ_FIFO[PORTS-1:0]),
                    .BYTES(WRITES_BYTES[PORTS-1:0]), .MERGE({{(PORTS-1){1'b0}}, 1'b1})
                ) u_memory (
                    .clk_i(memory_clk), .rst_i(low[39]),
                    .npi_addr_i({{32*(PORTS-1-PORT){1'b0}}, addr, {32*PORT{1'b0}}}),
                    .npi_addr_req_i({{PORTS-1-PORT{low[38]}}, addr_req, {PORT{low[38]}}}),
                    // two wires as in platform.v, so that Verilator names the register as there
                    .npi_addr_ack_o({addr_ack, addr_ack_0}),
                    .npi_rnw_i({{PORTS-1-PORT{low[38]}}, rnw, {PORT{low[38]}}}),
                    .npi_size_i({{4*(PORTS-1-PORT){1'b0}}, size, {4*PORT{1'b0}}}),
                    .npi_rmw_i({{PORTS-1-PORT{1'b0}}, rmw, {PORT{1'b0}}}),
                    .npi_wr_data_i({{64*(PORTS-1-PORT){1'b0}}, wr_data, {64*PORT{1'b0}}}),
                    .npi_wr_be_i({{8*(PORTS-1-PORT){low[38]}}, wr_be, {8*PORT{low[38]}}}),
                    .npi_wr_push_i({{PORTS-1-PORT{low[38]}}, wr_push, {PORT{low[38]}}}),
                    .npi_wr_empty_o(wr_empty), .npi_wr_almost_full_o(wr_almost_full),
                    .npi_wr_flush_i({{PORTS-1-PORT{low[38]}}, wr_flush, {PORT{low[38]}}}),
                    .npi_rd_data_o(rd_data_of), .npi_rd_word_o(rd_word_of),
                    .npi_rd_pop_i({{PORTS-1-PORT{low[38]}}, rd_pop, {PORT{low[38]}}}),
                    .npi_rd_empty_o(rd_empty_of),
                    .npi_rd_flush_i({{PORTS-1-PORT{low[38]}}, rd_flush, {PORT{low[38]}}}),
                    .npi_init_done_o(init_done),
                    .mcb_cmd_en_o(mcb_cmd_en_o), .mcb_cmd_instr_o(mcb_cmd_instr_o),
                    .mcb_cmd_bl_o(mcb_cmd_bl_o), .mcb_cmd_byte_addr_o(mcb_cmd_byte_addr_o),
                    .mcb_cmd_full_i(cmd_full), .mcb_wr_en_o(mcb_wr_en_o),
                    .mcb_wr_mask_o(mcb_wr_mask_o), .mcb_wr_data_o(mcb_wr_data_o),
                    .mcb_wr_full_i(wr_full), .mcb_rd_en_o(mcb_rd_en_o),
                    .mcb_rd_data_i(rd_data), .mcb_rd_empty_i(rd_empty),
                    .mcb_calib_done_i(1'b1)); // stirs_o of sim_soc.v is high before that
            end
            camera u_camera (
                .clk_i(clk_i), .rst_i(low[39]),
                .bus_valid_i(low[37]), .bus_write_i(low[36]), .bus_addr_i(low[35:32]),
                .bus_wdata_i(low[31:0]),
                .bus_ready_o(bus_ready), .bus_rdata_o(bus_rdata_o), .bus_error_o(bus_error),
                .npi_addr_o(addr), .npi_addr_req_o(addr_req), .npi_addr_ack_i(addr_ack[PORT]),
                .npi_rnw_o(rnw), .npi_size_o(size), .npi_rmw_o(rmw),
                .npi_wr_data_o(wr_data), .npi_wr_be_o(wr_be), .npi_wr_push_o(wr_push),
                .npi_wr_empty_i(wr_empty[PORT]), .npi_wr_almost_full_i(wr_almost_full[PORT]),
                .npi_wr_flush_o(wr_flush), .npi_rd_data_i(rd_data_of[64*PORT +: 64]),
                .npi_rd_word_i(rd_word_of[4*PORT +: 4]), .npi_rd_pop_o(rd_pop),
                .npi_rd_empty_i(rd_empty_of[PORT]), .npi_rd_flush_o(rd_flush),
                .npi_init_done_i(init_done[PORT]),
                .pclk_i(core_pins_i[MAP_PIN_CAMERA_PCLK_I]),
                .vsync_i(core_pins_i[MAP_PIN_CAMERA_VSYNC_I]),
                .href_i(core_pins_i[MAP_PIN_CAMERA_HREF_I]),
                .data_i(core_pins_i[MAP_PIN_CAMERA_DATA_I +: 8]),
                .frame_valid_o(frame_valid), .frame_index_o(frame_index), .frame_take_i(1'b0),
                .irq_o(irq));
        end
    endgenerate

    localparam [31:0] OTHER_PORTS = ~(1 << PORT);
    localparam [PORTS-1:0] OTHERS = OTHER_PORTS[PORTS-1:0];
    assign others_o = {{60-3*PORTS{1'b0}}, irq, frame_valid, frame_index,
                       {addr_ack, addr_ack_0} & OTHERS,
                       wr_empty & OTHERS, rd_empty_of & OTHERS};
    assign empty_o  = &((wr_empty & rd_empty_of) | ~OTHERS);

    assign sampled_o = {calib_done, rd_data};

    wire unused = &{1'b0, core_pins_i, init_done, wr_almost_full, rd_data_of,
                    rd_word_of, bus_ready, bus_error, 1'b0};
endmodule
