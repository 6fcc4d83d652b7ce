// SPDX-License-Identifier: MIT
//
// axi4_memory: a memory port (docs/memory.md) as an AXI4 slave of 64 bits, for a foreign core that is a master.
//
// INCR bursts of 1 to 256 beats of 8 bytes, and single beats of any size. Other bursts are refused: SLVERR for each beat of a
// read, and for a write, which then writes nothing. Answers come in the order of requests, reads and writes each; a write's
// comes when every later request of any port sees it. Locks, protection, caches, regions and QOS are not looked at.

`default_nettype none

module axi4_memory #(
    parameter ADDR_BITS = 32, // of a byte address, 7..32
    parameter ID_BITS   = 4
) (
    input  wire                 clk_i,
    input  wire                 rst_i,
    // write address
    input  wire                 awvalid_i,
    output wire                 awready_o,
    input  wire [ID_BITS-1:0]   awid_i,
    input  wire [ADDR_BITS-1:0] awaddr_i,
    input  wire [7:0]           awlen_i,
    input  wire [2:0]           awsize_i,
    input  wire [1:0]           awburst_i,
    // write data
    input  wire                 wvalid_i,
    output wire                 wready_o,
    input  wire [63:0]          wdata_i,
    input  wire [7:0]           wstrb_i,
    input  wire                 wlast_i,
    // write response
    output wire                 bvalid_o,
    input  wire                 bready_i,
    output wire [ID_BITS-1:0]   bid_o,
    output wire [1:0]           bresp_o,
    // read address
    input  wire                 arvalid_i,
    output wire                 arready_o,
    input  wire [ID_BITS-1:0]   arid_i,
    input  wire [ADDR_BITS-1:0] araddr_i,
    input  wire [7:0]           arlen_i,
    input  wire [2:0]           arsize_i,
    input  wire [1:0]           arburst_i,
    // read data
    output wire                 rvalid_o,
    input  wire                 rready_i,
    output wire [ID_BITS-1:0]   rid_o,
    output wire [63:0]          rdata_o,
    output wire [1:0]           rresp_o,
    output wire                 rlast_o,
    // memory port
    output wire [31:0]          npi_addr_o,
    output wire                 npi_addr_req_o,
    input  wire                 npi_addr_ack_i,
    output wire                 npi_rnw_o,
    output wire [3:0]           npi_size_o,
    output wire                 npi_rmw_o,
    output wire [63:0]          npi_wr_data_o,
    output wire [7:0]           npi_wr_be_o,
    output wire                 npi_wr_push_o,
    input  wire                 npi_wr_empty_i,
    input  wire                 npi_wr_almost_full_i,
    output wire                 npi_wr_flush_o,
    input  wire [63:0]          npi_rd_data_i,
    input  wire [3:0]           npi_rd_word_i,
    output wire                 npi_rd_pop_o,
    input  wire                 npi_rd_empty_i,
    output wire                 npi_rd_flush_o,
    input  wire                 npi_init_done_i
);
    localparam [1:0] INCR = 2'd1, OKAY = 2'd0, SLVERR = 2'd2;
    localparam [2:0] EIGHT_BYTES = 3'd3;

    wire bad_read  = arlen_i != 8'd0 && (arburst_i != INCR || arsize_i != EIGHT_BYTES);
    wire bad_write = awlen_i != 8'd0 && (awburst_i != INCR || awsize_i != EIGHT_BYTES);
    reg  refusing; // the write whose data come is refused
    always @(posedge clk_i)
        if (awvalid_i && awready_o)
            refusing <= bad_write;

    wire        idle, read_refused, write_refused, over;
    wire [7:0]  keep;
    wire [11:0] bytes;
    assign rresp_o = read_refused ? SLVERR : OKAY;
    assign bresp_o = write_refused || over ? SLVERR : OKAY;

    // An address is one descriptor, whose tag is the transfer's id.
    axis_memory #(.ADDR_BITS(ADDR_BITS), .BYTE_BITS(12), .ROWS(0), .TAG_BITS(ID_BITS + 1)) u_memory (
        .clk_i(clk_i), .rst_i(rst_i), .stop_i(1'b0), .idle_o(idle),
        .read_valid_i(arvalid_i), .read_ready_o(arready_o), .read_base_i(araddr_i),
        .read_bytes_i({{1'b0, arlen_i} + 9'd1, 3'd0}), .read_rows_i(16'd1), .read_stride_i({ADDR_BITS{1'b0}}),
        .read_tag_i({bad_read, arid_i}),
        .m_axis_tvalid_o(rvalid_o), .m_axis_tready_i(rready_i), .m_axis_tdata_o(rdata_o), .m_axis_tkeep_o(keep),
        .m_axis_tlast_o(rlast_o), .m_axis_tid_o({read_refused, rid_o}),
        .write_valid_i(awvalid_i), .write_ready_o(awready_o), .write_base_i(awaddr_i),
        .write_bytes_i({{1'b0, awlen_i} + 9'd1, 3'd0}), .write_rows_i(16'd1), .write_stride_i({ADDR_BITS{1'b0}}),
        .write_tag_i({bad_write, awid_i}),
        .s_axis_tvalid_i(wvalid_i), .s_axis_tready_o(wready_o), .s_axis_tdata_i(wdata_i),
        .s_axis_tkeep_i(wstrb_i & ~{8{refusing}}), .s_axis_tlast_i(wlast_i),
        .done_valid_o(bvalid_o), .done_ready_i(bready_i), .done_bytes_o(bytes), .done_over_o(over),
        .done_tag_o({write_refused, bid_o}),
        .npi_addr_o(npi_addr_o), .npi_addr_req_o(npi_addr_req_o), .npi_addr_ack_i(npi_addr_ack_i), .npi_rnw_o(npi_rnw_o),
        .npi_size_o(npi_size_o), .npi_rmw_o(npi_rmw_o), .npi_wr_data_o(npi_wr_data_o), .npi_wr_be_o(npi_wr_be_o),
        .npi_wr_push_o(npi_wr_push_o), .npi_wr_empty_i(npi_wr_empty_i), .npi_wr_almost_full_i(npi_wr_almost_full_i),
        .npi_wr_flush_o(npi_wr_flush_o), .npi_rd_data_i(npi_rd_data_i), .npi_rd_word_i(npi_rd_word_i),
        .npi_rd_pop_o(npi_rd_pop_o), .npi_rd_empty_i(npi_rd_empty_i), .npi_rd_flush_o(npi_rd_flush_o),
        .npi_init_done_i(npi_init_done_i));

    wire unused = &{1'b0, idle, keep, bytes, 1'b0};

`ifdef FORMAL
`include "axi4_memory_proof.vh"
`endif
`ifdef COVER_POINTS
    axi4_refuses_a_read: cover property (@(posedge clk_i) rvalid_o && read_refused);
    axi4_refuses_a_write: cover property (@(posedge clk_i) bvalid_o && write_refused);
`endif
endmodule
