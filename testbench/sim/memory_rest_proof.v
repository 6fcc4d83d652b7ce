// SPDX-License-Identifier: MIT
//
// memory_rest_proof: proves that the memory keeps its state while sim_soc.v stops its clock. The
// clock stops while no port has a request and no transfer is pending (rests.vh). Used only by the
// prover.
//
// It proves that at the time at which the clock stops, no register of the memory would take another
// value at the next clock, whatever its inputs are (compare hdl/system/idle_proof.v), and that no
// word is written to a FIFO.

`default_nettype none
`include "rests.vh"

module memory_rest_proof #(
    parameter PORTS = 3
) (
    input wire                clk_i,
    input wire                rst_i,
    input wire [32*PORTS-1:0] npi_addr_i,
    input wire [PORTS-1:0]    npi_addr_req_i, npi_rnw_i, npi_rmw_i, npi_wr_push_i, npi_wr_flush_i,
    input wire [4*PORTS-1:0]  npi_size_i,
    input wire [64*PORTS-1:0] npi_wr_data_i,
    input wire [8*PORTS-1:0]  npi_wr_be_i,
    input wire [PORTS-1:0]    npi_rd_pop_i, npi_rd_flush_i,
    input wire                mcb_cmd_full_i, mcb_wr_full_i, mcb_rd_empty_i, mcb_calib_done_i,
    input wire [63:0]         mcb_rd_data_i,
    // outputs of the FIFOs; without them the prover would remove the FIFOs
    output wire [PORTS-1:0]   npi_rd_empty_o, npi_wr_almost_full_o,
    output wire [64*PORTS-1:0] npi_rd_data_o,
    output wire [63:0]        mcb_wr_data_o,
    output wire [7:0]         mcb_wr_mask_o
);
    (* hierconn *) wire [PORTS-1:0] \u_core.npi_addr_req_i ;
    (* hierconn *) wire [PORTS-1:0] \u_core.npi_wr_push_i ;
    (* hierconn *) wire [PORTS-1:0] \u_core.npi_wr_flush_i ;
    (* hierconn *) wire [PORTS-1:0] \u_core.npi_rd_pop_i ;
    (* hierconn *) wire [PORTS-1:0] \u_core.npi_rd_flush_i ;
    (* hierconn *) wire \u_core.u_arbiter.u_queue.moving ;
    (* hierconn *) wire \u_core.u_arbiter.u_queue.coming ;
    (* hierconn *) wire \u_core.u_arbiter.u_queue.cmd_valid_o ;
    (* hierconn *) wire [8*PORTS-1:0] \u_core.npi_wr_be_i ;

    wire closes;
    core_gate #(.GATED(1), .LOG2(`MEMORY_REST_LOG2)) u_gate ( // the same gate as in sim_soc.v
        .clk_i(clk_i), .rst_i(rst_i), .access_i(1'b0), .idle_i(`MEMORY_RESTS(u_core)),
        .clk_o(closes));
    initial assume (rst_i);
    always @(posedge clk_i)
        cover (closes);

    memory_mcb #(
        .PORTS(PORTS), .READ_FIFO(~{{PORTS-1{1'b0}}, 1'b1}), .MERGE({{PORTS-1{1'b0}}, 1'b1})
    ) u_core (
        .clk_i(closes), .rst_i(rst_i),
        .npi_addr_i(npi_addr_i), .npi_addr_req_i(npi_addr_req_i), .npi_rnw_i(npi_rnw_i),
        .npi_size_i(npi_size_i), .npi_rmw_i(npi_rmw_i), .npi_wr_data_i(npi_wr_data_i),
        .npi_wr_be_i(npi_wr_be_i), .npi_wr_push_i(npi_wr_push_i),
        .npi_wr_flush_i(npi_wr_flush_i), .npi_rd_pop_i(npi_rd_pop_i),
        .npi_rd_flush_i(npi_rd_flush_i), .npi_rd_empty_o(npi_rd_empty_o),
        .npi_wr_almost_full_o(npi_wr_almost_full_o), .npi_rd_data_o(npi_rd_data_o),
        .mcb_wr_data_o(mcb_wr_data_o), .mcb_wr_mask_o(mcb_wr_mask_o),
        .mcb_cmd_full_i(mcb_cmd_full_i), .mcb_wr_full_i(mcb_wr_full_i),
        .mcb_rd_data_i(mcb_rd_data_i), .mcb_rd_empty_i(mcb_rd_empty_i),
        .mcb_calib_done_i(mcb_calib_done_i));
endmodule
