// SPDX-License-Identifier: MIT
//
// sim_memory: the memory of the chip without its ports' users, for the clocks in which only the
// camera works (sim_camera.v, camera_alone.h).
//
// The memory port of the camera is connected to the pins, and the other ports have no requests.
// While still_o is high, a clock changes nothing here except for the flip-flops behind the inputs
// from the MCB.

`default_nettype none
`include "rests.vh"

module sim_memory (
    input  wire        tick_i, // each change is one clock, as in sim_soc.v
    // Reset and requests of the other ports are always low (sim_camera.v).
    input  wire [1:0]  low_i,
    // memory port of the camera, as in memory_ports.vh, in the other direction
    input  wire [31:0] npi_addr_i,
    input  wire        npi_addr_req_i, npi_rnw_i, npi_rmw_i, npi_wr_push_i, npi_wr_flush_i,
    input  wire [3:0]  npi_size_i,
    input  wire [63:0] npi_wr_data_i,
    input  wire [7:0]  npi_wr_be_i,
    input  wire        npi_rd_pop_i, npi_rd_flush_i,
    output wire        npi_addr_ack_o, npi_wr_empty_o, npi_wr_almost_full_o, npi_rd_empty_o,
    output wire [63:0] npi_rd_data_o,
    output wire [3:0]  npi_rd_word_o,
    `include "mcb_ports.vh"
    // outputs of the memory to the other ports, without words and acknowledgements
    output wire [63:0] others_o,
    output wire        empty_o, // the FIFOs of the other ports are empty
    output wire        still_o, // the memory has no clock
    // keeps registers that only another memory port reads
    output wire [64:0] sampled_o
);
    `include "map_regs.vh"
    localparam PORTS = MAP_NPI_PORT_COUNT, PORT = MAP_NPI_PORT_CAMERA;
    `include "memory_fifos.vh"

    reg  ticked = 1'b0;
    wire clk_i = tick_i != ticked;
    `include "sampled_mcb.vh"
    reg [1:0] low;
    always @(posedge clk_i) begin
        ticked <= tick_i;
        low    <= low_i;
    end
    wire rst = low[1], none = low[0];

    wire memory_clk;
    core_gate #(.GATED(1), .LOG2(`MEMORY_REST_LOG2)) u_gate_memory (
        .clk_i(clk_i), .rst_i(rst), .access_i(1'b0),
        .idle_i(`MEMORY_RESTS(soc.u_platform.u_memory)), .clk_o(memory_clk));

    // outputs of all memory ports
    wire [PORTS-1:1]    addr_ack;
    wire                addr_ack_0;
    wire [PORTS-1:0]    wr_empty, wr_almost_full, rd_empty_of, init_done;
    wire [64*PORTS-1:0] rd_data_of;
    wire [4*PORTS-1:0]  rd_word_of;

    generate
        if (1) begin : soc
            if (1) begin : u_platform
                memory_mcb #(
                    .PORTS(PORTS), .READ_FIFO(READ_FIFO), .BYTES(BYTES),
                    .MERGE({{(PORTS-1){1'b0}}, 1'b1})
                ) u_memory (
                    .clk_i(memory_clk), .rst_i(rst),
                    .npi_addr_i({{32*(PORTS-1-PORT){1'b0}}, npi_addr_i, {32*PORT{1'b0}}}),
                    .npi_addr_req_i({{PORTS-1-PORT{none}}, npi_addr_req_i, {PORT{none}}}),
                    // two wires as in platform.v, so that Verilator names the register as there
                    .npi_addr_ack_o({addr_ack, addr_ack_0}),
                    .npi_rnw_i({{PORTS-1-PORT{none}}, npi_rnw_i, {PORT{none}}}),
                    .npi_size_i({{4*(PORTS-1-PORT){1'b0}}, npi_size_i, {4*PORT{1'b0}}}),
                    .npi_rmw_i({{PORTS-1-PORT{1'b0}}, npi_rmw_i, {PORT{1'b0}}}),
                    .npi_wr_data_i({{64*(PORTS-1-PORT){1'b0}}, npi_wr_data_i, {64*PORT{1'b0}}}),
                    .npi_wr_be_i({{8*(PORTS-1-PORT){none}}, npi_wr_be_i, {8*PORT{none}}}),
                    .npi_wr_push_i({{PORTS-1-PORT{none}}, npi_wr_push_i, {PORT{none}}}),
                    .npi_wr_empty_o(wr_empty), .npi_wr_almost_full_o(wr_almost_full),
                    .npi_wr_flush_i({{PORTS-1-PORT{none}}, npi_wr_flush_i, {PORT{none}}}),
                    .npi_rd_data_o(rd_data_of), .npi_rd_word_o(rd_word_of),
                    .npi_rd_pop_i({{PORTS-1-PORT{none}}, npi_rd_pop_i, {PORT{none}}}),
                    .npi_rd_empty_o(rd_empty_of),
                    .npi_rd_flush_i({{PORTS-1-PORT{none}}, npi_rd_flush_i, {PORT{none}}}),
                    .npi_init_done_o(init_done),
                    .mcb_cmd_en_o(mcb_cmd_en_o), .mcb_cmd_instr_o(mcb_cmd_instr_o),
                    .mcb_cmd_bl_o(mcb_cmd_bl_o), .mcb_cmd_byte_addr_o(mcb_cmd_byte_addr_o),
                    .mcb_cmd_full_i(cmd_full), .mcb_wr_en_o(mcb_wr_en_o),
                    .mcb_wr_mask_o(mcb_wr_mask_o), .mcb_wr_data_o(mcb_wr_data_o),
                    .mcb_wr_full_i(wr_full), .mcb_rd_en_o(mcb_rd_en_o),
                    .mcb_rd_data_i(rd_data), .mcb_rd_empty_i(rd_empty),
                    .mcb_calib_done_i(1'b1)); // stirs_o of sim_soc.v is high before that
            end
        end
    endgenerate

    assign npi_addr_ack_o       = addr_ack[PORT];
    assign npi_wr_empty_o       = wr_empty[PORT];
    assign npi_wr_almost_full_o = wr_almost_full[PORT];
    assign npi_rd_empty_o       = rd_empty_of[PORT];
    assign npi_rd_data_o        = rd_data_of[64*PORT +: 64];
    assign npi_rd_word_o        = rd_word_of[4*PORT +: 4];

    localparam [31:0] OTHER_PORTS = ~(1 << PORT);
    localparam [PORTS-1:0] OTHERS = OTHER_PORTS[PORTS-1:0];
    assign others_o = {{64-3*PORTS{1'b0}}, {addr_ack, addr_ack_0} & OTHERS,
                       wr_empty & OTHERS, rd_empty_of & OTHERS};
    assign empty_o  = &((wr_empty & rd_empty_of) | ~OTHERS);
    assign still_o  = !u_gate_memory.g_gate.run;

    assign sampled_o = {calib_done, rd_data};

    wire unused = &{1'b0, init_done, wr_almost_full, rd_data_of, rd_word_of, 1'b0};
endmodule
