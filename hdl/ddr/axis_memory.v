// SPDX-License-Identifier: MIT
//
// axis_memory: turns a memory port (docs/memory.md) into two AXI-Streams of 64 bits. One brings buffers as packets, one
// puts packets into buffers; a descriptor names each (axis_read, axis_write).
//
// A core in VHDL takes it as a component: axis_memory_pkg.vhd.

`default_nettype none

module axis_memory #(
    parameter ADDR_BITS = 32, // of a byte address, 7..32
    parameter BYTE_BITS = 24, // of a row's number of bytes, 7..32
    parameter ROWS      = 1,  // 0: each packet is one row, and rows and stride are not looked at
    parameter TAG_BITS  = 1   // tag, repeated with each packet
) (
    `include "memory_ports.vh"
    input  wire                 clk_i,
    input  wire                 rst_i,
    input  wire                 stop_i, // high for a clock: both streams are given up; then wait for idle_o
    output wire                 idle_o, // nothing is under way
    // buffers to read: bytes (of a row) and rows are 1 at least, base and stride multiples of 8
    input  wire                 read_valid_i,
    output wire                 read_ready_o,
    input  wire [ADDR_BITS-1:0] read_base_i,
    input  wire [BYTE_BITS-1:0] read_bytes_i,
    input  wire [15:0]          read_rows_i,
    input  wire [ADDR_BITS-1:0] read_stride_i,
    input  wire [TAG_BITS-1:0]  read_tag_i,
    // their packets; last is that of the last row
    output wire                 m_axis_tvalid_o,
    input  wire                 m_axis_tready_i,
    output wire [63:0]          m_axis_tdata_o,
    output wire [7:0]           m_axis_tkeep_o,
    output wire                 m_axis_tlast_o,
    output wire [TAG_BITS-1:0]  m_axis_tid_o,
    // buffers to write, each for one packet
    input  wire                 write_valid_i,
    output wire                 write_ready_o,
    input  wire [ADDR_BITS-1:0] write_base_i,
    input  wire [BYTE_BITS-1:0] write_bytes_i,
    input  wire [15:0]          write_rows_i,
    input  wire [ADDR_BITS-1:0] write_stride_i,
    input  wire [TAG_BITS-1:0]  write_tag_i,
    // packets; a byte that is not kept leaves memory unchanged
    input  wire                 s_axis_tvalid_i,
    output wire                 s_axis_tready_o,
    input  wire [63:0]          s_axis_tdata_i,
    input  wire [7:0]           s_axis_tkeep_i,
    input  wire                 s_axis_tlast_i,
    // a packet is in memory, in the order of descriptors
    output wire                 done_valid_o,
    input  wire                 done_ready_i,
    output wire [BYTE_BITS-1:0] done_bytes_o, // of it
    output wire                 done_over_o,  // the packet was longer than its buffer: the rest was thrown away
    output wire [TAG_BITS-1:0]  done_tag_o
);
    localparam [3:0] SIZE_64_BYTES = 4'd3;

    wire                 read_ask, write_ask, read_idle, write_idle;
    wire [ADDR_BITS-1:6] read_addr, write_addr;
    reg                  request, request_read; // a request waits for its acknowledgement
    reg  [ADDR_BITS-1:6] addr;
    wire                 next = !request && npi_init_done_i; // a full burst goes before a read

    axis_read #(.ADDR_BITS(ADDR_BITS), .BYTE_BITS(BYTE_BITS), .ROWS(ROWS), .TAG_BITS(TAG_BITS)) u_read (
        .clk_i(clk_i), .rst_i(rst_i), .stop_i(stop_i),
        .desc_valid_i(read_valid_i), .desc_ready_o(read_ready_o), .desc_base_i(read_base_i[ADDR_BITS-1:3]),
        .desc_bytes_i(read_bytes_i), .desc_rows_i(read_rows_i), .desc_stride_i(read_stride_i[ADDR_BITS-1:3]),
        .desc_tag_i(read_tag_i), .idle_o(read_idle),
        .axis_tvalid_o(m_axis_tvalid_o), .axis_tready_i(m_axis_tready_i), .axis_tdata_o(m_axis_tdata_o),
        .axis_tkeep_o(m_axis_tkeep_o), .axis_tlast_o(m_axis_tlast_o), .axis_tid_o(m_axis_tid_o),
        .ask_valid_o(read_ask), .ask_ready_i(next && !write_ask), .ask_addr_o(read_addr),
        .rd_data_i(npi_rd_data_i), .rd_empty_i(npi_rd_empty_i), .rd_pop_o(npi_rd_pop_o));

    axis_write #(.ADDR_BITS(ADDR_BITS), .BYTE_BITS(BYTE_BITS), .ROWS(ROWS), .TAG_BITS(TAG_BITS)) u_write (
        .clk_i(clk_i), .rst_i(rst_i), .stop_i(stop_i),
        .desc_valid_i(write_valid_i), .desc_ready_o(write_ready_o), .desc_base_i(write_base_i[ADDR_BITS-1:3]),
        .desc_bytes_i(write_bytes_i), .desc_rows_i(write_rows_i), .desc_stride_i(write_stride_i[ADDR_BITS-1:3]),
        .desc_tag_i(write_tag_i), .idle_o(write_idle),
        .done_valid_o(done_valid_o), .done_ready_i(done_ready_i), .done_bytes_o(done_bytes_o),
        .done_over_o(done_over_o), .done_tag_o(done_tag_o),
        .axis_tvalid_i(s_axis_tvalid_i), .axis_tready_o(s_axis_tready_o), .axis_tdata_i(s_axis_tdata_i),
        .axis_tkeep_i(s_axis_tkeep_i), .axis_tlast_i(s_axis_tlast_i),
        .ask_valid_o(write_ask), .ask_ready_i(next), .ask_addr_o(write_addr),
        .acked_i(npi_addr_ack_i && !request_read),
        .wr_full_i(npi_wr_almost_full_i), .wr_push_o(npi_wr_push_o), .wr_data_o(npi_wr_data_o), .wr_be_o(npi_wr_be_o));

    assign idle_o         = read_idle && write_idle;
    assign npi_addr_req_o = request;
    assign npi_rnw_o      = request_read;
    assign npi_size_o     = SIZE_64_BYTES;
    assign npi_rmw_o      = 1'b0;
    assign npi_wr_flush_o = 1'b0;
    assign npi_rd_flush_o = 1'b0;
    generate
        if (ADDR_BITS < 32) begin : g_narrow
            assign npi_addr_o = {{(32 - ADDR_BITS){1'b0}}, addr, 6'd0};
        end else begin : g_wide
            assign npi_addr_o = {addr, 6'd0};
        end
    endgenerate

    always @(posedge clk_i) begin
        if (request) begin
            request <= !npi_addr_ack_i;
        end else if (next) begin
            request      <= read_ask || write_ask;
            request_read <= !write_ask;
            addr         <= write_ask ? write_addr : read_addr;
        end
        if (rst_i)
            request <= 1'b0;
    end

    wire unused = &{1'b0, npi_wr_empty_i, npi_rd_word_i, read_base_i[2:0], read_stride_i[2:0], write_base_i[2:0],
                    write_stride_i[2:0], 1'b0};

`ifdef FORMAL
`include "axis_memory_proof.vh"
`endif
`ifdef COVER_POINTS
    reads_and_writes_at_once: cover property (@(posedge clk_i) read_ask && write_ask);
`endif
endmodule
